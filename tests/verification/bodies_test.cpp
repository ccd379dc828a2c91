// Experiments on bodies against closed forms.
#include "forward/bodies/run.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "forward/bodies/closed_form.hpp"
#include "forward/bodies/step.hpp"
#include "forward/bodies/totals.hpp"
#include "tests/shipped_scene.hpp"
#include "tests/verification/bodies_result.hpp"

namespace kerf::forward::bodies {
namespace {

using kerf::testing::replaced;
using kerf::testing::shipped_text;

TEST(Bodies, AnIdealGasReachesCarnotsEfficiency) {
  const BodiesResult result = result_of(shipped_text("carnot_gas"));
  ASSERT_TRUE(result.accepted);
  EXPECT_NEAR(number(result, "efficiency"), 0.5, 1e-3);
  EXPECT_LT(number(result, "pv_gamma_error"), 1e-4);
  EXPECT_LT(number(result, "net_entropy_ratio"), 1e-3);
  EXPECT_NEAR(number(result, "closing_temperature_error"), 0.0, 1e-4);
  // Heat of the hot stroke: p_0 V_0 ln 2, a little more because the piston turns after the stroke's end.
  EXPECT_NEAR(number(result, "heat_taken"), 40 * std::numbers::ln2, 0.01);
}

TEST(Bodies, TungstenCoolsOnExpansionAndGivesCarnotsEfficiency) {
  const BodiesResult result = result_of(shipped_text("carnot_tungsten"));
  ASSERT_TRUE(result.accepted);
  EXPECT_LT(number(result, "first_step_temperature_change"), 0.0);
  EXPECT_NEAR(number(result, "efficiency") / (1.0 / 300), 1.0, 0.02);
  EXPECT_LT(number(result, "net_entropy_ratio"), 1e-3);
}

/// Largest distance of a column of the history from its closed form, over the range of that.
double off_by(const std::string& scene, const std::string& column) {
  const Scene read = read_scene(Document::parse(shipped_text(scene), "scene.toml"));
  const BodiesResult result = run(read);
  const std::vector<double> theory = closed_forms(result, read).at(column);
  const nlohmann::ordered_json history = result_json(result, read)["history"];
  double worst = 0;
  for (std::size_t i = 1; i < theory.size(); ++i)
    worst = std::max(worst, std::abs(history[column][i].get<double>() - theory[i]));
  const auto [least, most] = std::minmax_element(theory.begin(), theory.end());
  std::printf("%s, %s: off by %.2e of its range\n", scene.c_str(), column.c_str(), worst / (*most - *least));
  return worst / (*most - *least);
}

TEST(Bodies, HistoriesFollowTheirClosedForms) {
  EXPECT_LT(off_by("carnot_gas", "stress_xx"), 1e-4);
  EXPECT_LT(off_by("carnot_gas", "temperature"), 1e-4);
  EXPECT_LT(off_by("carnot_tungsten", "temperature"), 1e-4);
  EXPECT_LT(off_by("rubber_gough", "temperature"), 0.01);
  // Ten periods at a frequency that is 0.24 % low: the energy swings twice as often, and lags by 0.3 rad at the end.
  EXPECT_LT(off_by("vibrating_bar", "kinetic"), 0.16);
}

TEST(Bodies, AdiabaticExpansionOfTungstenCoolsAsItsGruneisenConstantSays) {
  std::string text = shipped_text("carnot_tungsten");
  text = text.substr(0, text.find("[[stroke]]")) +
         "[[stroke]]\nheat = \"adiabatic\"\npiston_speed = \"0.1 m/s\"\nramp = \"0.05 ms\"\nuntil_stretch = 1.001\n"
         "[pic_damping]\nrate = 0.02\n";
  text = replaced(text, "\"cycle\", ", "");
  const BodiesResult elastic = result_of(text);
  ASSERT_TRUE(elastic.accepted);
  const double stretch = elastic.history.back().length / 10.0;
  EXPECT_NEAR(elastic.history.back().temperature / (300 * std::exp(-1.54 * (stretch - 1))), 1.0, 1e-6);
  // Yielding always heats.
  const BodiesResult plastic = result_of(replaced(text, "shear_modulus", "yield_stress = \"100 MPa\"\nshear_modulus"));
  ASSERT_TRUE(plastic.accepted);
  EXPECT_GT(plastic.history.back().temperature, elastic.history.back().temperature + 0.01);
}

TEST(Bodies, TheTaylorQuinneyShareOfYieldingHeatsAndTheRestIsStored) {
  for (const double beta : {1.0, 0.5, 0.0}) {
    std::string text = shipped_text("carnot_tungsten_plastic");
    text = text.substr(0, text.find("[[stroke]]")) +
           "[[stroke]]\nheat = \"adiabatic\"\npiston_speed = \"0.1 m/s\"\nramp = \"0.05 ms\"\nuntil_stretch = 1.004\n"
           "[pic_damping]\nrate = 0.02\n";
    text =
        replaced(replaced(text, "\"cycle\", ", ""), "taylor_quinney = 0.9", fmt::format("taylor_quinney = {}", beta));
    const BodiesResult result = result_of(text);
    ASSERT_TRUE(result.accepted) << beta;
    const Reading& end = result.history.back();
    // One stretch, e = ln J: the deviator yields at sigma_y = 2 G e, then slips by 2/3 de.
    const double J = end.length / 10, slip = 2.0 / 3 * (std::log(J) - 700 / (2 * 160e3)), capacity = 19224e-12 * 134e6;
    EXPECT_NEAR(end.plastic_work / (40 * 700 * slip), 1.0, 2e-3) << beta;
    const double warming = end.temperature - 300 * std::exp(-1.54 * (J - 1));
    std::printf("beta = %.1f: warming by yielding %.4f K, work over heat capacity %.4f K\n", beta, warming,
                700 * slip / capacity);
    EXPECT_NEAR(warming, beta * 700 * slip / capacity, 2e-3 * 700 * slip / capacity) << beta;
    EXPECT_LT(std::abs(end.residue()), 1e-3 * end.plastic_work) << beta;
  }
}

TEST(Bodies, YieldingTurnsTheEngineIntoAHeater) {
  const BodiesResult result = result_of(shipped_text("carnot_tungsten_plastic"));
  ASSERT_TRUE(result.accepted);
  EXPECT_LT(number(result, "efficiency"), -0.5);
  EXPECT_NEAR(number(result, "entropy_made") / number(result, "entropy_made_by_yielding"), 1.0, 1e-3);
  EXPECT_GT(number(result, "net_heat_given_off"), 0.5 * number(result, "plastic_work"));
  double last = 0;
  for (const Reading& r : result.history) {
    EXPECT_GE(r.plastic_work, last);
    last = r.plastic_work;
  }
}

TEST(Bodies, IdealRubberGivesAllWorkAsHeatAndWarmsWhenPulledFast) {
  const BodiesResult result = result_of(shipped_text("rubber_gough"));
  ASSERT_TRUE(result.accepted);
  EXPECT_NEAR(number(result, "heat_over_work"), 1.0, 2e-3);
  EXPECT_NEAR(number(result, "entropy_over_heat"), 1.0, 1e-6);
  EXPECT_LT(number(result, "adiabatic_temperature_error"), 5e-3);
  EXPECT_NEAR(number(result, "adiabatic_over_isothermal_modulus"),
              number(result, "adiabatic_over_isothermal_modulus_closed_form"), 5e-4);
}

TEST(Bodies, ABarIsAsStiffAsItsHalvesAndTheirGlue) {
  const std::string text = shipped_text("interface_bar");
  // From soft to a million times E/cell.
  for (const double D : {1.0, 1e1, 1e2, 1e3, 1e5, 1e9}) {
    const BodiesResult result = result_of(replaced(text, "normal = \"10 MPa", fmt::format("normal = \"{} MPa", D)));
    ASSERT_TRUE(result.accepted) << D;
    std::printf("D = %.0e MPa/mm: effective modulus off by %.2e\n", D, number(result, "effective_modulus_error"));
    EXPECT_LT(number(result, "effective_modulus_error"), 5e-3) << D;
  }
  const std::size_t interface = text.find("[interface]");
  const BodiesResult bonded = result_of(text.substr(0, interface) + text.substr(text.find("[[stroke]]")));
  EXPECT_NEAR(number(bonded, "effective_modulus") / 1000, 1.0, 5e-3);
}

TEST(Bodies, CompressedFacesHaveTheirOwnStiffness) {
  std::string text = shipped_text("interface_bar");
  text = replaced(text, "[interface]", "[interface]\ncompressive = \"1000 MPa/mm\"");
  text = replaced(text, "1.0002", "0.9998");
  text = replaced(text, "\"0.02 m/s\"", "\"-0.02 m/s\"");
  const BodiesResult result = result_of(text);
  ASSERT_TRUE(result.accepted);
  EXPECT_NEAR(number(result, "effective_modulus"), 1 / (1e-3 + 1e-5), 5);
}

/// A slab of length L between two walls at 300 K whose temperature begins as 300 K + 100 K sin(pi x/L) and decays as
/// exp(-pi^2 kappa t/L^2): largest departure at the points after t = 0.05 L^2/kappa, over 100 K.
double conduction_error(int cells) {
  constexpr double kappa = 1e6, length = 10;  // mm^2/s, mm
  const Scene scene = read_scene(Document::parse(
      fmt::format("title = \"slab\"\nmeasures = []\n[box]\nlength = \"10 mm\"\nheight = \"8 mm\"\ncell = \"{} mm\"\n"
                  "courant_number = 0.1\n[[body]]\nlaw = \"mie_gruneisen\"\ndensity = \"19224 kg/m^3\"\n"
                  "sound_speed = \"4029 m/s\"\nslope = 1.237\ngruneisen = 0\nspecific_heat = \"134 J/(kg K)\"\n"
                  "shear_modulus = \"160 GPa\"\nreference_temperature = \"300 K\"\n"
                  "[conduction]\nconductivity = \"{} W/(m K)\"\nleft = \"300 K\"\nright = \"300 K\"\n"
                  "[[stroke]]\nheat = \"adiabatic\"\npiston_speed = \"0 m/s\"\nlongest = \"1 ms\"\n",
                  length / cells, 19224 * 134.0),
      "slab.toml"));
  State state = lay_out(scene);
  Points& points = state.bodies[0].points;
  for (std::size_t i = 0; i < points.size(); ++i)
    points.temperature[i] = 300 + 100 * std::sin(std::numbers::pi * points.reference_x[i] / length);
  Joint joint(state, scene);
  const double internal = totals(state).internal;
  const std::vector<Stage> stages = plan(scene, joint);
  while (state.time < 0.05 * length * length / kappa)
    for (const Stage& stage : stages) stage.apply(state, scene.strokes[0]);
  EXPECT_NEAR(state.bath.heat / (totals(state).internal - internal), 1.0, 1e-9);
  const double left = std::exp(-std::pow(std::numbers::pi / length, 2) * kappa * state.time);
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    worst = std::max(worst, std::abs((points.temperature[i] - 300) / 100 -
                                     left * std::sin(std::numbers::pi * points.reference_x[i] / length)));
  return worst;
}

TEST(Bodies, HeatConductionFollowsTheSeriesWithSecondOrder) {
  const double coarse = conduction_error(8), middle = conduction_error(16), fine = conduction_error(32);
  std::printf("temperature off by %.2e, %.2e, %.2e of the first amplitude, at 8, 16, 32 cells\n", coarse, middle, fine);
  EXPECT_LT(fine, 2e-3);
  EXPECT_GT(std::log2(coarse / middle), 1.7);
  EXPECT_GT(std::log2(middle / fine), 1.7);
}

TEST(Bodies, AnImpossibleStrokeEndsInARefusal) {
  const BodiesResult result =
      result_of(replaced(shipped_text("carnot_gas"), "until_temperature = \"300 K\"", "until_temperature = \"700 K\""));
  EXPECT_FALSE(result.accepted);
  ASSERT_FALSE(result.refusals.empty());
}

/// A bar between walls whose free top lets it flow as it is pulled by five per cent.
std::string pulled(const std::string& law, const std::string& more) {
  return fmt::format(
      "title = \"pull\"\nmeasures = []\n[box]\nlength = \"10 mm\"\nheight = \"5 mm\"\ncell = \"0.5 mm\"\ntop = "
      "\"open\"\n[[body]]\n{}\ndensity = \"1000 kg/m^3\"\nspecific_heat = \"1000 J/(kg K)\"\nheight = \"4 "
      "mm\"\n{}\n[[stroke]]\nheat = \"adiabatic\"\npiston_speed = \"2 m/s\"\nramp = \"0.05 ms\"\nuntil_stretch = "
      "1.05\n[pic_damping]\nrate = 0.05\n",
      law, more);
}

TEST(Bodies, PlasticWorkHeatsWhatFollowsALawOfTheCut) {
  const std::string isotropic = "elastic_modulus = \"1000 MPa\"\npoisson_ratio = 0.3\nyield_stress = \"10 MPa\"\n";
  // Hill's numbers of the same isotropic solid.
  const std::string hill = fmt::format(
      "law = \"hill\"\nmodulus_x = \"1000 MPa\"\nmodulus_y = \"1000 MPa\"\nmodulus_z = \"1000 MPa\"\nshear_modulus_xy "
      "= "
      "\"{:.10g} MPa\"\npoisson_xy = 0.3\npoisson_xz = 0.3\npoisson_yz = 0.3\nyield_x = \"10 MPa\"\nyield_y = \"10 "
      "MPa\"\nyield_z = \"10 MPa\"\nshear_yield_xy = \"{:.10g} MPa\"\n",
      500 / 1.3, 10 / std::numbers::sqrt3);
  for (const std::string& law : {"law = \"j2\"\n" + isotropic, "law = \"hencky\"\n" + isotropic, hill})
    for (const auto& [share, more] :
         {std::pair{0.9, ""}, {0.5, ""}, {0.9, "[conduction]\nconductivity = \"50 W/(m K)\""}}) {
      const BodiesResult result = result_of(pulled(law, fmt::format("taylor_quinney = {}", share)) + more);
      ASSERT_TRUE(result.accepted) << result.refusals[0];
      const Reading& end = result.history.back();
      // What neither moves nor can be let go of again has been spent on yielding.
      // In plane strain it flows at 2/sqrt(3) of the yield stress, half of that across.
      const double x = 20 / std::numbers::sqrt3, z = 0.5 * x, volume = 40;
      const double stored = volume * (1.3 * (x * x + z * z) - 0.3 * (x + z) * (x + z)) / 2000;
      const double heat = volume * 1.0 * (end.temperature - 293.15);  // rho c = 1 N/(mm^2 K)
      std::printf("warmer by %.4f K: heat %.4f, share of the work %.4f N mm/mm\n", end.temperature - 293.15, heat,
                  share * (end.piston_work - end.damping - end.kinetic - stored));
      EXPECT_GT(end.plastic_work, 15);
      EXPECT_NEAR(heat / (share * end.plastic_work), 1, 1e-9);
      EXPECT_NEAR(heat / (share * (end.piston_work - end.damping - end.kinetic - stored)), 1, 0.01);
    }
}

}  // namespace
}  // namespace kerf::forward::bodies
