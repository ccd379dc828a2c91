#include "models/laws/j2.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tests/laws/material_point.hpp"

namespace kerf::laws {
namespace {

constexpr J2<LinearHardening> polymer{
    .elastic_modulus = 1000, .poisson_ratio = 0.33, .density = 1e-9, .hardening = {.yield_stress = 25, .modulus = 0}};

TEST(J2, UniaxialStrainIsElasticAtFirst) {
  Point point;
  point.drive(polymer, 1e-4, 0, 0, 0);
  EXPECT_NEAR(point.xx, (polymer.lame() + 2 * polymer.shear_modulus()) * 1e-4, 1e-12);
  EXPECT_NEAR(point.yy, polymer.lame() * 1e-4, 1e-12);
  EXPECT_EQ(point.plastic_strain, 0.0);
}

TEST(J2, ShearYieldsAtTheShearYieldStressWhateverTheStep) {
  for (const int steps : {10, 100, 1000}) {
    Point point;
    for (int i = 0; i < steps; ++i) point.drive(polymer, 0, 0.5 / steps, 0.5 / steps, 0);  // symmetric: no spin
    EXPECT_NEAR(point.xy, 25.0 / std::numbers::sqrt3, 1e-10);
    EXPECT_NEAR(point.plastic_strain, (1.0 - point.xy / polymer.shear_modulus()) / std::numbers::sqrt3, 1e-10);
  }
}

TEST(J2, HardeningRaisesTheYieldStressLinearly) {
  J2<LinearHardening> law = polymer;
  law.hardening.modulus = 50;
  Point point;
  for (int i = 0; i < 1000; ++i) point.drive(law, 0, 5e-4, 5e-4, 0);
  EXPECT_GT(point.plastic_strain, 0.3);
  EXPECT_NEAR(point.equivalent(), 25.0 + 50.0 * point.plastic_strain, 1e-9);
}

TEST(J2, RotationTurnsTheStressAndChangesNothingElse) {
  Point point;
  point.drive(polymer, 0.01, 0.004, 0.004, -0.006);
  const Point before = point;
  constexpr int steps = 2000;
  const double spin = std::numbers::pi / 2 / steps;
  for (int i = 0; i < steps; ++i) point.drive(polymer, 0, -spin, spin, 0);
  EXPECT_NEAR(point.xx, before.yy, 1e-5);
  EXPECT_NEAR(point.yy, before.xx, 1e-5);
  EXPECT_NEAR(point.xy, -before.xy, 1e-5);
  EXPECT_NEAR(point.equivalent(), before.equivalent(), 1e-10);
  EXPECT_EQ(point.plastic_strain, before.plastic_strain);
}

TEST(J2, WorkIsStoredOrDissipatedToTheOrderOfTheStep) {
  J2<LinearHardening> law = polymer;
  law.hardening.modulus = 30;
  EXPECT_LT(unexplained_work(law, 1000), 1e-3);
  // First order: the return is fully implicit.
  EXPECT_NEAR(unexplained_work(law, 500) / unexplained_work(law, 1000), 2.0, 0.3);
}

TEST(J2, CurvedHardeningExplainsItsWorkToo) {
  const J2<PowerHardening> power{1000, 0.33, 1e-9, {.yield_stress = 25, .coefficient = 2, .exponent = 0.4}};
  const J2<SaturatingHardening> saturating{
      1000, 0.33, 1e-9, {.yield_stress = 25, .saturation_stress = 60, .saturation_strain = 0.1}};
  EXPECT_LT(unexplained_work(power, 1000), 2e-3);
  EXPECT_NEAR(unexplained_work(power, 1000) / unexplained_work(power, 2000), 2.0, 0.3);
  EXPECT_LT(unexplained_work(saturating, 1000), 2e-3);
  EXPECT_NEAR(unexplained_work(saturating, 1000) / unexplained_work(saturating, 2000), 2.0, 0.3);
}

/// Plane-strain bar: with nothing across and zz held the plastic limit is 2/sqrt(3) of the flow stress.
TEST(J2, PlaneStrainTensionEndsAtTwoOverRootThree) {
  Point point;
  for (int i = 0; i < 400; ++i) point.pull_along_x(polymer, 1e-3);
  EXPECT_NEAR(point.xx, 2.0 / std::numbers::sqrt3 * 25.0, 1e-8);
  EXPECT_NEAR(point.zz, point.xx / 2.0, 1e-4);
}

template <class Hardening>
void shear_far(const Hardening& hardening) {
  const J2<Hardening> law{1000, 0.33, 1e-9, hardening};
  Point point;
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(point.drive(law, 0, 1e-3, 1e-3, 0));
    ASSERT_LE(point.equivalent(), hardening.flow_stress(point.plastic_strain) * (1.0 + 1e-11));
  }
  // Total shear is elastic plus plastic, gamma_p = sqrt(3) eps_p.
  EXPECT_NEAR(0.6, point.xy / law.shear_modulus() + std::numbers::sqrt3 * point.plastic_strain, 1e-10);
  EXPECT_NEAR(point.equivalent() / hardening.flow_stress(point.plastic_strain), 1.0, 1e-11);
}

TEST(J2, ShearFollowsEveryHardeningCurve) {
  for (const double n : {0.05, 0.1, 0.5, 1.0, 2.0, 5.0})
    for (const double K : {0.0, 0.01, 1.0, 1000.0})
      shear_far(PowerHardening{.yield_stress = 25, .coefficient = K, .exponent = n});
  for (const double eps_0 : {1e-4, 0.1, 10.0})
    shear_far(SaturatingHardening{.yield_stress = 25, .saturation_stress = 60, .saturation_strain = eps_0});
}

TEST(J2, APowerOfOneIsLinearHardening) {
  const J2<PowerHardening> power{1000, 0.33, 1e-9, {.yield_stress = 25, .coefficient = 2, .exponent = 1}};
  J2<LinearHardening> linear = polymer;
  linear.hardening.modulus = 50;
  std::mt19937 random(7);
  std::normal_distribution<double> strain(0.0, 0.02);
  Point a, b;
  for (int i = 0; i < 500; ++i) {
    const double xx = strain(random), xy = strain(random), yx = strain(random), yy = strain(random);
    ASSERT_TRUE(a.drive(power, xx, xy, yx, yy));
    ASSERT_TRUE(b.drive(linear, xx, xy, yx, yy));
    ASSERT_NEAR(a.xx, b.xx, 1e-9);
    ASSERT_NEAR(a.xy, b.xy, 1e-9);
    ASSERT_NEAR(a.plastic_strain, b.plastic_strain, 1e-9);
  }
  EXPECT_GT(a.plastic_strain, 1.0);
}

/// A virgin point under a vertical start of hardening: roots far below the smallest strain anybody cares for.
TEST(J2, AVerticalStartOfHardeningConverges) {
  const J2<PowerHardening> law{1000, 0.33, 1e-9, {.yield_stress = 25, .coefficient = 3, .exponent = 0.05}};
  for (const double excess : {1e-9, 1e-6, 1e-3, 0.1, 2.0, 100.0}) {
    Point point;
    const double shear = 25.0 / std::numbers::sqrt3 / law.shear_modulus() / 2.0 * (1.0 + excess);
    ASSERT_TRUE(point.drive(law, 0, shear, shear, 0)) << excess;
    EXPECT_GT(point.plastic_strain, 0.0) << excess;
    EXPECT_NEAR(point.equivalent() / law.hardening.flow_stress(point.plastic_strain), 1.0, 1e-11) << excess;
  }
}

TEST(J2, SaysThatAStressIsNoLongerANumber) {
  const J2<PowerHardening> power{1000, 0.33, 1e-9, {.yield_stress = 25, .coefficient = 2, .exponent = 0.5}};
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity}) {
    Point a, b;
    EXPECT_FALSE(a.drive(polymer, bad, 0, 0, 0));
    EXPECT_FALSE(b.drive(power, bad, 0, 0, 0));
  }
}

template <class Law>
void expect_same_in_any_lane(const Law& law) {
  std::mt19937 random(3);
  std::normal_distribution<double> strain(0.0, 0.03);
  MaterialPoints together{};
  std::array<Point, lane_count> alone;
  for (int step = 0; step < 15; ++step) {
    StrainIncrement l{};
    for (std::size_t i = 0; i < lane_count; ++i) {
      l.xx[i] = strain(random);
      l.xy[i] = strain(random);
      l.yx[i] = strain(random);
      l.yy[i] = strain(random);
      EXPECT_TRUE(alone[i].drive(law, l.xx[i], l.xy[i], l.yx[i], l.yy[i]));
    }
    EXPECT_TRUE(law.update(l, together));
  }
  for (std::size_t i = 0; i < lane_count; ++i) {
    EXPECT_GT(alone[i].plastic_strain, 0.0);
    EXPECT_NEAR(together.plastic_strain[i], alone[i].plastic_strain, 1e-9);
    EXPECT_NEAR(together.xx[i], alone[i].xx, 1e-9);
    EXPECT_NEAR(together.yy[i], alone[i].yy, 1e-9);
    EXPECT_NEAR(together.zz[i], alone[i].zz, 1e-9);
    EXPECT_NEAR(together.xy[i], alone[i].xy, 1e-9);
  }
}

TEST(J2, APointDoesNotFeelItsNeighboursInTheBatch) {
  expect_same_in_any_lane(polymer);
  expect_same_in_any_lane(
      J2<PowerHardening>{1000, 0.33, 1e-9, {.yield_stress = 25, .coefficient = 2, .exponent = 0.5}});
}

}  // namespace
}  // namespace kerf::laws
