#include "forward/bodies/step.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forward/bodies/accelerate.hpp"
#include "forward/bodies/advance.hpp"
#include "forward/bodies/batch.hpp"
#include "forward/bodies/conduction.hpp"
#include "forward/bodies/contact.hpp"
#include "forward/bodies/gather.hpp"
#include "forward/bodies/strain.hpp"

namespace kerf::forward::bodies {

std::vector<Stage> plan(const Scene& scene, Joint& joint) {
  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::string does, std::function<void(State&, const Stroke&)> apply) {
    stages.push_back({std::move(name), std::move(does), std::move(apply)});
  };
  const bool is_current = frame_of(scene) == Frame::current;
  const bool bonded = scene.bodies.size() > 1 && !scene.contact;
  const StressUpdate update = scene.numerics.stress_update;
  const auto add_projection = [&] {
    add("project",
        fmt::format("grid velocities p/m of every body under the walls, in the {} configuration",
                    is_current ? "current" : "reference"),
        [&scene](State& state, const Stroke&) { gather_momentum(state, scene); });
    if (scene.contact)
      add("meet", "where bodies touch, along which normal; strains see no surfaces that approach",
          [&scene](State& state, const Stroke&) { meet(state, scene); });
    else if (bonded)
      add("share", scene.interface ? "the interface slows what parts the bodies" : "bodies share one velocity",
          [&joint](State& state, const Stroke&) { joint.share_velocity(state); });
  };
  const std::string strains =
      scene.is_thermal() ? "deformation, heat of the stroke, temperature, stress" : "deformation, stress";
  const auto add_strain = [&](double share, bool with_forces) {
    add("strain", (share < 1.0 ? "for half a step: " : "") + strains + (with_forces ? ", internal forces" : ""),
        [&scene, share, with_forces](State& state, const Stroke& stroke) {
          strain(state, scene, stroke, share * state.step, with_forces);
        });
  };
  const double each_time = update == StressUpdate::average ? 0.5 : 1.0;

  add_projection();
  if (update == StressUpdate::first || update == StressUpdate::average)
    add_strain(each_time, true);
  else
    add("push", "internal forces", [&scene](State& state, const Stroke&) { push(state, scene); });
  if (scene.gravity)
    add("gravity", "weight of every body", [&scene](State& state, const Stroke&) { weigh(state, scene); });
  if (scene.conduction)
    add("conduct", "heat flows down the temperature's gradient and through walls that have a temperature",
        [conductor = Conductor(scene)](State& state, const Stroke&) mutable { conductor(state); });
  add("accelerate", "changes of the grid velocities under the walls, and the piston's force",
      [&scene](State& state, const Stroke&) { accelerate(state, scene); });
  if (scene.contact)
    add("touch",
        scene.contact->friction > 0.0 ? "normal impulses and Coulomb friction between bodies that touch"
                                      : "normal impulses between bodies that touch",
        [&scene](State& state, const Stroke&) { touch(state, scene); });
  if (friction_warms(scene))
    add("warm", "heat of friction warms the bodies that rub",
        [&scene](State& state, const Stroke&) { warm_by_friction(state, scene); });
  if (bonded)
    add("join", scene.interface ? "springs of the interface" : "bodies share one change of velocity",
        [&joint](State& state, const Stroke&) { joint.join(state); });
  if (update == StressUpdate::last)
    add("strain", strains + ", with the velocities at the end of the step",
        [&scene](State& state, const Stroke& stroke) { strain_last(state, scene, stroke); });
  if (const auto* xpic = std::get_if<Xpic>(&scene.numerics.transfer)) {
    std::function<void(State&)> share;
    if (bonded && !scene.interface) share = [&joint](State& state) { joint.share_velocity(state); };
    add("filter", fmt::format("what XPIC({}) takes from the nodes", xpic->order),
        [&scene, share](State& state, const Stroke&) { filter_velocity(state, scene, share); });
  }
  add("advance",
      fmt::format("points move ({}{})",
                  std::visit([](const auto& transfer) { return transfer.name; }, scene.numerics.transfer),
                  scene.pic_damping ? " with a share of PIC, booked as damping" : ""),
      [&scene](State& state, const Stroke&) { advance(state, scene); });
  if (update == StressUpdate::last_gathered || update == StressUpdate::average) {
    add_projection();
    add_strain(each_time, false);
  }
  if (!scene.rigids.empty())
    add("push", "rigid bodies move", [&scene](State& state, const Stroke&) { move_rigids(state, scene); });
  add("piston", "the piston moves and its work is booked", [](State& state, const Stroke&) {
    state.piston.work += state.piston.force * state.piston.speed * state.step;
    state.piston.position += state.piston.speed * state.step;
    state.time += state.step;
  });
  return stages;
}

double stable_step(const State& state, const Scene& scene) {
  double most = 0.0;  // transits of a cell per second
  for (const Body& body : state.bodies)
    each_batch(body, [&](const auto& law, const laws::BodyPoints& points, std::size_t first) {
      Lanes speed = law.wave_speed(points) + std::abs(state.piston.speed);
      Lanes along = all_lanes(state.grid.inverse_cell_x), across = all_lanes(state.grid.inverse_cell_y);
      if (frame_of(scene) == Frame::current) {
        const Lanes vx = load(&body.points.velocity_x[first]), vy = load(&body.points.velocity_y[first]);
        speed += sqrt(vx * vx + vy * vy);
      } else {
        const Gradient F = load_gradient(body.points, first);
        along /= sqrt(F.xx * F.xx + F.yx * F.yx);
        across /= sqrt(F.xy * F.xy + F.yy * F.yy);
      }
      const Lanes transits = speed * (along > across ? along : across);
      for (std::size_t i = 0; i < lane_count; ++i) most = std::max(most, transits[i]);
    });
  const double step = scene.courant_number / most;
  return scene.conduction ? std::min(step, longest_conduction_step(state, scene)) : step;
}

}  // namespace kerf::forward::bodies
