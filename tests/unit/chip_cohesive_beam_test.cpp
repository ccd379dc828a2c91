#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "models/chip/beam_section.hpp"
#include "models/chip/cohesive_beam.hpp"
#include "models/chip/plastic_bending.hpp"
#include "models/chip/root_rotation.hpp"
#include "models/laws/cubic.hpp"
#include "models/laws/sawtooth.hpp"
#include "models/laws/trilinear.hpp"
#include "tests/unit/run_kerf.hpp"

namespace kerf::chip {
namespace {

using ::testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;

/// Douglas-fir, crack plane RL or TL: elastic constants in MPa, yield stress along the grain 100 MPa, perfectly
/// plastic.
struct Fir {
  double across, shear;
};
constexpr Fir RL{960.0, 830.0}, TL{620.0, 760.0};
constexpr double grain_modulus = 14500.0;

/// The laws are not owned.
CohesiveBeam fir(const Fir& plane, double depth, const laws::TractionLaw& mode_I, const laws::TractionLaw* mode_II) {
  const double chi = orthotropic_root_rotation(grain_modulus, plane.across, plane.shear);
  return {.depth = depth,
          .rake = 45.0 * degree,
          .friction = 0.0,
          .modulus = grain_modulus,
          .yield_stress = 100.0,
          .hardening = 0.0,
          .normal_stiffness = foundation_stiffness(grain_modulus, chi, depth),
          .shear_stiffness = shear_foundation_stiffness(plane.shear, depth),
          .mode_I = &mode_I,
          .mode_II = mode_II};
}

const laws::Sawtooth RL_opening(4.0, 0.158, 0.1), RL_sliding(6.24, 0.474, 0.1), TL_sliding(4.65, 0.645, 0.1);
constexpr double TL_knee = 2.0 * 0.215 / (4.0 - 0.1 * 0.8);
const laws::Trilinear TL_opening({.strength = 4.0,
                                  .peak_opening = 0.1 * TL_knee,
                                  .bridging_stress = 0.8,
                                  .knee_opening = TL_knee,
                                  .critical_opening = 1.0125});

/// A strip that stays elastic; `stiffness` in multiples of an isotropic foundation.
CohesiveBeam elastic_strip(const laws::TractionLaw& law, double stiffness) {
  return {.depth = 1.0,
          .rake = 45.0 * degree,
          .friction = 0.0,
          .modulus = 1000.0,
          .yield_stress = 1e4,
          .hardening = 0.0,
          .normal_stiffness = stiffness * foundation_stiffness(1000.0, isotropic_root_rotation, 1.0),
          .shear_stiffness = 1000.0,
          .mode_I = &law};
}

/// The polymer of the verification scene.
CohesiveBeam polymer(double depth, const laws::TractionLaw& law) {
  const double modulus = plane_modulus(1000.0, 0.33, true);
  return {.depth = depth,
          .rake = 45.0 * degree,
          .friction = 0.0,
          .modulus = modulus,
          .yield_stress = 25.0 * plane_yield_stress_factor(true),
          .hardening = 0.0,
          .normal_stiffness = foundation_stiffness(modulus, isotropic_root_rotation, depth),
          .shear_stiffness = shear_foundation_stiffness(1000.0 / 2.66, depth),
          .mode_I = &law};
}

CohesiveBeamSolution solved(const CohesiveBeam& beam) {
  auto outcome = solve(beam);
  EXPECT_TRUE(outcome.solution.has_value()) << outcome.reason;
  return outcome.solution.value_or(CohesiveBeamSolution{});
}

TEST(CohesiveBeam, ElasticOnAStiffFoundationIsTheDoubleCantileverBeam) {
  const laws::Sawtooth brittle(300.0, 0.059, 0.1);
  const auto strip = elastic_strip(brittle, 1e4);
  const auto chip = solved(strip);
  EXPECT_NEAR(chip.F_c, 0.059, 1e-6 * 0.059) << "nothing else takes energy";
  EXPECT_NEAR(chip.crack_tip.moment * chip.crack_tip.moment / (2.0 * strip.bending_stiffness()), 0.059, 0.01 * 0.059);
  EXPECT_EQ(chip.plastic_work, 0.0);
  EXPECT_TRUE(std::isinf(chip.curl_radius));
}

TEST(CohesiveBeam, ElasticOnACompliantFoundationIsTheBeamOnElasticFoundation) {
  // Up to its strength the plane is thousands of times stiffer than the foundation and straight. Kanninen: a beam that
  // ends at M and M' = dM/ds lies there at w = M/(2 EI b^2) - M'/(2 EI b^3) and turns by M/(EI b) - M'/(2 EI b^2).
  const laws::Sawtooth law(1.0, 0.00059, 1e-4);
  const auto strip = elastic_strip(law, 1.0);
  const auto chip = solved(strip);
  const double EI = strip.bending_stiffness();
  const double b = std::pow(strip.normal_stiffness / (4.0 * EI), 0.25);
  EXPECT_NEAR(1.0 / b, isotropic_root_rotation * strip.depth, 1e-12) << "root rotation M/(EI b) = chi h kappa";
  int compared = 0;
  for (const auto& at : chip.sections) {
    if (at.lift_axis * strip.normal_stiffness < 0.3 || at.lift_axis * strip.normal_stiffness > 0.99) continue;
    if (at.arc > chip.crack_tip.arc) break;
    const double slope = -(at.force_y * std::cos(at.rotation) + at.force_x * std::sin(at.rotation)) +
                         0.5 * strip.depth * strip.normal_stiffness * at.lift_axis * std::sin(at.rotation);
    EXPECT_NEAR(at.lift_axis, at.moment / (2.0 * EI * b * b) - slope / (2.0 * EI * b * b * b), 3e-3 * at.lift_axis);
    EXPECT_NEAR(at.rotation, at.moment / (EI * b) - slope / (2.0 * EI * b * b), 3e-3 * at.rotation);
    ++compared;
  }
  EXPECT_GE(compared, 10);
}

TEST(CohesiveBeam, ElasticFreeChipIsTheElastica) {
  // E'I kappa^2 / 2 = N sin(phi), phi the angle still to turn; phi = x^2 takes the singularity at the contact away.
  const laws::Sawtooth law(10.0, 0.059, 0.1);
  const auto strip = elastic_strip(law, 1.0);
  const auto chip = solved(strip);
  const double EI = strip.bending_stiffness();
  const double left = std::numbers::pi / 2 - strip.rake - chip.crack_tip.rotation;
  EXPECT_NEAR(0.5 * EI * chip.crack_tip.curvature * chip.crack_tip.curvature, chip.normal_force * std::sin(left),
              1e-6 * chip.normal_force);
  const double length = boost::math::quadrature::gauss<double, 30>::integrate(
      [&](double x) { return 2.0 * x / std::sqrt(2.0 * chip.normal_force * std::sin(x * x) / EI); }, 0.0,
      std::sqrt(left));
  EXPECT_NEAR(chip.sections.back().arc - chip.crack_tip.arc, length, 1e-5 * length);
  EXPECT_NEAR(chip.sections.back().rotation, std::numbers::pi / 2 - strip.rake, 1e-6);
  EXPECT_NEAR(chip.sections.back().moment, 0.0, 1e-9);
}

TEST(CohesiveBeam, PlasticOnAStiffFoundationSpendsTheComplementaryEnergyOfItsRoot) {
  // The root is loaded up to k_0 and no further: J there is C(k_0), although the chip unloads elastically behind it.
  const laws::Sawtooth brittle(300.0, 0.059, 0.1);
  auto strip = elastic_strip(brittle, 1e4);
  strip.yield_stress = 9.4;
  strip.hardening = 0.3;
  const auto chip = solved(strip);
  const double k = chip.root_curvature / strip.yield_curvature();
  EXPECT_GT(k, 1.5);
  const double scale = strip.bending_stiffness() * std::pow(strip.yield_curvature(), 2);
  EXPECT_NEAR(complementary_energy(k, 0.3) * scale, 0.059, 0.02 * 0.059);
  EXPECT_GT(chip.plastic_work, 0.2 * 0.059);
}

TEST(CohesiveBeam, ToolWorkIsFractureAndPlasticWork) {
  struct Case {
    double friction, hardening;
    const laws::Sawtooth* sliding;
  };
  for (const auto& [friction, hardening, sliding] :
       {Case{0.0, 0.1, nullptr}, Case{0.3, 0.0, nullptr}, Case{0.3, 0.1, &RL_sliding}}) {
    auto beam = fir(RL, 0.2, RL_opening, sliding);
    beam.friction = friction;
    beam.hardening = hardening;
    const auto chip = solved(beam);
    EXPECT_LT(std::abs(chip.imbalance), 1e-6) << friction << " " << hardening << " " << (sliding != nullptr);
    EXPECT_NEAR(chip.F_c, chip.normal_force * (std::cos(beam.rake) + friction * std::sin(beam.rake)), 1e-6 * chip.F_c);
    EXPECT_NEAR(chip.F_t, chip.normal_force * (friction * std::cos(beam.rake) - std::sin(beam.rake)), 1e-6 * chip.F_c);
  }
}

TEST(CohesiveBeam, WithoutShearTheModeIToughnessIsSpent) {
  const auto chip = solved(fir(RL, 0.3, RL_opening, nullptr));
  EXPECT_NEAR(chip.work_I, 0.158, 1e-9);
  EXPECT_EQ(chip.work_II, 0.0);
  EXPECT_GT(solved(fir(RL, 0.3, RL_opening, &RL_sliding)).work_II, 0.01);
}

TEST(CohesiveBeam, FollowsItsParameters) {
  const auto base = fir(RL, 0.3, RL_opening, nullptr);
  const auto chip = solved(base);
  const laws::Sawtooth tougher(4.0, 0.2, 0.1), stronger(6.0, 0.158, 0.1);
  auto other = base;
  other.mode_I = &tougher;
  EXPECT_GT(solved(other).F_c, 1.1 * chip.F_c);
  other.mode_I = &stronger;
  EXPECT_GT(solved(other).F_c, chip.F_c);
  EXPECT_LT(solved(other).process_zone, chip.process_zone);
  other = base;
  other.friction = 0.1;
  EXPECT_GT(solved(other).F_c, chip.F_c);
  other = base;
  other.yield_stress = 120.0;
  EXPECT_GT(solved(other).tip_gap, chip.tip_gap) << "a springier chip runs ahead";
  EXPECT_GT(solved(other).curl_radius, chip.curl_radius);
  other.yield_stress = 1e4;
  EXPECT_NEAR(solved(other).F_c, 0.158, 1e-6) << "elastic";
}

TEST(CohesiveBeam, WoodWithoutBridgingIsNearTheSimulation) {
  // RL, bare tool: MPM with four cells through the chip, which lies 5 to 8 % below eight cells. The strength in mode I
  // is not published; 4 MPa here, and 2 to 8 MPa move F_c by a quarter at 0.1 mm and by 1 % at 0.5 mm.
  struct Case {
    double depth, F_c, lead, simulated_F_c, simulated_lead;
  };
  for (const auto& [depth, F_c, lead, simulated_F_c, simulated_lead] :
       {Case{0.1, 0.4806, 0.0309, 0.533, 0.06}, Case{0.3, 0.7635, 0.944, 0.648, 1.19},
        Case{0.5, 0.6833, 3.109, 0.644, 3.42}}) {
    const auto chip = solved(fir(RL, depth, RL_opening, &RL_sliding));
    EXPECT_NEAR(chip.F_c, F_c, 1e-3 * F_c) << depth;
    EXPECT_NEAR(chip.tip_gap, lead, 2e-3) << depth;
    EXPECT_NEAR(chip.F_c, simulated_F_c, 0.2 * simulated_F_c) << depth;
    EXPECT_NEAR(chip.tip_gap, simulated_lead, 0.32) << depth;
    EXPECT_FALSE(chip.touching);
    EXPECT_LT(std::abs(chip.imbalance), 1e-6);
  }
}

TEST(CohesiveBeam, BridgedWoodIsNearTheSimulationCutOrIgnored) {
  struct Case {
    double depth, ignored, cut;
  };
  for (const auto& [depth, ignored, cut] : {Case{0.3, 1.442, 1.147}}) {
    auto beam = fir(TL, depth, TL_opening, &TL_sliding);
    const auto whole = solved(beam);
    EXPECT_NEAR(whole.F_c, ignored, 0.08 * ignored) << depth;
    EXPECT_LT(whole.tip_gap, 0.0) << "the zone reaches behind the tool's tip";
    EXPECT_LT(std::abs(whole.imbalance), 1e-6);
    beam.tool_cuts_bridging = true;
    const auto shortened = solved(beam);
    EXPECT_NEAR(shortened.F_c, cut, 0.08 * cut) << depth;
    EXPECT_NEAR(shortened.tip_gap, 0.0, 1e-3);
    EXPECT_LT(shortened.work_I, whole.work_I);
    EXPECT_LT(std::abs(shortened.imbalance), 1e-6);
  }
}

TEST(CohesiveBeam, CuttingChangesNothingWhereTheToolTrailsTheZone) {
  auto beam = fir(RL, 0.3, RL_opening, nullptr);
  const double ignored = solved(beam).F_c;
  beam.tool_cuts_bridging = true;
  EXPECT_EQ(solved(beam).F_c, ignored);
}

TEST(CohesiveBeam, PolymerIsCutAtTheCrackTip) {
  const laws::Cubic law(40.0, 2.0);
  for (const double depth : {0.25, 1.0}) EXPECT_TRUE(solved(polymer(depth, law)).touching) << depth;
}

TEST(CohesiveBeam, RefusesWithAReason) {
  const laws::Cubic law(40.0, 2.0);
  const auto jump = solve(polymer(2.0, law));
  EXPECT_FALSE(jump.solution);
  EXPECT_THAT(jump.reason, HasSubstr("jump"));

  auto folding = polymer(0.5, law);
  folding.mode_II = &law;
  const auto folded = solve(folding);
  EXPECT_FALSE(folded.solution);
  EXPECT_TRUE(folded.touching);
  EXPECT_THAT(folded.reason, HasSubstr("folds up"));
}

const std::string wood_keys =
    "cohesive_beam depth=0.3mm rake=45deg yield_stress=100MPa elastic_modulus=14500MPa modulus_across=960MPa "
    "shear_modulus=830MPa plane=stress toughness=158J/m^2 strength=4MPa ";

class CohesiveBeamCommand : public ::testing::Test {
 protected:
  ProcessOutput predict(const std::string& arguments) {
    return run_kerf("predict " + arguments, std::filesystem::temp_directory_path());
  }
};

TEST_F(CohesiveBeamCommand, PredictsAsTheFunctionDoes) {
  const auto output = predict(wood_keys + "shape=sawtooth --json");
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const auto result = nlohmann::json::parse(output.out);
  const auto chip = solved(fir(RL, 0.3, RL_opening, nullptr));
  EXPECT_NEAR(result["F_c"]["value"].get<double>(), 1e3 * chip.F_c, 1e-3);
  EXPECT_NEAR(result["crack_lead"]["value"].get<double>(), chip.tip_gap, 1e-6);
  EXPECT_EQ(result["mode_I_share"]["value"], 1.0);
  EXPECT_EQ(result["touching"], false);
  EXPECT_EQ(result["valid"], true);
}

TEST_F(CohesiveBeamCommand, SaysThatThePolymerIsCutAtTheCrackTip) {
  const std::string scene =
      "cohesive_beam depth=0.5mm rake=45deg elastic_modulus=1000MPa yield_stress=25MPa strength=40MPa "
      "toughness=2kJ/m^2 ";
  for (const char* shear : {"", "shear_strength=40MPa shear_toughness=2kJ/m^2 "}) {
    const auto result = nlohmann::json::parse(predict(scene + shear + "--json").out);
    EXPECT_EQ(result["valid"], false);
    EXPECT_EQ(result["touching"], true);
    EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("touching"));
  }
}

TEST_F(CohesiveBeamCommand, ErrorsNameTheKey) {
  struct Case {
    const char* keys;
    const char* message;
  };
  for (const auto& [keys, message] :
       {Case{"peak=0.1", "the cubic law takes no peak"}, Case{"shape=trilinear", "bridging_stress"},
        Case{"shear_strength=6MPa", "go together"}, Case{"bridging=sever", "cut"}, Case{"shape=sawtoth", "sawtooth"}}) {
    const auto output = predict(wood_keys + keys);
    EXPECT_EQ(output.exit_code, 2) << keys;
    EXPECT_THAT(output.err, HasSubstr(message)) << keys;
  }
}

}  // namespace
}  // namespace kerf::chip
