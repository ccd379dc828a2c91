#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "data/r_curve.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/chip/bridged_arms.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf::chip {
namespace {

// Douglas-fir, TL: the specimen of data/scenes/dcb_rcurve.toml, N and mm.
const Arms arms{.modulus = 14800, .height = 4, .notch = 16, .root_rotation = 1.7};
const BridgedCrack wood{.initiation_toughness = 0.215, .bridging_toughness = 0.405, .bridging_stress = 0.8};

TEST(BridgedArms, TheUnbridgedCrackIsTheTextbooks) {
  const double stiffness = arms.modulus * std::pow(arms.height, 3) / 12;
  const Resistance start = resistance(arms, wood, 0);
  EXPECT_NEAR(start.G_R, 0.215, 1e-12);
  EXPECT_EQ(start.opening, 0);
  // G = P^2 a (a + 2 chi h)/B, from Eq. (2) with M = P a at the tip.
  const double pull = std::sqrt(0.215 * stiffness / (arms.notch * (arms.notch + 2 * arms.root_rotation * arms.height)));
  EXPECT_NEAR(start.pull, pull, 1e-9 * pull);
}

TEST(BridgedArms, TheIntegralAboutTheSpecimenIsTheResistance) {
  double last = 0;
  for (const double extension : {0.0, 2.0, 5.0, 10.0, 20.0, 40.0}) {
    const Resistance here = resistance(arms, wood, extension);
    EXPECT_NEAR(2 * here.pull * here.rotation, here.G_R, 2e-5 * here.G_R) << extension;
    EXPECT_GE(here.G_R, last);
    last = here.G_R;
  }
  EXPECT_NEAR(last, 0.62, 1e-12) << "a developed zone resists with all there is";
  EXPECT_LT(resistance(arms, wood, 5).G_R, 0.5);
}

TEST(BridgedArms, TheTrilinearZoneBalancesToo) {
  BridgedCrack whole = wood;
  whole.strength = 4;
  whole.peak = 0.1;
  EXPECT_LT(resistance(arms, whole, 0).G_R, 0.03) << "the front alone takes the rise to the peak";
  EXPECT_NEAR(resistance(arms, whole, 40).G_R, 0.62, 1e-12);
  // The double cantilever beam of data/scenes/dcb_rcurve.toml, simulated: G_R at two extensions, N/mm.
  EXPECT_NEAR(resistance(arms, whole, 5.31).G_R, 0.291, 0.03);
  EXPECT_NEAR(resistance(arms, whole, 11.44).G_R, 0.4835, 0.05);
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

}  // namespace
}  // namespace kerf::chip
