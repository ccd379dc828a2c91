// A trilinear law from an R-curve, by simulation: a specimen is pulled with a known law, and the calibration, which
// begins with half the toughness at the tip and twice the bridging, gives that law back; so does the closed form. What
// this does not prove: that real bridging is trilinear.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "models/base/atomic_file.hpp"
#include "models/chip/bridged_arms.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

constexpr double initiation = 0.215, bridging = 0.405, bridging_stress = 0.8;  // N/mm, N/mm, MPa: the shipped scene's
constexpr double noise = 0.02;

std::string specimen() {
  return testing::replaced(read_file(KERF_SOURCE_DIR "/data/scenes/dcb_rcurve.toml"), "cells_through_chip = 8",
                           "cells_through_chip = 6");
}

const inverse::RunRecord& simulated_pull() {
  static const inverse::RunRecord pulled =
      inverse::summarise(forward::run(forward::read_scene(Document::parse(specimen(), "dcb_rcurve.toml"))));
  return pulled;
}

TEST(RCurveTwin, TheBridgedArmsAreTheSimulatedOnes) {
  ASSERT_THAT(simulated_pull().refusals, ::testing::IsEmpty());
  // In plane strain, as `kerf r-curve` reduces them.
  const chip::Arms arms{
      .modulus = 14633, .transverse_modulus = 673.2, .shear_modulus = 806.5, .height = 4, .notch = 10};
  const chip::BridgedCrack law{.initiation_toughness = initiation,
                               .bridging_toughness = bridging,
                               .bridging_stress = bridging_stress,
                               .strength = 4,
                               .peak = 0.1};
  std::vector<chip::ResistancePoint> curve;
  for (const double extension : {2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 24.0}) {
    const double G = inverse::resistance(simulated_pull(), extension);
    EXPECT_NEAR(chip::resistance(arms, law, extension).G_R, G, 0.02 * G) << extension;
    curve.push_back({.extension = extension, .G_R = G, .standard_error = 0.02 * G});
  }
  const chip::Fit fit = chip::fit_r_curve(arms, curve, law);
  EXPECT_NEAR(fit.find("initiation_toughness")->value, initiation, 0.02 * initiation);
  EXPECT_NEAR(fit.find("bridging_toughness")->value, bridging, 0.02 * bridging);
  EXPECT_NEAR(fit.find("bridging_stress")->value, bridging_stress, 0.05 * bridging_stress);
}

TEST(RCurveTwin, GivesBackTheLawOfTheSpecimen) {
  const testing::TemporaryFolder folder;
  const std::string scene = specimen();
  const inverse::RunRecord& pulled = simulated_pull();
  ASSERT_THAT(pulled.refusals, ::testing::IsEmpty());
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::string curve = "crack_extension[mm],G[N/mm],G_sd[N/mm]\n";
  for (const double extension : {0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0}) {
    const double G = inverse::resistance(pulled, extension);
    curve += fmt::format("{},{},{}\n", extension, G * (1 + noise * normal(random)), noise * G);
  }
  write_atomically(folder / "r_curve.csv", curve);
  const auto outcome =
      testing::calibrate(testing::write_job(folder, R"(title = "R-curve"
scene = "scene.toml"
observables = ["G_R"]
[[curve]]
file = "r_curve.csv"
scene = "scene.toml"
[[free]]
path = "cohesive.mode_I.initiation_toughness"
lower = "50 J/m^2"
upper = "800 J/m^2"
start = "110 J/m^2"
[[free]]
path = "cohesive.mode_I.bridging_toughness"
lower = "100 J/m^2"
upper = "2000 J/m^2"
start = "800 J/m^2"
[[free]]
path = "cohesive.mode_I.bridging_stress"
lower = "0.3 MPa"
upper = "2 MPa"
start = "1.2 MPa"
[optimiser]
step = 0.1
noise = 0.005
)",
                                            "", scene),
                         folder / "journal.jsonl", [](const forward::Scene& s) { return forward::run(s); });
  const inverse::Identifiability& known = outcome.calibration.fit.identifiability;
  EXPECT_TRUE(outcome.calibration.fit.converged) << outcome.calibration.fit.reason;
  EXPECT_LE(outcome.runs, 25U);
  for (const auto& [name, truth] :
       {std::pair("initiation_toughness", initiation), std::pair("bridging_toughness", bridging),
        std::pair("bridging_stress", bridging_stress)}) {
    const inverse::ParameterEstimate& p = *known.find(name);
    EXPECT_EQ(p.verdict, inverse::Verdict::measured) << outcome.calibration.statement;
    EXPECT_LT(p.interval.lower, truth) << outcome.calibration.statement;
    EXPECT_GT(p.interval.upper, truth) << outcome.calibration.statement;
    EXPECT_LT(p.standard_error, 0.15 * truth);
  }
}

}  // namespace
}  // namespace kerf
