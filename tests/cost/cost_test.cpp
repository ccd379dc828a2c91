#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "tests/shipped_scene.hpp"

#ifndef KERF_COST_PROBE
#define KERF_COST_PROBE ""
#endif

// What a scene does not name costs nothing: neither an instruction nor a byte.
namespace kerf::forward {
namespace {

namespace fs = std::filesystem;
using testing::shipped;

/// Instructions per particle-step of every case of the probe (tests/cost/probe), counted by callgrind.
std::map<std::string, double> instructions() {
  // Of this process alone: another build of the probe may be counted at the same time.
  const fs::path folder = fs::path(::testing::TempDir()) / fmt::format("kerf_cost-{}", ::getpid());
  fs::create_directories(folder);
  const std::string command = fmt::format(
      "cd '{}' && valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file=counted '{}' >cases 2>log",
      folder.string(), KERF_COST_PROBE);
  if (std::system(command.c_str()) != 0) return {};
  std::map<std::string, double> counts;
  std::ifstream cases(folder / "cases");
  std::string name;
  double particles = 0, steps = 0;
  for (int part = 1; cases >> name >> particles >> steps; ++part) {
    std::ifstream counted(folder / fmt::format("counted.{}", part));
    bool named = false;
    for (std::string line; std::getline(counted, line);) {
      named |= line == "desc: Trigger: Client Request: " + name;
      if (named && line.starts_with("totals: ")) counts[name] = std::stod(line.substr(8)) / (particles * steps);
    }
  }
  fs::remove_all(folder);
  return counts;
}

TEST(Cost, AnAbsentEffectRunsNoInstruction) {
  if (std::string(KERF_COST_PROBE).empty() || std::system("command -v valgrind >/dev/null") != 0)
    GTEST_SKIP() << "valgrind counts the instructions, and is not installed (scripts/install-deps.sh)";
  const std::map<std::string, double> count = instructions();
  ASSERT_EQ(count.size(), 18u);
  for (const auto& [name, per_particle_step] : count)
    std::printf("%-18s %8.1f instructions per particle-step\n", name.c_str(), per_particle_step);

  EXPECT_NEAR(count.at("plain") / count.at("by_hand"), 1.0, 2e-4);
  for (const char* effect : {"friction", "edge_contact", "chip_breaker", "sole", "nose_bar", "bridging", "pic_damping",
                             "xpic_damping", "thermostat"})
    EXPECT_GT(count.at(effect) / count.at("plain"), 1.001) << effect;
  EXPECT_NEAR(count.at("thermal_friction") / count.at("friction"), 1.0, 2e-4);
  EXPECT_GT(count.at("friction_heat") / count.at("friction"), 1.001);
  EXPECT_GT(count.at("grips") / count.at("no_tool"), 1.001);
  for (const char* effect : {"bodies_gravity", "bodies_pic_damping"})
    EXPECT_GT(count.at(effect) / count.at("bodies"), 1.001) << effect;
}

/// Bytes that a state holds after a few steps, by what holds them.
struct Bytes {
  std::size_t per_particle, axes, filtered, top, slip;
};
Bytes bytes_of(const Scene& scene) {
  State state = lay_out(scene);
  const std::vector<Stage> stages = plan(scene);
  for (int step = 0; step < 3; ++step)
    for (const Stage& stage : stages) stage.apply(state);
  std::size_t slip = 0;
  for (const Face* face : {&state.crack.face[below], &state.crack.face[above], &state.top})
    for (const auto& list : face->slip) slip += list.capacity();
  Particles& p = state.particles;
  for (const Particles::Field& field : p.fields()) EXPECT_EQ(field.values->size(), p.size()) << field.name;
  constexpr std::size_t number = sizeof(double);
  return {
      .per_particle = number * p.fields().size(),
      .axes = number * (p.axis_x.capacity() + p.axis_y.capacity()),
      .filtered = number * (state.grid.side[below].filtered.capacity() + state.grid.side[above].filtered.capacity()),
      .top = number * state.top.x.capacity(),
      .slip = number * slip};
}

TEST(Cost, AnAbsentEffectHoldsNoByte) {
  Scene scene = shipped("verification_45", {{"resolution.cells_through_chip", 4}});
  const Bytes plain = bytes_of(scene);
  EXPECT_EQ(plain.per_particle, 80u);
  EXPECT_EQ(plain.axes, 0u);
  EXPECT_EQ(plain.filtered, 0u);
  EXPECT_EQ(plain.top, 0u);
  EXPECT_EQ(plain.slip, 0u);

  scene.friction = {.coefficient = 0.2, .yield_cap = 0.9};
  scene.sole = {.opening = 1.0, .corner_radius = 0.05};
  scene.xpic_damping = {.rate = 0.025, .order = 2};
  const Bytes loaded = bytes_of(scene);
  EXPECT_EQ(loaded.per_particle, plain.per_particle);
  EXPECT_GT(loaded.filtered, 0u);
  EXPECT_GT(loaded.top, 0u);
  EXPECT_GT(loaded.slip, 0u);

  // Without conduction a temperature follows from the plastic strain.
  Scene hot = shipped("heat_45", {{"resolution.cells_through_chip", 4}});
  EXPECT_EQ(bytes_of(hot).per_particle, plain.per_particle);
  const Scene cold = shipped("verification_45");
  EXPECT_EQ(plan(hot).size(), plan(cold).size());
  hot.thermal->expansion = 7e-5;
  EXPECT_EQ(bytes_of(hot).per_particle, plain.per_particle);
  EXPECT_EQ(plan(hot).size(), plan(cold).size());
  Scene rubbed = hot;
  rubbed.friction = {.coefficient = 0.2, .yield_cap = 0.9};
  EXPECT_EQ(plan(rubbed).size(), plan(cold).size());
  EXPECT_TRUE(lay_out(rubbed).friction_heat[above].empty());
  rubbed.thermal->friction_share = 0.5;
  EXPECT_EQ(plan(rubbed).size(), plan(cold).size() + 1);
  EXPECT_EQ(bytes_of(rubbed).per_particle, plain.per_particle + sizeof(double));
  EXPECT_FALSE(lay_out(rubbed).friction_heat[above].empty());
  hot.thermal->conductivity = 1;
  EXPECT_EQ(bytes_of(hot).per_particle, plain.per_particle + sizeof(double));
  EXPECT_EQ(plan(hot).size(), plan(cold).size() + 1);

  EXPECT_EQ(bytes_of(shipped("hyperelastic_45")).per_particle, plain.per_particle);
  const Bytes hill = bytes_of(shipped("wood_rl"));
  EXPECT_EQ(hill.per_particle, plain.per_particle + 2 * sizeof(double));
  EXPECT_GT(hill.axes, 0u);
}

}  // namespace
}  // namespace kerf::forward
