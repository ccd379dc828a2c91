// Heat of plastic work in a cut: what the ledger books is what the particles hold, whether it flows or not.
#include "forward/effects/heat.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "forward/record/recorder.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using testing::shipped;

double capacity(const Scene& scene) {
  return laws::density(scene.material) * scene.thermal->specific_heat;
}

/// As far as the tool comes in `depths` depths of cut.
State cut(const Scene& scene, double depths) {
  State state = lay_out(scene);
  const std::vector<Stage> stages = plan(scene);
  double next = scene.cell_length();
  while (state.tool.x < depths * scene.cut.depth) {
    for (const Stage& stage : stages) stage.apply(state);
    state.time += state.step;
    if (state.tool.x < next) continue;
    next += scene.cell_length();
    shift_window(state, scene);
  }
  return state;
}

TEST(Heat, MeanTemperatureTimesHeatCapacityIsTheShareOfThePlasticWork) {
  for (const double conductivity : {0.0, 1e4}) {  // with the second heat creeps by two depths within this cut
    Scene scene = shipped("heat_45", {{"resolution.cells_through_chip", 4}, {"cut.ramp", 0}});
    scene.thermal->conductivity = conductivity;
    const State state = cut(scene, 2.5);
    ASSERT_TRUE(state.breakdown.empty()) << state.breakdown;
    ASSERT_EQ(state.work.retired_plastic, 0.0);
    const std::vector<double> T = temperatures(state, scene);
    double heat = 0, hottest = 0, coldest = 1e9;
    for (std::size_t i = 0; i < state.particles.begin[2]; ++i) {
      heat += state.particles.volume[i] * capacity(scene) * (T[i] - scene.thermal->start);
      hottest = std::max(hottest, T[i]);
      coldest = std::min(coldest, T[i]);
    }
    const double expected = scene.thermal->taylor_quinney * take_stock(state, scene.material).plastic;
    std::printf("conductivity %g N/(s K): heat %.6f, share of the plastic work %.6f N mm/mm, hottest %.2f K\n",
                conductivity, heat, expected, hottest);
    EXPECT_GT(expected, 1.0);
    EXPECT_NEAR(heat / expected, 1.0, 1e-9);
    EXPECT_GT(coldest, scene.thermal->start - 0.01);
    EXPECT_EQ(hottest > 300.0, conductivity == 0.0);
    EXPECT_EQ(state.particles.conducted.empty(), conductivity == 0.0);
  }
}

TEST(Heat, AShareOfTheFrictionStaysInTheWork) {
  for (const double share : {0.0, 0.4, 1.0}) {
    Scene scene = shipped("friction_45", {{"resolution.cells_through_chip", 4}, {"cut.ramp", 0}});
    scene.thermal = shipped("heat_45").thermal;
    scene.thermal->friction_share = share;
    const State state = cut(scene, 2.0);
    ASSERT_TRUE(state.breakdown.empty()) << state.breakdown;
    ASSERT_EQ(state.work.retired_plastic, 0.0);
    const std::vector<double> T = temperatures(state, scene);
    double heat = 0, chip = 0;
    for (std::size_t i = 0; i < state.particles.begin[2]; ++i) {
      heat += state.particles.volume[i] * capacity(scene) * (T[i] - scene.thermal->start);
      if (share > 0.0 && i >= state.particles.begin[above])
        chip += state.particles.volume[i] * capacity(scene) * state.particles.conducted[i];
    }
    const Ledger ledger = take_stock(state, scene.material);
    const double of_friction = heat - scene.thermal->taylor_quinney * ledger.plastic;
    std::printf("share %.1f: heat of friction %.9f of %.9f N mm/mm of work\n", share, of_friction, ledger.friction);
    EXPECT_GT(ledger.friction, 0.5);
    EXPECT_NEAR(of_friction, share * ledger.friction, 1e-9 * heat);
    EXPECT_NEAR(state.work.friction_heat, share * ledger.friction, 1e-12 * ledger.friction);
    EXPECT_NEAR(chip, share * ledger.friction, 1e-9 * ledger.friction);
    EXPECT_EQ(state.friction_heat[above].empty(), share == 0.0);
    EXPECT_EQ(state.particles.conducted.empty(), share == 0.0);
  }
}

TEST(Heat, WhatIsPulledElasticallyCools) {
  // dT = -alpha T_0 tr(sigma)/(rho c), Thomson 1855.
  Scene scene = shipped("heat_45", {{"resolution.cells_through_chip", 4}});
  scene.thermal->expansion = 7e-5;
  State state = lay_out(scene);
  Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.stress_xx[i] = 12;
    p.stress_zz[i] = i % 2 == 0 ? 4 : -28;
  }
  const std::vector<double> T = temperatures(state, scene);
  const double cooling = 7e-5 * scene.thermal->start * 16 / capacity(scene);
  EXPECT_GT(cooling, 0.1);
  EXPECT_NEAR(T[0] - scene.thermal->start, -cooling, 1e-9);
  EXPECT_NEAR(T[1] - scene.thermal->start, cooling, 1e-9);
  EXPECT_TRUE(p.conducted.empty());
  // Elastic strains give back what they take: in a cut that is over they have moved heat, and made none.
  const CutResult with = run(scene), without = run(shipped("heat_45", {{"resolution.cells_through_chip", 4}}));
  EXPECT_EQ(with.F_c.value, without.F_c.value);
  EXPECT_NEAR(with.heat->chip, without.heat->chip, 0.3);
  EXPECT_NE(with.heat->chip, without.heat->chip);
}

TEST(Heat, TheChipIsAsWarmAsTheForceSays) {
  const Scene scene = shipped("heat_45", {{"resolution.cells_through_chip", 4}});
  const CutResult result = run(scene), cold = run(shipped("verification_45", {{"resolution.cells_through_chip", 4}}));
  ASSERT_TRUE(result.heat.has_value());
  EXPECT_FALSE(cold.heat.has_value());
  EXPECT_TRUE(cold.snapshot.temperature.empty());
  EXPECT_EQ(result.snapshot.temperature.size(), result.snapshot.x.size());
  EXPECT_EQ(result.F_c.value, cold.F_c.value);
  // Of the work that does not part the material a share is plastic, most of it in the chip.
  const double share = result.ledger.plastic / (result.ledger.tool_work - result.ledger.fracture);
  const double expected =
      0.9 * share * (result.F_c.value - result.fracture_energy) / (capacity(scene) * scene.cut.depth);
  std::printf("chip %.2f K warmer, by the force %.2f K\n", result.heat->chip - 293, expected);
  EXPECT_NEAR((result.heat->chip - 293) / expected, 1.0, 0.04);
}

TEST(Heat, ConductionDecaysAsTheCosineOfABarDoes) {
  Scene scene = shipped("heat_45", {{"resolution.cells_through_chip", 8}});
  scene.thermal->conductivity = 1.0;
  State state = lay_out(scene);
  Particles& p = state.particles;
  const double length = scene.window.ahead * scene.cut.depth, wave = std::numbers::pi / length;
  for (std::size_t i = 0; i < p.size(); ++i) p.conducted[i] = std::cos(wave * p.x[i]);
  HeatConduction conduct(scene);
  state.step = longest_conduction_step(state.grid, scene);
  double time = 0;
  const double diffusivity = scene.thermal->conductivity / capacity(scene);
  for (; time < 0.5 / (diffusivity * wave * wave); time += state.step) conduct(state);
  double worst = 0;
  const double left = std::exp(-diffusivity * wave * wave * time);
  for (std::size_t i = 0; i < p.begin[2]; ++i)
    worst = std::max(worst, std::abs(p.conducted[i] - left * std::cos(wave * p.x[i])));
  std::printf("temperature off by %.1e of the first amplitude\n", worst);
  EXPECT_LT(worst, 5e-3);
}

}  // namespace
}  // namespace kerf::forward
