// Takes some steps of a small cut for every optional effect, one after the other; under callgrind, which counts the
// instructions of each. Prints a line per effect: its name, its particles and its steps.
#include <valgrind/callgrind.h>

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "forward/bodies/step.hpp"
#include "forward/mpm/crack.hpp"
#include "forward/mpm/tool.hpp"
#include "forward/mpm/transfer.hpp"
#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

constexpr int warm_up = 30, counted = 20;

/// A frictionless, undamped cut with a sharp tool: no optional block but [tool]. The tool bears on the layer at once,
/// and the window is small, so that markers and contacts have their share.
Scene plain() {
  Scene scene = kerf::testing::shipped("verification_45", {{"resolution.cells_through_chip", 4}, {"cut.ramp", 0}});
  scene.pic_damping.reset();
  scene.window = {.ahead = 3, .behind = 1, .below = 1, .above = 1.5};
  return scene;
}

void count(const std::string& name, const Scene& scene, const std::vector<Stage>& stages) {
  State state = lay_out(scene);
  const auto steps = [&](int n) {
    for (int i = 0; i < n; ++i) {
      for (const Stage& stage : stages) stage.apply(state);
      state.time += state.step;
    }
  };
  steps(warm_up);
  CALLGRIND_START_INSTRUMENTATION;
  steps(counted);
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(name.c_str());
  std::printf("%s %zu %d\n", name.c_str(), state.particles.begin[2], counted);
  if (!state.breakdown.empty()) std::printf("%s broke down: %s\n", name.c_str(), state.breakdown.c_str());
}

/// What the solver would be if no optional effect existed, stage by stage; `plan` of a plain scene must not cost more.
std::vector<Stage> written_by_hand(const Scene& scene, bool tool) {
  const double stiffness = 2.0 * laws::plane_strain_modulus(scene.material) / scene.cell();
  std::vector<Stage> stages;
  const auto add = [&](std::function<void(State&)> apply) { stages.push_back({"", "", std::move(apply)}); };
  add(project_velocity);
  add(move_markers);
  if (tool)
    add([&scene](State& state) {
      move_tool(state, scene);
      follow_face(state, scene.cut.depth, 0.02 * scene.cut.depth, false);
    });
  add([&scene](State& state) { update_stress(state, scene.material); });
  add([&scene](State& state) { pull_faces(state, scene.cohesive); });
  add([stiffness](State& state) { close_faces(state, stiffness); });
  if (tool)
    for (std::size_t face : {0, 1})
      add([&scene, contact = contacts(plain()).at(face), stiffness](State& state) {
        press(state, contact, scene, {.stiffness = stiffness, .shear_cap = 0.0});
      });
  add(spread_marker_forces);
  add(accelerate);
  add([](State& state) { advance(state, 0.0); });
  return stages;
}

/// A few hundred points of a bar with no optional block but `options`.
void count_bodies(const std::string& name, const std::string& options) {
  namespace bodies = kerf::forward::bodies;
  const bodies::Scene scene = bodies::read_scene(Document::parse(
      "title = \"bar\"\nmeasures = []\n[box]\nlength = \"32 mm\"\nheight = \"8 mm\"\ncell = \"1 mm\"\n"
      "[[body]]\nlaw = \"j2\"\nelastic_modulus = \"1 GPa\"\npoisson_ratio = 0.3\ndensity = \"1000 kg/m^3\"\n"
      "yield_stress = \"100 MPa\"\nvelocity_x = \"1 m/s\"\nwavelength = \"64 mm\"\n"
      "[[stroke]]\nlongest = \"1 ms\"\n" +
          options,
      "probe.toml"));
  bodies::State state = bodies::lay_out(scene);
  bodies::Joint joint(state, scene);
  const std::vector<bodies::Stage> stages = bodies::plan(scene, joint);
  const auto steps = [&](int n) {
    for (int i = 0; i < n; ++i)
      for (const bodies::Stage& stage : stages) stage.apply(state, scene.strokes[0]);
  };
  steps(warm_up);
  CALLGRIND_START_INSTRUMENTATION;
  steps(counted);
  CALLGRIND_STOP_INSTRUMENTATION;
  CALLGRIND_DUMP_STATS_AT(name.c_str());
  std::printf("%s %zu %d\n", name.c_str(), state.bodies[0].points.size(), counted);
}

}  // namespace
}  // namespace kerf::forward

int main() {
  using namespace kerf::forward;
  const auto planned = [](const std::string& name, const Scene& scene) { count(name, scene, plan(scene)); };
  const auto with = [&](const std::string& name, const std::function<void(Scene&)>& block) {
    Scene scene = plain();
    block(scene);
    planned(name, scene);
  };
  const Scene scene = plain();
  count("by_hand", scene, written_by_hand(scene, true));
  planned("plain", scene);
  with("friction", [](Scene& s) { s.friction = {.coefficient = 0.2, .yield_cap = 0.9}; });
  // A temperature that nothing has to carry, and one that friction changes.
  const auto rub = [](Scene& s, double share) {
    s.friction = {.coefficient = 0.2, .yield_cap = 0.9};
    s.thermal = kerf::testing::shipped("heat_45").thermal;
    s.thermal->expansion = 7e-5;
    s.thermal->friction_share = share;
  };
  with("thermal_friction", [&](Scene& s) { rub(s, 0.0); });
  with("friction_heat", [&](Scene& s) { rub(s, 0.5); });
  with("edge_contact", [](Scene& s) { s.edge_contact = {.press_in = 0.005, .edge_radius = 0.5, .friction = 0.0}; });
  with("chip_breaker", [](Scene& s) { s.chip_breaker = {.distance = 1.0, .angle = -0.2, .land = 2.0}; });
  with("sole", [](Scene& s) { s.sole = {.opening = 1.0, .corner_radius = 0.05}; });
  with("nose_bar", [](Scene& s) { s.nose_bar = {.lead = 1.0, .radius = 0.5, .compression = 0.0}; });
  with("bridging", [](Scene& s) { s.bridging = {.cut = true}; });
  with("pic_damping", [](Scene& s) { s.pic_damping = {.rate = 0.025}; });
  with("xpic_damping", [](Scene& s) { s.xpic_damping = {.rate = 0.025, .order = 2}; });
  with("thermostat", [](Scene& s) { s.thermostat = {.kinetic_share = 0.01, .gain = 0.01}; });
  Scene specimen = plain();
  specimen.grips = {.both_arms = true, .position = 0.75, .width = 0.125, .gauge = 0.25, .lower_arm = 0.5};
  count("no_tool", specimen, written_by_hand(specimen, false));
  planned("grips", specimen);
  count_bodies("bodies", "");
  count_bodies("bodies_gravity", "[gravity]\ny = \"-10 m/s^2\"\n");
  count_bodies("bodies_pic_damping", "[pic_damping]\nrate = 0.02\n");
}
