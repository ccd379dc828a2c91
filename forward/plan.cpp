#include "forward/plan.hpp"

#include <cmath>
#include <memory>

#include "forward/effects/bridging.hpp"
#include "forward/effects/face_friction.hpp"
#include "forward/effects/grips.hpp"
#include "forward/effects/heat.hpp"
#include "forward/effects/spindle.hpp"
#include "forward/effects/thermostat.hpp"
#include "forward/effects/xpic.hpp"
#include "forward/mpm/crack.hpp"
#include "forward/mpm/tool.hpp"
#include "forward/mpm/transfer.hpp"

namespace kerf::forward {

std::vector<Stage> plan(const Scene& scene) {
  // Stiff enough that faces overlap by about a hundredth of a cell at yield, soft enough for the elastic time step.
  const double stiffness =
      scene.resolution.contact_stiffness * 2.0 * laws::plane_strain_modulus(scene.material) / scene.cell();
  const double cap = scene.friction ? scene.friction->yield_cap * laws::shear_yield(scene.material) : 0.0;
  const auto each_step = [&](double rate) { return 1.0 - std::exp(-rate * scene.resolution.courant_number); };

  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::string does, std::function<void(State&)> apply) {
    stages.push_back({std::move(name), std::move(does), std::move(apply)});
  };
  add("project", "grid velocities p/m of both sides of the crack plane", project_velocity);
  const auto spindle = scene.log ? std::make_shared<Spindle>(scene) : nullptr;
  if (spindle)
    add("spindle", "the log's core turns as a rigid body, and keeps pace with the tool",
        [spindle](State& state) { spindle->turn(state); });
  add("markers", "crack-face markers follow the projected velocity of their side", move_markers);
  // A sharp tip runs inside the opened crack, clear of the lower face by a fiftieth of the depth.
  const double lift = scene.edge_contact ? 0.0 : 0.02 * scene.cut.depth;
  if (scene.grips)
    add("grips", "the grips' anchors move apart and pull the arms", [&scene, stiffness](State& state) {
      move_grips(state, scene);
      pull_arms(state, scene, stiffness);
    });
  else
    add("tool", "the tool advances and its tip follows the lower face", [&scene, lift](State& state) {
      move_tool(state, scene);
      follow_face(state, scene.cut.depth, lift, scene.edge_contact.has_value());
    });
  add("stress", "velocity gradients, stresses of the material (stress first), internal forces",
      [&scene](State& state) { update_stress(state, scene.material); });
  if (scene.thermal && scene.thermal->conductivity > 0.0)
    add("conduct", "heat of plastic work flows down the temperature's gradient", HeatConduction(scene));
  if (scene.bridging && scene.bridging->cut)
    add("cut bonds", "the tool's edge takes away the bonds that it has passed",
        [&scene](State& state) { cut_bonds(state, scene); });
  add("cohesion", "cohesive tractions between the faces; pairs break at the mixed-mode criterion",
      [&scene](State& state) { pull_faces(state, scene.cohesive); });
  add("closing", "the upper face cannot enter the lower one",
      [stiffness](State& state) { close_faces(state, stiffness); });
  if (scene.face_friction)
    add("rubbing", "closed crack faces without bonds rub on each other, up to the slip limit",
        [mu = scene.face_friction->coefficient, stiffness](State& state) { rub_faces(state, mu, stiffness); });
  const bool warms = scene.thermal && scene.thermal->friction_share > 0.0;
  for (const Contact& contact : contacts(scene))
    add(contact.name,
        contact.does + (contact.friction > 0.0 ? " and rubs, up to the slip limit and the yield cap" : ""),
        [&scene, contact, options = PressOptions{stiffness, cap},
         act = contact.friction > 0.0 && warms ? press_and_warm : press](State& state) {
          act(state, contact, scene, options);
        });
  if (warms)
    add("warm", "a share of the work of friction on the tool warms what rubs on it",
        [&scene](State& state) { warm_by_friction(state, scene); });
  add("spread", "marker forces go to the nodes they were interpolated from", spread_marker_forces);
  if (spindle)
    add("drive", "forces of the spindle on the core, and their work",
        [spindle](State& state) { spindle->drive(state); });
  add("accelerate", "new grid velocities under the fixed boundary", accelerate);
  if (scene.xpic_damping) {
    add("filter", "what XPIC blends towards",
        [&scene](State& state) { filter_velocity(state, scene.xpic_damping->order); });
    add("advance", "particles move (FLIP with a share of XPIC, booked as damping) and pass on their momentum",
        [rate = each_step(scene.xpic_damping->rate)](State& state) { advance_filtered(state, rate); });
  } else if (scene.pic_damping && scene.pic_damping->rate > 0.0) {
    add("advance", "particles move (FLIP with a share of PIC, booked as damping) and pass on their momentum",
        [rate = each_step(scene.pic_damping->rate)](State& state) { advance(state, rate); });
  } else {
    add("advance", "particles move (FLIP) and pass on their momentum", [](State& state) { advance(state, 0.0); });
  }
  if (scene.thermostat)
    add("thermostat", "feedback damping holds the kinetic energy down", KineticThermostat(*scene.thermostat, scene));
  return stages;
}

}  // namespace kerf::forward
