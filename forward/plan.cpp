#include "forward/plan.hpp"

#include <cmath>
#include <numbers>

#include "forward/effects/edge_contact.hpp"
#include "forward/mpm/crack.hpp"
#include "forward/mpm/tool.hpp"
#include "forward/mpm/transfer.hpp"

namespace kerf::forward {

std::vector<Stage> plan(const Scene& scene) {
  // Stiff enough that faces overlap by about a hundredth of a cell at yield, soft enough for the elastic time step.
  const double stiffness = 2.0 * scene.material.plane_strain_modulus() / scene.cell();
  const double shear_yield = scene.material.yield_stress / std::numbers::sqrt3;
  const double pic =
      scene.pic_damping ? 1.0 - std::exp(-scene.pic_damping->rate * scene.resolution.courant_number) : 0.0;

  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::string does, std::function<void(State&)> apply) {
    stages.push_back({std::move(name), std::move(does), std::move(apply)});
  };
  add("project", "grid velocities p/m of both sides of the crack plane", project_velocity);
  add("markers", "crack-face markers follow the projected velocity of their side", move_markers);
  // A sharp tip runs inside the opened crack, clear of the lower face by a fiftieth of the depth.
  const double lift = scene.edge_contact ? 0.0 : 0.02 * scene.cut.depth;
  add("tool", "the tool advances and its tip follows the lower face", [&scene, lift](State& state) {
    move_tool(state, scene.cut);
    follow_face(state, scene.cut.depth, lift);
  });
  add("stress", "velocity gradients, J2 stresses (stress first), internal forces",
      [&scene](State& state) { update_stress(state, scene.material); });
  add("cohesion", "cohesive tractions between the faces; pairs break at the mixed-mode criterion",
      [&scene](State& state) { pull_faces(state, scene.cohesive); });
  add("closing", "the upper face cannot enter the lower one",
      [stiffness](State& state) { close_faces(state, stiffness); });
  add("rake face", "the rake face presses on the upper side",
      [&scene, stiffness](State& state) { press_rake_face(state, scene.tool.rake, stiffness); });
  if (scene.friction)
    add("friction", "the chip rubs on the rake face, up to the slip limit and the yield cap",
        [&scene, stiffness, shear_yield](State& state) {
          rub_rake_face(state, scene.tool.rake, *scene.friction, shear_yield, stiffness);
        });
  if (scene.edge_contact)
    add("edge", "the worn edge presses on the lower side",
        [&scene, stiffness](State& state) { press_edge(state, *scene.edge_contact, scene.tool.clearance, stiffness); });
  else
    add("underside", "the lower face cannot rise into the tool",
        [&scene, stiffness](State& state) { block_underside(state, scene.tool.clearance, stiffness); });
  add("spread", "marker forces go to the nodes they were interpolated from", spread_marker_forces);
  add("accelerate", "new grid velocities under the fixed boundary", accelerate);
  add("advance",
      pic > 0.0 ? "particles move (FLIP with a share of PIC, booked as damping) and pass on their momentum"
                : "particles move (FLIP) and pass on their momentum",
      [pic](State& state) { advance(state, pic); });
  return stages;
}

}  // namespace kerf::forward
