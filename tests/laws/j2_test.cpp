#include "models/laws/j2.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace kerf::laws {
namespace {

/// One material point driven by velocity gradients.
struct Point {
  double xx = 0, yy = 0, zz = 0, xy = 0, plastic_strain = 0;

  void drive(const J2& law, double l_xx, double l_xy, double l_yx, double l_yy) {
    law.update(1, {&l_xx, &l_xy, &l_yx, &l_yy}, {&xx, &yy, &zz, &xy, &plastic_strain});
  }
  double equivalent() const {
    const double mean = (xx + yy + zz) / 3.0;
    const double a = xx - mean, b = yy - mean, c = zz - mean;
    return std::sqrt(1.5 * (a * a + b * b + c * c + 2.0 * xy * xy));
  }
};

constexpr J2 polymer{
    .elastic_modulus = 1000, .poisson_ratio = 0.33, .density = 1e-9, .yield_stress = 25, .hardening_modulus = 0};

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
  J2 law = polymer;
  law.hardening_modulus = 50;
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
  const auto unexplained = [](int steps) {
    J2 law = polymer;
    law.hardening_modulus = 30;
    Point point;
    double work = 0.0;
    for (int i = 0; i < steps; ++i) {
      const Point old = point;
      const double xx = 0.10 / steps, xy = 0.3 / steps, yx = -0.1 / steps, yy = -0.05 / steps;
      point.drive(law, xx, xy, yx, yy);
      work += 0.5 * ((old.xx + point.xx) * xx + (old.yy + point.yy) * yy + (old.xy + point.xy) * (xy + yx));
    }
    return std::abs(work - law.elastic_energy(point.xx, point.yy, point.zz, point.xy) -
                    law.plastic_work(point.plastic_strain)) /
           work;
  };
  EXPECT_LT(unexplained(1000), 1e-3);
  EXPECT_NEAR(unexplained(500) / unexplained(1000), 2.0, 0.3);  // first order: the return is fully implicit
}

}  // namespace
}  // namespace kerf::laws
