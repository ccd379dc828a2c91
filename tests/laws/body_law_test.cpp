#include "models/laws/body_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kerf::laws {
namespace {

constexpr IdealGas air{.pressure = 1, .reference = 600, .heat_ratio = 1.4, .density = 5.8e-12};
constexpr IdealRubber strip{.C_1 = 0.2,
                            .C_2 = 0.05,
                            .bulk_modulus = 20,
                            .reference = 293,
                            .density = 9.3e-10,
                            .specific_heat = 1.9e9,
                            .thin = false};
const MieGruneisen tungsten{.density = 1.9224e-8,
                            .sound_speed = 4.029e6,
                            .slope = 1.237,
                            .gruneisen = 1.54,
                            .specific_heat = 1.34e8,
                            .shear_modulus = 160e3,
                            .yield_stress = std::numeric_limits<double>::infinity(),
                            .taylor_quinney = 1,
                            .reference = 300};

template <class Law>
BodyPoints at_rest(const Law& law, double temperature) {
  BodyPoints points{};
  const std::vector<Memory> memory = Law::memory();
  for (std::size_t k = 0; k < memory.size(); ++k) points.memory[k] = all_lanes(memory[k].at_rest);
  points.temperature = all_lanes(temperature);
  law.find_stress(points);
  return points;
}

/// tau : l, with l as seen before the step, or after it (l (1 + l)^-1).
double power(const BodyPoints& p, const StrainIncrement& l, bool after) {
  const double xx = l.xx[0], xy = l.xy[0], yx = l.yx[0], yy = l.yy[0];
  if (!after) return p.xx[0] * xx + p.yy[0] * yy + p.xy[0] * (xy + yx);
  const double det = volume_growth(l)[0], minor = xx * yy - xy * yx;
  return (p.xx[0] * (xx + minor) + p.yy[0] * (yy + minor) + p.xy[0] * (xy + yx)) / det;
}

/// dU = tau:l + T dS along random paths at temperatures that wander: stress, entropy and energy come from one free
/// energy. Returns the largest departure over the largest energy met.
template <class Law>
double first_law_gap(const Law& law, double temperature, double reach, int steps) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  BodyPoints p = at_rest(law, temperature);
  const double start = law.energy(p)[0], c = law.heat_capacity();
  double work = 0, heat = 0, gap = 0, largest = 1e-300;
  for (int leg = 0; leg < 6; ++leg) {
    const double step = reach / steps;
    const StrainIncrement l{all_lanes(step * normal(random)), all_lanes(step * normal(random)),
                            all_lanes(step * normal(random)), all_lanes(step * normal(random))};
    const double rise = 0.01 * temperature * normal(random) / steps;
    for (int i = 0; i < steps; ++i) {
      const double before = power(p, l, false), s = law.configurational_entropy(p)[0], T = p.temperature[0];
      law.deform(l, p);
      p.temperature += rise;
      EXPECT_TRUE(law.find_stress(p));
      work += 0.5 * (before + power(p, l, true));
      const double after = p.temperature[0];
      heat += 0.5 * (T + after) * (c * std::log(after / T) + law.configurational_entropy(p)[0] - s);
      largest = std::max({largest, std::abs(work), std::abs(heat)});
      gap = std::max(gap, std::abs(law.energy(p)[0] - start - work - heat));
    }
  }
  return gap / largest;
}

TEST(BodyLaw, StressEntropyAndEnergyOfAGasAreOne) {
  EXPECT_LT(first_law_gap(air, 600, 0.3, 4000), 1e-4);
}
TEST(BodyLaw, StressEntropyAndEnergyOfRubberAreOne) {
  EXPECT_LT(first_law_gap(strip, 293, 0.3, 4000), 1e-4);
}
TEST(BodyLaw, StressEntropyAndEnergyOfAMetalAreOne) {
  EXPECT_LT(first_law_gap(tungsten, 300, 0.02, 4000), 1e-4);
}

TEST(BodyLaw, AGasObeysItsEquationOfState) {
  BodyPoints p = at_rest(air, 450);
  air.deform({all_lanes(0.3), Lanes{}, Lanes{}, all_lanes(-0.1)}, p);
  ASSERT_TRUE(air.find_stress(p));
  const double J = 1.3 * 0.9;
  EXPECT_NEAR(-p.xx[0] / J, 1.0 * 450 / 600 / J, 1e-14);
  EXPECT_NEAR(air.wave_speed(p)[0], std::sqrt(1.4 * 450 / 600 / 5.8e-12), 1e-6);
}

TEST(BodyLaw, ShockedMetalLiesOnItsHugoniot) {
  // On the Hugoniot u = p eta / (2 rho_0) and p = rho_0 C_0^2 eta / (1 - S eta)^2: shock speed C_0 + S u_p.
  for (const double eta : {0.01, 0.05, 0.15}) {
    const double rest = 1 - tungsten.slope * eta;
    const double p_H = tungsten.density * std::pow(tungsten.sound_speed / rest, 2) * eta;
    BodyPoints p = at_rest(tungsten, 300);
    p.memory[0] = all_lanes(1 - eta);
    p.xx = p.yy = p.zz = p.xy = Lanes{};
    const double cold = tungsten.energy(p)[0];
    const double temperature = 300 + (0.5 * p_H * eta - cold) / tungsten.heat_capacity();
    EXPECT_NEAR(tungsten.pressure(1 - eta, temperature) / p_H, 1.0, 1e-12) << eta;
  }
}

TEST(BodyLaw, AMetalThatYieldsTurnsWorkIntoHeat) {
  MieGruneisen soft = tungsten;
  soft.yield_stress = 500;
  BodyPoints p = at_rest(soft, 300);
  double heat = 0;
  for (int i = 0; i < 1000; ++i) {
    soft.deform({Lanes{}, all_lanes(2e-5), all_lanes(2e-5), Lanes{}}, p);
    ASSERT_TRUE(soft.find_stress(p));
    heat += p.heating[0];
  }
  EXPECT_NEAR(p.xy[0], 500 / std::sqrt(3.0), 1e-9);
  // Engineering shear 0.04, of which the elastic part is tau/G.
  EXPECT_NEAR(heat, p.xy[0] * (0.04 - p.xy[0] / soft.shear_modulus), 1e-6 * heat);
}

TEST(BodyLaw, AThinStripPulledIsTheClosedForm) {
  IdealRubber thin = strip;
  thin.thin = true;
  thin.bulk_modulus = 2e5;
  BodyPoints p = at_rest(thin, 293);
  double lambda = 1;
  for (int i = 0; i < 20000; ++i) {
    const double grow = 5e-5;
    // Free across, too: the in-plane contraction that leaves tau_yy = 0 for an incompressible body.
    const double shrink = 1 / std::sqrt(1 + grow) - 1;
    thin.deform({all_lanes(grow), Lanes{}, Lanes{}, all_lanes(shrink)}, p);
    lambda *= 1 + grow;
  }
  ASSERT_TRUE(thin.find_stress(p));
  const double stress = 2 * thin.C_1 * (lambda * lambda - 1 / lambda) + 2 * thin.C_2 * (lambda - 1 / (lambda * lambda));
  EXPECT_NEAR(p.zz[0], 0.0, 1e-6);
  EXPECT_NEAR(p.xx[0] / stress, 1.0, 1e-4);
  EXPECT_NEAR(thin.potential(p)[0],
              thin.C_1 * (lambda * lambda + 2 / lambda - 3) + thin.C_2 * (2 * lambda + 1 / (lambda * lambda) - 3),
              1e-4);
}

TEST(BodyLaw, AHyperelasticBodyShearsAsItsLawSays) {
  const Mechanical<Hencky<LinearHardening>> body{{{1000, 0.33, 1e-9, {.yield_stress = 1e12, .modulus = 0}}}};
  const StrainIncrement simple_shear{Lanes{}, all_lanes(0.5), Lanes{}, Lanes{}};
  BodyPoints p = at_rest(body, 300);
  for (int i = 0; i < 10; ++i) body.deform(simple_shear, p);
  ASSERT_TRUE(body.find_stress(p));
  const double strain = std::asinh(2.5), G = body.law.shear_modulus();
  EXPECT_NEAR(p.xy[3], 2.0 * G * strain / std::sqrt(7.25), 1e-9);
  EXPECT_NEAR(body.energy(p)[3], 2.0 * G * strain * strain, 1e-9);
}

TEST(BodyLaw, WithoutVolumeOrTemperatureThereIsNoStress) {
  BodyPoints p = at_rest(air, 600);
  air.deform({all_lanes(-1.1), Lanes{}, Lanes{}, Lanes{}}, p);
  EXPECT_FALSE(air.find_stress(p));
  BodyPoints cold = at_rest(tungsten, 300);
  cold.temperature = all_lanes(-1);
  EXPECT_FALSE(tungsten.find_stress(cold));
}

}  // namespace
}  // namespace kerf::laws
