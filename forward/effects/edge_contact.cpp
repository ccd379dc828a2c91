#include "forward/effects/edge_contact.hpp"

#include <algorithm>
#include <cmath>

#include "forward/mpm/tool.hpp"

namespace kerf::forward {

void press_edge(State& state, const EdgeContact& edge, double clearance, double stiffness) {
  Crack& crack = state.crack;
  const Face& face = crack.face[below];
  const double radius = edge.edge_radius, length = crack.spacing;
  const double separation = std::acos(1.0 - edge.press_in / radius);
  const double centre_x = state.tool.x - radius * std::sin(separation);
  const double centre_y = state.tool.y - edge.press_in + radius;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (face.inverse_mass[k] == 0.0) continue;
    const double x = face.x[k] - centre_x, y = face.y[k] - centre_y;
    // Direction from the arc's centre, as an angle from straight down, ahead positive; beyond the ends: their tangents.
    const double angle = std::clamp(std::atan2(x, -y), -clearance, separation);
    const double normal_x = std::sin(angle), normal_y = -std::cos(angle);  // from the tool into the base
    const double distance = x * normal_x + y * normal_y - radius;
    if (distance >= 0.0) {
      crack.edge_slip[k] = 0.0;
      continue;
    }
    const double pressure = -stiffness * distance;
    const double along_x = -normal_y, along_y = normal_x;
    const double reach = edge.friction * pressure / stiffness;
    const double sliding = state.step * ((face.velocity_x[k] - state.tool.speed) * along_x +
                                         (face.velocity_y[k] - state.tool.vertical_speed) * along_y);
    const double trial = crack.edge_slip[k] + sliding;
    crack.edge_slip[k] = std::clamp(trial, -reach, reach);
    const double shear = -stiffness * crack.edge_slip[k];
    push_face(state, below, k, (pressure * normal_x + shear * along_x) * length,
              (pressure * normal_y + shear * along_y) * length);
    state.work.friction -= shear * (trial - crack.edge_slip[k]) * length;
    state.contact_energy += 0.5 * stiffness * (distance * distance + crack.edge_slip[k] * crack.edge_slip[k]) * length;
    state.force.bottom_normal += pressure * length;
    state.force.bottom_tangential += shear * length;
    state.force.penetration = std::max(state.force.penetration, -distance);
  }
}

}  // namespace kerf::forward
