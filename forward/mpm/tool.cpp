#include "forward/mpm/tool.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::forward {

void move_tool(State& state, const Cut& cut) {
  state.tool.speed = state.time < cut.ramp ? cut.speed * state.time / cut.ramp : cut.speed;
  state.tool.x += state.step * state.tool.speed;
  state.force = {};
  state.contact_energy = 0.0;
}

void press_rake_face(State& state, double rake, const Friction* friction, double shear_yield, double stiffness) {
  Crack& crack = state.crack;
  Face& face = crack.face[above];
  const double normal_x = std::cos(rake), normal_y = std::sin(rake);  // from the tool into the chip
  const double along_x = -normal_y, along_y = normal_x;               // up the face
  const double length = crack.spacing;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (face.inverse_mass[k] == 0.0) continue;
    const double distance = (face.x[k] - state.tool.x) * normal_x + (face.y[k] - state.tool.y) * normal_y;
    if (distance >= 0.0) {
      crack.rake_slip[k] = 0.0;
      continue;
    }
    const double pressure = -stiffness * distance;
    double shear = 0.0;  // traction on the chip, up the face
    if (friction) {
      const double sliding =
          ((face.velocity_x[k] - state.tool.speed) * along_x + face.velocity_y[k] * along_y) * state.step;
      const double limit = std::min(friction->coefficient * pressure, friction->yield_cap * shear_yield);
      const double trial = crack.rake_slip[k] + sliding;
      crack.rake_slip[k] = std::clamp(trial, -limit / stiffness, limit / stiffness);
      shear = -stiffness * crack.rake_slip[k];
      state.work.friction -= shear * (trial - crack.rake_slip[k]) * length;
      state.contact_energy += 0.5 * stiffness * crack.rake_slip[k] * crack.rake_slip[k] * length;
    }
    const double force_x = (pressure * normal_x + shear * along_x) * length;
    const double force_y = (pressure * normal_y + shear * along_y) * length;
    face.force_x[k] += force_x;
    face.force_y[k] += force_y;
    state.contact_energy += 0.5 * pressure * -distance * length;
    state.force.rake_normal += pressure * length;
    state.force.rake_tangential -= shear * length;
    state.force.on_work_x += force_x;
    state.force.on_work_y += force_y;
    state.force.penetration = std::max(state.force.penetration, -distance);
    state.work.tool += force_x * state.tool.speed * state.step;
  }
}

}  // namespace kerf::forward
