#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/expected_cost.hpp"

namespace kerf::commands {
namespace {

using forward::Scene;
using forward::Stage;
using forward::State;

constexpr double degrees = 57.29577951308232;

void print_cut(const Scene& scene) {
  fmt::print("{}\n\n", scene.title);
  fmt::print("A layer of {:g} mm is cut at {:g} m/s by a rigid tool with a rake angle of {:g} deg. The work is an\n",
             scene.cut.depth, scene.cut.speed / 1e3, scene.tool.rake * degrees);
  fmt::print(
      "elastic-plastic solid in plane strain that separates along the plane y = 0; the cohesive law passes on\n");
  fmt::print("at most {:g} MPa (mode I) and {:g} MPa (mode II), and takes {:g} and {:g} J/m^2 to break.\n\n",
             scene.cohesive.mode_I->strength(), scene.cohesive.mode_II->strength(),
             1e3 * scene.cohesive.mode_I->toughness(), 1e3 * scene.cohesive.mode_II->toughness());
}

void print_discretisation(const Scene& scene, const State& state) {
  const auto& window = scene.window;
  const int side = scene.resolution.particles_per_cell_side;
  fmt::print("Discretisation\n");
  fmt::print("  cells of {:g} mm, {} through the chip, {} x {} particles each: {} particles\n", scene.cell(),
             scene.resolution.cells_through_chip, side, side, state.particles.begin[2]);
  fmt::print("  window around the tip, in depths: {:g} ahead, {:g} behind, {:g} below, {:g} above; it travels along\n",
             window.ahead, window.behind, window.below, window.above);
  fmt::print("  time step {:.3g} us ({:g} of an elastic wave's transit of a cell)\n", 1e6 * state.step,
             scene.resolution.courant_number);
  // The mixed-mode zone is shorter still; this is the length over which mode I traction acts (Hillerborg).
  const double zone = laws::plane_strain_modulus(scene.material) * scene.cohesive.mode_I->toughness() /
                      std::pow(scene.cohesive.mode_I->strength(), 2);
  fmt::print("  the critical opening is {:.2g} cells, the elastic cohesive zone E'G/sigma^2 about {:.2g} cells\n\n",
             scene.cohesive.mode_I->critical_opening() / scene.cell(), zone / scene.cell());
}

void print_stages(const std::vector<Stage>& stages, const std::vector<double>& seconds) {
  double total = 0;
  for (const double stage : seconds) total += stage;
  fmt::print("One time step, in order (share of the time, measured now)\n");
  for (std::size_t i = 0; i < stages.size(); ++i)
    fmt::print("  {:>2}. {:<11}{:>4.0f} %   {}\n", i + 1, stages[i].name, 100 * seconds[i] / total, stages[i].does);
  fmt::print("\n");
}

void print_memory(State& state) {
  const auto fields = state.particles.fields();
  fmt::print("Each particle carries {} bytes, 8 for each of\n  ", 8 * fields.size());
  std::string list;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    list += fields[i].name;
    list += i + 1 == fields.size() ? "\n" : i % 4 == 3 ? ",\n  " : ", ";
  }
  fmt::print("{}The crack is followed by {} pairs of markers.\n\n", list, state.crack.size());
}

void print_absent(const Scene& scene) {
  fmt::print("Not simulated\n");
  if (!scene.friction) fmt::print("  friction on the tool: the scene has no [friction]\n");
  if (!scene.edge_contact)
    fmt::print("  contact of the edge with the cut face: the scene has no [edge_contact], the tool is sharp\n");
  if (!scene.pic_damping) fmt::print("  numerical damping: the scene has no [pic_damping]\n");
  if (!scene.bridging) fmt::print("  bonds cut by the tool's edge: the scene has no [bridging]\n");
  if (!scene.face_friction) fmt::print("  friction between closed crack faces: the scene has no [face_friction]\n");
  if (!scene.chip_breaker) fmt::print("  a chip breaker: the scene has no [chip_breaker]\n");
  if (!scene.sole) fmt::print("  the sole of a plane: the scene has no [sole]\n");
  if (!scene.nose_bar) fmt::print("  a nose bar: the scene has no [nose_bar]\n");
  fmt::print("  heat, rate dependence, a deforming tool, a crack that leaves its plane: no such effects here\n\n");
}

void print_cost(const Scene& scene, const State& state, double seconds_per_step) {
  const ExpectedCost cost = expected_cost(scene, state);
  fmt::print("Expected cost\n");
  fmt::print("  the cut stops between {:g} and {:g} depths of travel, once the standard error of F_c is below {:g} %\n",
             std::min(scene.steady_state.not_before, scene.cut.travel), scene.cut.travel,
             100 * scene.steady_state.tolerance);
  fmt::print(
      "  {:.3g} to {:.3g} steps, {:.2g} to {:.2g} particle-steps, {:.2g} to {:.2g} s at the speed measured now\n",
      cost.least_steps, cost.most_steps, cost.least(), cost.most(), cost.least_steps * seconds_per_step,
      cost.most_steps * seconds_per_step);
}

void explain(const std::string& file) {
  const Scene scene = forward::read_scene(Document::load(file));
  State state = forward::lay_out(scene);
  const std::vector<Stage> stages = forward::plan(scene);
  constexpr int steps = 100;
  const std::vector<double> seconds = time_stages(state, stages, steps);
  double total = 0;
  for (const double stage : seconds) total += stage;

  print_cut(scene);
  print_discretisation(scene, state);
  print_stages(stages, seconds);
  print_memory(state);
  print_absent(scene);
  print_cost(scene, state, total / steps);
}

}  // namespace

void add_explain(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("explain", "Say in plain English what a scene makes the solver do, and its cost");
  const auto file = std::make_shared<std::string>();
  command->add_option("scene", *file, "scene file (TOML)")->required();
  command->callback([file, &exit_code] {
    explain(*file);
    exit_code = 0;
  });
}

}  // namespace kerf::commands
