#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "data/r_curve.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/chip/bridged_arms.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf::chip {
namespace {

// Douglas-fir, TL: the specimen of data/scenes/dcb_rcurve.toml in plane strain, N and mm.
const Arms arms{.modulus = 14630, .transverse_modulus = 673, .shear_modulus = 806, .height = 4, .notch = 10};
const BridgedCrack wood{.initiation_toughness = 0.215, .bridging_toughness = 0.405, .bridging_stress = 0.8};

BridgedCrack trilinear(double strength) {
  BridgedCrack whole = wood;
  whole.strength = strength;
  whole.peak = 0.1;
  return whole;
}

/// What an unbridged crack seems to be longer by, in heights of an arm: G = P^2 (a + L)^2/B.
double length_correction(const Arms& of) {
  const Resistance start = resistance(of, wood, 0);
  return (std::sqrt(start.G_R * of.bending_stiffness()) / start.pull - of.notch) / of.height;
}

TEST(BridgedArms, TheUnbridgedCrackIsTheElasticitySolutions) {
  EXPECT_NEAR(resistance(arms, wood, 0).G_R, 0.215, 1e-12);
  EXPECT_EQ(resistance(arms, wood, 0).opening, 0);
  for (const double ratio : {1.0, 5.0, 25.0})
    for (const double rho : {0.2, 1.0, 2.0, 3.5}) {  // Bao, Ho, Suo & Fan (1992), whose fit holds up to 4
      Arms of = arms;
      of.transverse_modulus = of.modulus / ratio;
      of.shear_modulus = std::sqrt(of.modulus * of.transverse_modulus) / (2 * rho);
      const double theirs = std::pow(ratio, 0.25) * (0.677 + 0.149 * (rho - 1) - 0.013 * (rho - 1) * (rho - 1));
      EXPECT_NEAR(length_correction(of), theirs, 0.015 * theirs) << ratio << ' ' << rho;
    }
}

TEST(BridgedArms, SlenderArmsAreEulersAndBernoullis) {
  Arms slender = arms;
  slender.notch = 1e4;
  const double bending = slender.bending_stiffness(), pull = std::sqrt(0.215 * bending) / slender.notch;
  const Resistance start = resistance(slender, wood, 0);
  EXPECT_NEAR(start.pull, pull, 1e-3 * pull);
  EXPECT_NEAR(start.rotation, pull * slender.notch * slender.notch / (2 * bending), 2e-3 * start.rotation);
}

TEST(BridgedArms, TheIntegralAboutTheSpecimenIsTheResistance) {
  const double stretch = 4 / (5 * 673.0);
  for (const BridgedCrack& crack : {wood, trilinear(4), trilinear(40)}) {
    double last = 0;
    for (const double extension : {0.0, 2.0, 5.0, 10.0, 20.0, 40.0}) {
      const Resistance here = resistance(arms, crack, extension);
      const double stretched = crack.strength == 4 ? stretch * here.traction * here.traction : 0;  // else a point
      EXPECT_NEAR(2 * here.pull * here.rotation, here.G_R + stretched, 5e-5 * here.G_R) << extension;
      EXPECT_GE(here.G_R, last);
      last = here.G_R;
    }
    EXPECT_NEAR(last, 0.62, 1e-12) << "a developed zone resists with all there is";
    EXPECT_LT(resistance(arms, crack, 5).G_R, 0.5);
  }
}

TEST(BridgedArms, AFrontThatFallsSteeplyIsAPoint) {
  for (const double extension : {0.0, 3.0, 12.0})
    EXPECT_DOUBLE_EQ(resistance(arms, trilinear(40), extension).pull, resistance(arms, wood, extension).pull);
  EXPECT_LT(resistance(arms, trilinear(4), 0).G_R, 0.03) << "the front alone takes the rise to the peak";
}

TEST(BridgedArms, HigherArmsNeedALongerZone) {
  Arms high = arms;
  high.height = 8;
  EXPECT_LT(resistance(high, wood, 10).opening, resistance(arms, wood, 10).opening);
}

std::vector<ResistancePoint> measured(double longest, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<ResistancePoint> points;
  for (int i = 0; i <= 12; ++i) {
    const double extension = longest * i / 12, G = resistance(arms, wood, extension).G_R;
    points.push_back({extension, G * (1 + noise * normal(random)), noise * G});
  }
  return points;
}

TEST(RCurve, GivesBackItsToughnessesWithIntervalsThatHold) {
  int held = 0, trials = 8;
  for (int seed = 1; seed <= trials; ++seed) {
    const Fit fit = fit_r_curve(arms, measured(30, 0.05, static_cast<unsigned>(seed)));
    ASSERT_TRUE(fit.converged);
    const FittedParameter &G_init = *fit.find("initiation_toughness"), &G_b = *fit.find("bridging_toughness");
    EXPECT_EQ(G_init.verdict, Verdict::measured);
    EXPECT_EQ(G_b.verdict, Verdict::measured);
    EXPECT_NEAR(G_b.value, 0.405, 5 * G_b.standard_error);
    held += G_init.lower <= 0.215 && 0.215 <= G_init.upper;
  }
  EXPECT_GE(held, 6) << "95 % of 8 is 7.6 +- 0.6";
}

TEST(RCurve, ASpecimenTooShortBoundsBridgingFromBelow) {
  const Fit fit = fit_r_curve(arms, measured(4, 0.05, 3));
  EXPECT_EQ(fit.find("initiation_toughness")->verdict, Verdict::measured);
  const FittedParameter& G_b = *fit.find("bridging_toughness");
  EXPECT_NE(G_b.verdict, Verdict::measured);
  EXPECT_LE(G_b.lower, 0.405);
}

TEST(RCurve, ItsFileIsReadWithItsUnits) {
  const auto rows =
      data::parse_r_curve("G[kJ/m^2],crack_extension[cm],G_sd[J/m^2]\n0.2,0,10\n0.4,1,20\n0.6,2,30\n", "r");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[1].extension, 10, 1e-12);
  EXPECT_NEAR(rows[1].G, 0.4, 1e-12);
  EXPECT_NEAR(*rows[2].sd, 0.03, 1e-12);
  const auto message = [](const char* text) {
    try {
      data::parse_r_curve(text, "r.csv");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("crack[mm],G[J/m^2]\n"), ::testing::HasSubstr("crack_extension"));
  EXPECT_THAT(message("crack_extension,G[J/m^2]\n"), ::testing::HasSubstr("has no unit"));
  EXPECT_THAT(message("crack_extension[mm],G[N]\n"), ::testing::HasSubstr("not measured in N"));
  EXPECT_THAT(message("crack_extension[mm],G[J/m^2]\n0,x\n1,2\n2,3\n"), ::testing::HasSubstr("r.csv:2:3"));
  EXPECT_THAT(message("crack_extension[mm],G[J/m^2]\n0,1\n1,2\n"), ::testing::HasSubstr("three rows"));
}

TEST(RCurve, TheShippedCurveGivesBackWhatWentIn) {
  const testing::TemporaryFolder folder;
  const std::string data = KERF_SOURCE_DIR "/data/";
  const ProcessOutput run = run_kerf(
      "r-curve " + data + "sets/wood_tl_synthetic/r_curve.csv --specimen " + data + "scenes/dcb_rcurve.toml --json",
      folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json fit = nlohmann::json::parse(run.out);
  EXPECT_FALSE(fit["rejected"]);
  for (const auto& [name, truth] : {std::pair("initiation_toughness", 215.0), std::pair("bridging_toughness", 405.0),
                                    std::pair("bridging_stress", 0.8)}) {
    const nlohmann::json& found = fit["parameters"][name];
    EXPECT_LT(found["interval"][0], truth) << found;
    EXPECT_GT(found["interval"][1], truth) << found;
    EXPECT_LT(found["se"], 0.06 * truth) << found;
  }
}

TEST(RCurve, TheClosedFormIsForTwoEqualArms) {
  const testing::TemporaryFolder folder;
  const std::string scene = read_file(KERF_SOURCE_DIR "/data/scenes/dcb_rcurve.toml");
  const auto refusal = [&](const char* from, const char* to) {
    write_atomically(folder / "scene.toml", testing::replaced(scene, from, to));
    const ProcessOutput run =
        run_kerf("r-curve " KERF_SOURCE_DIR "/data/sets/wood_tl_synthetic/r_curve.csv --specimen " +
                     (folder / "scene.toml").string(),
                 folder.path());
    EXPECT_EQ(run.exit_code, 3);
    return run.err;
  };
  EXPECT_THAT(refusal("arms = \"both\"", "arms = \"upper\""), ::testing::HasSubstr("two equal arms"));
  EXPECT_THAT(refusal("arms = \"both\"", "arms = \"both\"\nlower_arm = 2"), ::testing::HasSubstr("two equal arms"));
  EXPECT_THAT(refusal("notch = 4", "notch = 1.2"), ::testing::HasSubstr("grips.position"));
}

}  // namespace
}  // namespace kerf::chip
