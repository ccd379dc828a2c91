#include "models/laws/hencky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <numbers>
#include <random>

#include "tests/laws/material_point.hpp"

namespace kerf::laws {
namespace {

using Eigen::Matrix2d;

constexpr J2<LinearHardening> hypoelastic{
    .elastic_modulus = 1000, .poisson_ratio = 0.33, .density = 1e-9, .hardening = {.yield_stress = 25, .modulus = 30}};
constexpr Hencky<LinearHardening> polymer{hypoelastic};
constexpr Hencky<LinearHardening> elastic{{1000, 0.33, 1e-9, {.yield_stress = 1e12, .modulus = 0}}};

Matrix2d rotation(double angle) {
  return Eigen::Rotation2Dd(angle).toRotationMatrix();
}
Matrix2d in_plane(const Point& point) {
  Matrix2d stress;
  stress << point.xx, point.xy, point.xy, point.yy;
  return stress;
}
template <class Law>
bool drive(Point& point, const Law& law, const Matrix2d& l) {
  return point.drive(law, l(0, 0), l(0, 1), l(1, 0), l(1, 1));
}
/// The gradient that makes a step of the deformation gradient f.
Matrix2d gradient_of(const Matrix2d& f) {
  return 2.0 * (f - Matrix2d::Identity()) * (f + Matrix2d::Identity()).inverse();
}
Matrix2d random_matrix(std::mt19937& random, double size) {
  std::normal_distribution<double> normal(0.0, size);
  Matrix2d m;
  m << normal(random), normal(random), normal(random), normal(random);
  return m;
}

TEST(Hencky, SeriesAndFunctionsAgreeOnBothSidesOfTheirBorders) {
  for (double x = 1e-4; x < 0.9; x *= 1.1) {
    EXPECT_NEAR(sinh_ratio(all_lanes(x * x))[3], std::sinh(x) / x, 4e-16 * std::sinh(x) / x) << x;
    EXPECT_NEAR(atanh_ratio(all_lanes(x * x))[3], std::atanh(x) / x, 4e-16 * std::atanh(x) / x) << x;
  }
  EXPECT_EQ(sinh_ratio(Lanes{0.0, 1.0})[0], 1.0);
  EXPECT_EQ(atanh_ratio(Lanes{0.0, 0.5})[0], 1.0);
}

/// b = F F^T of simple shear gives the log strain asinh(gamma/2) in closed form, at any gamma and in any steps.
TEST(Hencky, SimpleShearToFiveFollowsTheExactSolution) {
  for (const int steps : {1, 10, 5000}) {
    Point point;
    for (int i = 1; i <= steps; ++i) {
      ASSERT_TRUE(point.drive(elastic, 0, 5.0 / steps, 0, 0));
      const double gamma = 5.0 * i / steps;
      const double shear = 2.0 * elastic.shear_modulus() * std::asinh(gamma / 2) / std::sqrt(1.0 + gamma * gamma / 4);
      ASSERT_NEAR(point.xy, shear, 1e-9) << gamma;
      ASSERT_NEAR(point.xx, shear * gamma / 2, 1e-9) << gamma;
      ASSERT_NEAR(point.yy, -shear * gamma / 2, 1e-9) << gamma;
      ASSERT_NEAR(point.zz, 0.0, 1e-9) << gamma;
    }
  }
}

/// Beside it: the Jaumann rate of J2 makes the stress swing, G sin(gamma).
TEST(Hencky, TheJaumannRateSwingsWhereHenckyDoesNot) {
  J2<LinearHardening> law = hypoelastic;
  law.hardening.yield_stress = 1e12;
  const double G = law.shear_modulus();
  Point point;
  constexpr int steps = 50000;
  for (int i = 1; i <= steps; ++i) {
    point.drive(law, 0, 5.0 / steps, 0, 0);
    ASSERT_NEAR(point.xy, G * std::sin(5.0 * i / steps), 1e-3 * G);
    ASSERT_NEAR(point.xx, G * (1.0 - std::cos(5.0 * i / steps)), 1e-3 * G);
  }
}

TEST(Hencky, ASuperposedRotationTurnsTheStressAndChangesNothingElse) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-1.5, 1.5);
  Point still, turned;
  Matrix2d before = Matrix2d::Identity();
  for (int step = 0; step < 200; ++step) {
    const Matrix2d f = Matrix2d::Identity() + random_matrix(random, 0.02);
    const Matrix2d after = rotation(angle(random)) * before;
    ASSERT_TRUE(drive(still, polymer, gradient_of(f)));
    ASSERT_TRUE(drive(turned, polymer, gradient_of(after * f * before.transpose())));
    before = after;
    ASSERT_LT((after * in_plane(still) * after.transpose() - in_plane(turned)).norm(), 1e-12 * 1000) << step;
    ASSERT_NEAR(still.zz, turned.zz, 1e-9);
    ASSERT_NEAR(still.plastic_strain, turned.plastic_strain, 1e-12);
  }
  EXPECT_GT(still.plastic_strain, 1.0);
}

TEST(Hencky, ASpinOfAnySizeStretchesNothing) {
  Point point;
  drive(point, elastic, Matrix2d{{0.3, 0.2}, {0.1, -0.1}});
  const Point before = point;
  for (int i = 0; i < 1000; ++i) point.drive(elastic, 0, -0.7, 0.7, 0);
  const Matrix2d Q = rotation(1000 * 2.0 * std::atan(0.35));
  EXPECT_LT((Q * in_plane(before) * Q.transpose() - in_plane(point)).norm(), 1e-12 * 1000);
  EXPECT_NEAR(point.equivalent(), before.equivalent(), 1e-12 * 1000);
}

TEST(Hencky, AtSmallStrainsItIsJ2) {
  const J2<LinearHardening> small{210e3, 0.3, 7.8e-9, {.yield_stress = 250, .modulus = 2000}};
  const Hencky<LinearHardening> large{small};
  Point a, b;
  for (const auto& leg : {Matrix2d{{4e-3, 3e-3}, {1e-3, -1e-3}}, Matrix2d{{-5e-3, 0}, {4e-3, 2e-3}}})
    for (int i = 0; i < 200; ++i) {
      drive(a, small, leg / 200);
      drive(b, large, leg / 200);
      ASSERT_LT((in_plane(a) - in_plane(b)).norm(), 1e-3 * in_plane(a).norm());
      ASSERT_NEAR(a.zz, b.zz, 1e-3 * in_plane(a).norm());
      ASSERT_NEAR(a.plastic_strain, b.plastic_strain, 1e-3 * a.plastic_strain);
    }
  EXPECT_GT(a.plastic_strain, 5e-3);
}

TEST(Hencky, StressIsLinearInTheLogarithmOfTheStretch) {
  const double lambda = elastic.lame(), G = elastic.shear_modulus();
  for (const double stretch : {0.3, 0.99, 1.001, 4.0}) {
    Point along, across;
    const double step = std::pow(stretch, 0.1);
    for (int i = 0; i < 10; ++i) {
      ASSERT_TRUE(drive(along, elastic, gradient_of(Eigen::Vector2d(step, 1.0).asDiagonal().toDenseMatrix())));
      ASSERT_TRUE(drive(across, elastic, gradient_of(step * Matrix2d::Identity())));
    }
    EXPECT_NEAR(along.xx, (lambda + 2 * G) * std::log(stretch), 1e-10);
    EXPECT_NEAR(along.yy, lambda * std::log(stretch), 1e-10);
    EXPECT_NEAR(along.zz, lambda * std::log(stretch), 1e-10);
    EXPECT_NEAR(across.xx, 2 * (lambda + G) * std::log(stretch), 1e-10);
    EXPECT_NEAR(across.zz, 2 * lambda * std::log(stretch), 1e-10);
    EXPECT_NEAR(across.xy, 0.0, 1e-12);
  }
}

/// Hyperelastic: the stress is a function of F alone. The Jaumann rate is not: its stress depends on the way.
TEST(Hencky, AClosedElasticPathEndsWhereItBegan) {
  std::mt19937 random(11);
  J2<LinearHardening> rate_law = hypoelastic;
  rate_law.hardening.yield_stress = 1e12;
  Point point, rate;
  Matrix2d F = Matrix2d::Identity();
  const auto step = [&](const Matrix2d& f) {
    ASSERT_TRUE(drive(point, elastic, gradient_of(f)));
    drive(rate, rate_law, gradient_of(f));
    F = f * F;
  };
  for (int i = 0; i < 30; ++i) step(Matrix2d::Identity() + random_matrix(random, 0.05));
  EXPECT_GT(point.equivalent(), 50.0);
  step(F.inverse());
  EXPECT_LT(in_plane(point).norm() + std::abs(point.zz), 1e-9);
  EXPECT_LT(elastic.elastic_energy(point.stress()), 1e-15);
  EXPECT_GT(in_plane(rate).norm(), 1.0);
}

/// The work of a closed elastic path vanishes with the square of the step.
TEST(Hencky, AnElasticCycleReturnsItsWork) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const auto work = [](int steps) {
    Point point;
    for (int i = 0; i < steps; ++i) {
      const double at = turn * (i + 0.5) / steps, length = turn / steps;
      const auto F = [](double t) { return Matrix2d{{1.0 + 0.4 * std::sin(t), 0.8 * (1.0 - std::cos(t))}, {0, 1}}; };
      drive(point, elastic, gradient_of(F(at + length / 2) * F(at - length / 2).inverse()));
    }
    EXPECT_LT(in_plane(point).norm(), 1e-9);
    return std::abs(point.work);
  };
  EXPECT_LT(work(1000), 1e-3);
  EXPECT_NEAR(work(500) / work(1000), 4.0, 0.2);
}

/// The point begins to yield within a step, so the order is a little below two.
TEST(Hencky, WorkIsStoredOrDissipatedNearlyToTheSquareOfTheStep) {
  const Hencky<PowerHardening> power{{1000, 0.33, 1e-9, {.yield_stress = 25, .coefficient = 2, .exponent = 0.4}}};
  EXPECT_LT(unexplained_work(polymer, 1000), 1e-6);
  EXPECT_GT(unexplained_work(polymer, 250) / unexplained_work(polymer, 4000), 100.0);
  EXPECT_LT(unexplained_work(power, 1000), 1e-6);
  EXPECT_GT(unexplained_work(power, 250) / unexplained_work(power, 4000), 100.0);
}

/// Pure shear keeps its axes: logarithmic strains of elastic and plastic part add up, and no volume changes.
template <class Hardening>
void shear_far(const Hardening& hardening) {
  const Hencky<Hardening> law{{1000, 0.33, 1e-9, hardening}};
  constexpr int steps = 300;
  constexpr double shear = 5e-3;
  Point point;
  for (int i = 1; i <= steps; ++i) {
    ASSERT_TRUE(point.drive(law, 0, shear, shear, 0));
    ASSERT_NEAR(i * 4.0 * std::atanh(shear / 2),
                point.xy / law.shear_modulus() + std::numbers::sqrt3 * point.plastic_strain, 1e-10);
    ASSERT_LE(point.equivalent(), hardening.flow_stress(point.plastic_strain) * (1.0 + 1e-11));
  }
  EXPECT_NEAR(point.equivalent() / hardening.flow_stress(point.plastic_strain), 1.0, 1e-11);
  EXPECT_NEAR(point.xx + point.yy + point.zz, 0.0, 1e-9);
}

TEST(Hencky, ShearFollowsEveryHardeningCurve) {
  shear_far(polymer.hardening);
  for (const double n : {0.1, 0.5, 1.0, 2.0})
    for (const double K : {0.0, 1.0, 10.0})
      shear_far(PowerHardening{.yield_stress = 25, .coefficient = K, .exponent = n});
  shear_far(SaturatingHardening{.yield_stress = 25, .saturation_stress = 60, .saturation_strain = 0.1});
}

TEST(Hencky, RefusesAStepThatTurnsAPointInsideOut) {
  for (const double l : {-2.0, -3.0, std::numeric_limits<double>::quiet_NaN()}) {
    Point point;
    EXPECT_FALSE(point.drive(elastic, l, 0, 0, 0)) << l;
  }
}

}  // namespace
}  // namespace kerf::laws
