#include "models/laws/hill.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "models/laws/j2.hpp"
#include "tests/laws/material_point.hpp"

namespace kerf::laws {
namespace {

constexpr double infinite = Hill::infinite;
constexpr double degree = std::numbers::pi / 180;

/// Douglas-fir (Nairn 2016) cut along the grain. RL: x = L, y = R, z = T.
constexpr Hill::Constants fir_RL{.modulus_x = 14500,
                                 .modulus_y = 960,
                                 .modulus_z = 620,
                                 .shear_modulus_xy = 830,
                                 .poisson_xy = 0.37,
                                 .poisson_xz = 0.42,
                                 .poisson_yz = 0.35,
                                 .density = 5e-10,
                                 .yield_x = 100,
                                 .yield_y = 10,
                                 .yield_z = 10,
                                 .shear_yield_xy = 30};
/// TL: x = L, y = T, z = R. nu_TR = nu_RT E_T / E_R.
constexpr Hill::Constants fir_TL{.modulus_x = 14500,
                                 .modulus_y = 620,
                                 .modulus_z = 960,
                                 .shear_modulus_xy = 760,
                                 .poisson_xy = 0.42,
                                 .poisson_xz = 0.37,
                                 .poisson_yz = 0.35 * 620 / 960,
                                 .density = 5e-10,
                                 .yield_x = 100,
                                 .yield_y = 10,
                                 .yield_z = 10,
                                 .shear_yield_xy = 30};

Hill::Constants isotropic(double E, double nu, double yield) {
  return {.modulus_x = E,
          .modulus_y = E,
          .modulus_z = E,
          .shear_modulus_xy = E / (2 * (1 + nu)),
          .poisson_xy = nu,
          .poisson_xz = nu,
          .poisson_yz = nu,
          .density = 1e-9,
          .yield_x = yield,
          .yield_y = yield,
          .yield_z = yield,
          .shear_yield_xy = yield / std::numbers::sqrt3};
}

/// Stiffness and Hill matrix over (xx, yy, zz, xy) written from the definitions, the slow way.
Eigen::Matrix4d stiffness(const Hill::Constants& c) {
  Eigen::Matrix4d s = Eigen::Matrix4d::Zero();
  s(0, 0) = 1 / c.modulus_x;
  s(1, 1) = 1 / c.modulus_y;
  s(2, 2) = 1 / c.modulus_z;
  s(3, 3) = 1 / c.shear_modulus_xy;
  s(0, 1) = s(1, 0) = -c.poisson_xy / c.modulus_x;
  s(0, 2) = s(2, 0) = -c.poisson_xz / c.modulus_x;
  s(1, 2) = s(2, 1) = -c.poisson_yz / c.modulus_y;
  return s.inverse();
}
/// Coefficients of the criterion; they are differences of nearly equal numbers, so in long double.
struct Criterion {
  long double F, G, H, shear;

  explicit Criterion(const Hill::Constants& c) {
    const auto square = [](long double strength) { return 1 / (strength * strength); };
    const long double x = square(c.yield_x), y = square(c.yield_y), z = square(c.yield_z);
    F = (y + z - x) / 2;
    G = (z + x - y) / 2;
    H = (x + y - z) / 2;
    shear = square(c.shear_yield_xy);
  }
  /// s of a stress, by differences: pressure a thousand times the yield stress must not cost digits.
  double operator()(const Eigen::Vector4d& stress) const {
    const long double xz = stress(0) - stress(2), yz = stress(1) - stress(2), yx = stress(1) - stress(0),
                      xy = stress(3);
    return static_cast<double>(std::sqrt(F * yz * yz + G * xz * xz + H * yx * yx + shear * xy * xy));
  }
  /// s ds/d stress.
  Eigen::Vector4d gradient(const Eigen::Vector4d& stress) const {
    const long double xz = stress(0) - stress(2), yz = stress(1) - stress(2), yx = stress(1) - stress(0);
    return {static_cast<double>(G * xz - H * yx), static_cast<double>(F * yz + H * yx),
            static_cast<double>(-F * yz - G * xz), static_cast<double>(shear * stress(3))};
  }
  /// s_zz over the stress (xx, yy) that has no plastic strain along z.
  double held_zz(double xx, double yy) const { return static_cast<double>((F * yy + G * xx) / (F + G)); }
};

TEST(Hill, ShearYieldsAtItsShearStrength) {
  const Hill law(fir_RL);
  Point point;
  for (int i = 0; i < 200; ++i) point.drive(law, 0, 5e-4, 5e-4, 0);
  EXPECT_NEAR(point.xy, 30.0, 1e-9);
  // q = Y_ref t / Y_xy and dw = t d gamma_p = Y_ref d eps.
  EXPECT_NEAR(point.plastic_strain, 0.3 * (0.2 - 30.0 / 830.0), 1e-9);
}

TEST(Hill, UniaxialStrainFollowsTheStiffness) {
  const Hill law(fir_RL);
  const Eigen::Matrix4d c = stiffness(fir_RL);
  Point x, y;
  x.drive(law, 1e-5, 0, 0, 0);
  y.drive(law, 0, 0, 0, 1e-5);
  EXPECT_NEAR(x.xx, c(0, 0) * 1e-5, 1e-12);
  EXPECT_NEAR(x.yy, c(1, 0) * 1e-5, 1e-12);
  EXPECT_NEAR(x.zz, c(2, 0) * 1e-5, 1e-12);
  EXPECT_NEAR(y.xx, c(0, 1) * 1e-5, 1e-12);
  EXPECT_NEAR(y.yy, c(1, 1) * 1e-5, 1e-12);
  EXPECT_NEAR(y.zz, c(2, 1) * 1e-5, 1e-12);
  EXPECT_EQ(x.plastic_strain, 0.0);
}

/// A bar in plane strain: with s_yy = 0 and plastic e_zz = 0 in the limit, s_zz = s_xx G/(F+G), which leaves
/// s_xx^2 (H + FG/(F+G)) = 1.
TEST(Hill, PlaneStrainTensionReachesItsLimit) {
  for (Hill::Constants c : {fir_RL, fir_TL, isotropic(1000, 0.3, 25)}) {
    const Hill law(c);
    Point point;
    for (int i = 0; i < 600; ++i) point.pull_along_x(law, 1e-3);
    const Criterion criterion(c);
    EXPECT_NEAR(point.zz, criterion.held_zz(point.xx, 0), 1e-4);
    EXPECT_NEAR(point.xx * criterion({1, 0, criterion.held_zz(1, 0), 0}), 1.0, 1e-7);
  }
}

/// Tension at an angle to the grain: grid strains that keep s_yy = s_xy = 0 in the frame of the grid. The yield stress
/// there is the closed form with s_zz eliminated by plane strain, as in the test above.
TEST(Hill, OffAxisYieldFollowsTheClosedForm) {
  for (const Hill::Constants& constants : {fir_RL, fir_TL})
    for (const double angle : {15.0, 30.0, 45.0, 75.0}) {
      const Hill law(constants);
      const double c = std::cos(angle * degree), s = std::sin(angle * degree);
      Point point;
      point.axis_x = c;
      point.axis_y = -s;  // the pull comes at this angle to the grain
      // Two unknowns, the strain across and the shear, by Newton with differences; symmetric, so the axes do not turn.
      Eigen::Vector2d guess(-1e-4, 0.0);
      for (int step = 0; step < 1500; ++step) {
        const Point start = point;
        const auto residual = [&](const Eigen::Vector2d& e) {
          point = start;
          EXPECT_TRUE(point.drive(law, 1e-3, e(1), e(1), e(0)));
          return Eigen::Vector2d(point.yy, point.xy);
        };
        for (int iteration = 0; iteration < 60; ++iteration) {
          const Eigen::Vector2d at = residual(guess);
          if (at.norm() < 1e-10) break;
          constexpr double h = 1e-9;
          Eigen::Matrix2d slope;
          slope.col(0) = (residual(guess + Eigen::Vector2d(h, 0)) - at) / h;
          slope.col(1) = (residual(guess + Eigen::Vector2d(0, h)) - at) / h;
          guess -= slope.fullPivLu().solve(at);
        }
        residual(guess);
      }
      const Criterion criterion(constants);
      const Eigen::Vector4d limit(c * c, s * s, criterion.held_zz(c * c, s * s), -c * s);
      EXPECT_LT(std::abs(point.yy) + std::abs(point.xy), 1e-8) << angle;
      EXPECT_NEAR(point.xx * criterion(limit), 1.0, 1e-6) << angle;
      EXPECT_NEAR(point.axis_x, c, 1e-14);
    }
}

TEST(Hill, RotationTurnsTheStressAndTheAxesAndChangesNothingElse) {
  const Hill law(fir_RL);
  Point point;
  point.drive(law, 0.01, 0.004, 0.004, -0.006);
  const Point before = point;
  constexpr int steps = 2000;
  const double spin = std::numbers::pi / 2 / steps;
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(point.drive(law, 0, -spin, spin, 0));
  EXPECT_NEAR(point.xx, before.yy, 2e-5);
  EXPECT_NEAR(point.yy, before.xx, 2e-5);
  EXPECT_NEAR(point.xy, -before.xy, 2e-5);
  EXPECT_NEAR(point.axis_x, 0.0, 1e-6);
  EXPECT_NEAR(std::hypot(point.axis_x, point.axis_y), 1.0, 1e-15);
  EXPECT_NEAR(law.elastic_energy(point.stress()), law.elastic_energy(before.stress()), 1e-11);
  EXPECT_NEAR(point.plastic_strain, before.plastic_strain, 1e-12);
}

/// The same history seen from a turned frame gives the same stress, turned.
TEST(Hill, DoesNotDependOnTheFrame) {
  const Hill law(fir_TL);
  const double c = std::cos(0.7), s = std::sin(0.7);
  Point here, there;
  there.axis_x = c;
  there.axis_y = s;
  std::mt19937 random(5);
  std::normal_distribution<double> strain(0.0, 0.01);
  for (int i = 0; i < 200; ++i) {
    Eigen::Matrix2d l, r;
    l << strain(random), strain(random), strain(random), strain(random);
    r << c, -s, s, c;
    const Eigen::Matrix2d turned = r * l * r.transpose();
    ASSERT_TRUE(here.drive(law, l(0, 0), l(0, 1), l(1, 0), l(1, 1)));
    ASSERT_TRUE(there.drive(law, turned(0, 0), turned(0, 1), turned(1, 0), turned(1, 1)));
    Eigen::Matrix2d stress;
    stress << here.xx, here.xy, here.xy, here.yy;
    const Eigen::Matrix2d expected = r * stress * r.transpose();
    ASSERT_NEAR(there.xx, expected(0, 0), 1e-8);
    ASSERT_NEAR(there.yy, expected(1, 1), 1e-8);
    ASSERT_NEAR(there.xy, expected(0, 1), 1e-8);
    ASSERT_NEAR(there.zz, here.zz, 1e-8);
    ASSERT_NEAR(law.elastic_energy(there.stress()), law.elastic_energy(here.stress()), 1e-9);
  }
}

TEST(Hill, WithIsotropicConstantsItIsJ2) {
  for (const double K : {0.0, 2.0}) {
    Hill::Constants constants = isotropic(1000, 0.33, 25);
    constants.hardening_coefficient = K;
    const Hill hill(constants);
    const J2<LinearHardening> j2{1000, 0.33, 1e-9, {.yield_stress = 25, .modulus = 25 * K}};
    std::mt19937 random(11);
    std::normal_distribution<double> strain(0.0, 0.02);
    Point a, b;
    for (int i = 0; i < 1000; ++i) {
      const double xx = strain(random), xy = strain(random), yx = strain(random), yy = strain(random);
      ASSERT_TRUE(a.drive(hill, xx, xy, yx, yy));
      ASSERT_TRUE(b.drive(j2, xx, xy, yx, yy));
      const double size = 1.0 + std::abs(b.xx) + b.plastic_strain;
      ASSERT_NEAR(a.xx, b.xx, 1e-10 * size);
      ASSERT_NEAR(a.yy, b.yy, 1e-10 * size);
      ASSERT_NEAR(a.zz, b.zz, 1e-10 * size);
      ASSERT_NEAR(a.xy, b.xy, 1e-10 * size);
      ASSERT_NEAR(a.plastic_strain, b.plastic_strain, 1e-10 * size);
      ASSERT_NEAR(hill.elastic_energy(a.stress()), j2.elastic_energy(b.stress()), 1e-9 * size);
      ASSERT_NEAR(hill.plastic_work(a.plastic_strain), j2.plastic_work(b.plastic_strain), 1e-8 * size);
    }
    EXPECT_GT(a.plastic_strain, 2.0);
    EXPECT_NEAR(hill.plane_strain_modulus(), j2.plane_strain_modulus(), 1e-9);
    EXPECT_NEAR(hill.wave_speed(std::cos(0.3), std::sin(0.3)), j2.wave_speed(), 1e-9 * j2.wave_speed());
    EXPECT_NEAR(hill.shear_yield(), j2.shear_yield(), 1e-12);
  }
}

TEST(Hill, HardeningFollowsItsCurveInShear) {
  for (const double n : {0.05, 0.3, 0.5, 1.0, 2.0}) {
    Hill::Constants constants = fir_RL;
    constants.hardening_coefficient = 1.5;
    constants.hardening_exponent = n;
    const Hill law(constants);
    Point point;
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(point.drive(law, 0, 5e-4, 5e-4, 0));
      if (point.plastic_strain > 0) {
        ASSERT_NEAR(point.xy, 30.0 * (1 + 1.5 * std::pow(point.plastic_strain, n)), 1e-9);
      }
    }
    EXPECT_NEAR(0.2, point.xy / 830 + point.plastic_strain * 100.0 / 30.0, 1e-10);
  }
}

TEST(Hill, WorkIsStoredOrDissipatedToTheOrderOfTheStep) {
  for (const Hill::Constants& start : {fir_RL, fir_TL})
    for (const double n : {0.4, 1.0}) {
      Hill::Constants constants = start;
      constants.hardening_coefficient = 0.5;
      constants.hardening_exponent = n;
      const Hill law(constants);
      const double coarse = unexplained_work(law, 4000), fine = unexplained_work(law, 8000);
      EXPECT_LT(fine, 2e-3);
      EXPECT_NEAR(std::log2(coarse / fine), 1.0, 0.2);
    }
}

/// Steps in random directions, up to a hundred times the yield strain: the stress must satisfy the yield condition and
/// the flow rule with the matrices written from their definitions.
TEST(Hill, TheReturnMapLeavesNoResidual) {
  std::vector<Hill::Constants> sets{fir_RL, fir_TL, isotropic(1000, 0.33, 25), isotropic(1000, 0.499, 25)};
  sets.push_back(fir_RL);  // cannot yield along the grain: y and z yield together
  sets.back().yield_x = infinite;
  sets.push_back(fir_RL);  // only shear yields
  sets.back().yield_x = sets.back().yield_y = sets.back().yield_z = infinite;
  sets.push_back(fir_RL);  // shear never does
  sets.back().shear_yield_xy = infinite;
  sets.push_back(fir_RL);  // nearly flat: 1/Y_y = 1/Y_x + 1/Y_z but for a part in a million
  sets.back().yield_y = 1 / (1 / 100.0 + 1 / 10.0) * (1 + 1e-6);
  // Strengths three orders apart. Rounding the stress alone costs (1e4/10)^2 times 1e-16 in the flow direction.
  sets.push_back(fir_RL);
  sets.back().yield_x = 1e4;
  const std::size_t plain = sets.size();
  for (std::size_t k = 0; k < plain; ++k)
    for (const double n : {0.2, 1.0, 1.7}) {
      sets.push_back(sets[k]);
      sets.back().hardening_coefficient = 1.3;
      sets.back().hardening_exponent = n;
    }
  std::mt19937 random(17);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> decades(-3.0, 0.0);
  int yielded = 0, tried = 0;
  double worst = 0.0;
  for (const Hill::Constants& constants : sets) {
    const Hill law(constants);
    const Eigen::Matrix4d c = stiffness(constants);
    const Criterion criterion(constants);
    constexpr std::size_t n = lane_count;
    for (int trial = 0; trial < 420; ++trial) {
      StrainIncrement l{};
      MaterialPoints points{};
      auto& [xx, xy, yx, yy] = l;
      auto& [s_xx, s_yy, s_zz, s_xy, eps, ax, ay] = points;
      Lanes old_eps{};
      std::vector<Eigen::Vector4d> before;
      for (std::size_t i = 0; i < n; ++i) {
        const double size = std::pow(10.0, decades(random));
        xx[i] = size * normal(random);
        yy[i] = size * normal(random);
        xy[i] = yx[i] = size * normal(random);
        Eigen::Vector4d stress(normal(random), normal(random), normal(random), normal(random));
        const double s = criterion(stress);
        old_eps[i] = eps[i] = trial % 3 ? std::abs(normal(random)) : 0.0;
        const double now = 1 + constants.hardening_coefficient * std::pow(eps[i], constants.hardening_exponent);
        if (s > 0) stress *= 0.9 * now / s;  // inside the surface
        if (!(stress.norm() < 1e7)) stress.setZero();
        before.push_back(stress);
        s_xx[i] = stress(0);
        s_yy[i] = stress(1);
        s_zz[i] = stress(2);
        s_xy[i] = stress(3);
        ax[i] = 1;
        ay[i] = 0;
      }
      ASSERT_TRUE(law.update(l, points));
      for (std::size_t i = 0; i < n; ++i) {
        ++tried;
        const Eigen::Vector4d stress(s_xx[i], s_yy[i], s_zz[i], s_xy[i]);
        const Eigen::Vector4d elastic = before[i] + c * Eigen::Vector4d(xx[i], yy[i], 0, xy[i] + yx[i]);
        const double flow = 1 + constants.hardening_coefficient * std::pow(eps[i], constants.hardening_exponent);
        const double s = criterion(stress), step = eps[i] - old_eps[i];
        ASSERT_LE(s, flow * (1 + 1e-9));
        ASSERT_GE(step, 0.0);
        Eigen::Vector4d left = stress - elastic;
        if (step > 0) {
          ++yielded;
          worst = std::max(worst, std::abs(s / flow - 1.0));
          left += step * law.hardening().yield_stress / s * (c * criterion.gradient(stress));
        }
        worst = std::max(worst, left.norm() / elastic.norm());
      }
    }
  }
  EXPECT_GE(tried, 100000);
  EXPECT_GT(yielded, tried / 2);
  EXPECT_LE(worst, 1e-10);
}

TEST(Hill, WithoutStrengthsItStaysElastic) {
  Hill::Constants constants = fir_RL;
  constants.yield_x = constants.yield_y = constants.yield_z = constants.shear_yield_xy = infinite;
  const Hill law(constants);
  Point point;
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(point.drive(law, 1e-2, 1e-2, 1e-2, -3e-2));
  EXPECT_EQ(point.plastic_strain, 0.0);
  EXPECT_NEAR(point.xy, 830 * 2.0, 1e-9);
  EXPECT_NEAR(law.elastic_energy(point.stress()), point.work, 1e-9 * point.work);
}

TEST(Hill, WavesAreThoseOfTheAxes) {
  const Hill law(fir_RL);
  const Eigen::Matrix4d c = stiffness(fir_RL);
  EXPECT_NEAR(law.wave_speed(1, 0), std::sqrt(c(0, 0) / 5e-10), 1e-3);
  EXPECT_NEAR(law.wave_speed(0, 1), std::sqrt(c(1, 1) / 5e-10), 1e-3);
  for (int i = 1; i < 18; ++i) {
    const double speed = law.wave_speed(std::cos(5 * i * degree), std::sin(5 * i * degree));
    EXPECT_LT(speed, law.wave_speed(1, 0));
    EXPECT_GT(speed, law.wave_speed(0, 1) * 0.999);
  }
}

/// Pressed half-space of Douglas-fir, from the roots of the characteristic equation b_11 k^4 - (2 b_12 + b_66) k^2 +
/// b_22 = 0: 2/E' = sqrt(b_11 b_22) (k_1 + k_2), k the roots for decay into the solid.
TEST(Hill, HalfSpaceStiffnessIsTheStrohResult) {
  const Hill law(fir_RL);
  const Eigen::Matrix3d s = stiffness(fir_RL).topLeftCorner<3, 3>().inverse();
  const double b11 = s(0, 0) - s(0, 2) * s(0, 2) / s(2, 2), b22 = s(1, 1) - s(1, 2) * s(1, 2) / s(2, 2);
  const double b12 = s(0, 1) - s(0, 2) * s(1, 2) / s(2, 2), b66 = 1.0 / 830;
  const double half = (2 * b12 + b66) / (2 * b11), root = std::sqrt(half * half - b22 / b11);
  const double k1 = std::sqrt(half + root), k2 = std::sqrt(half - root);
  EXPECT_NEAR(law.plane_strain_modulus(), 2 / (b11 * k1 * k2 * (k1 + k2)), 1e-8);
}

TEST(Hill, SaysWhichConstantsMakeNoMaterial) {
  const auto fault = [](auto change) {
    Hill::Constants constants = fir_RL;
    change(constants);
    const auto found = Hill::fault(constants);
    return found ? found->key : std::string("none");
  };
  EXPECT_EQ(fault([](auto&) {}), "none");
  EXPECT_EQ(fault([](auto& c) { c.poisson_yz = 1.3; }), "poisson_yz");
  EXPECT_EQ(fault([](auto& c) { c.poisson_xy = 3.8, c.poisson_xz = c.poisson_yz = 0; }), "none");
  EXPECT_EQ(fault([](auto& c) { c.poisson_xy = 3.9; }), "poisson_xy");
  EXPECT_EQ(fault([](auto& c) { c.poisson_xy = 3.0, c.poisson_xz = 3.5; }), "poisson_xy");  // each fine alone
  EXPECT_EQ(fault([](auto& c) { c.yield_x = 4.9; }), "yield_x");
  EXPECT_EQ(fault([](auto& c) { c.yield_x = 5.1; }), "none");
  EXPECT_EQ(fault([](auto& c) { c.yield_x = c.yield_y = infinite; }), "yield_z");
  EXPECT_EQ(fault([](auto& c) { c.yield_x = infinite; }), "none");  // Y_y = Y_z: flat, an open tube
}

TEST(Hill, SaysThatAStressIsNoLongerANumber) {
  const Hill law(fir_RL);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinite}) {
    Point point;
    EXPECT_FALSE(point.drive(law, bad, 0, 0, 0));
  }
}

}  // namespace
}  // namespace kerf::laws
