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

void follow_face(State& state, double depth, double lift) {
  const Face& face = state.crack.face[below];
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < state.crack.size(); ++k) {
    const double ahead = face.x[k] - state.tool.x;
    if (face.inverse_mass[k] == 0.0 || ahead < 0.1 * depth || ahead > 0.3 * depth) continue;
    sum += face.y[k];
    count += 1.0;
  }
  const double height = count > 0.0 ? sum / count + lift : state.tool.y;
  state.tool.vertical_speed = state.tool.speed * (height - state.tool.y) / (0.3 * depth);
  state.tool.y += state.step * state.tool.vertical_speed;
}

void push_face(State& state, Side side, std::size_t k, double x, double y) {
  Face& face = state.crack.face[side];
  face.force_x[k] += x;
  face.force_y[k] += y;
  state.force.on_work_x += x;
  state.force.on_work_y += y;
  state.work.tool += (x * state.tool.speed + y * state.tool.vertical_speed) * state.step;
}

void block_underside(State& state, double clearance, double stiffness) {
  const Crack& crack = state.crack;
  const Face& face = crack.face[below];
  const double normal_x = -std::sin(clearance), normal_y = -std::cos(clearance);  // from the tool into the base
  const double length = crack.spacing;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (face.inverse_mass[k] == 0.0 || face.x[k] > state.tool.x) continue;
    const double distance = (face.x[k] - state.tool.x) * normal_x + (face.y[k] - state.tool.y) * normal_y;
    if (distance >= 0.0) continue;
    const double pressure = -stiffness * distance;
    push_face(state, below, k, pressure * normal_x * length, pressure * normal_y * length);
    state.contact_energy += 0.5 * pressure * -distance * length;
    state.force.bottom_normal += pressure * length;
    state.force.penetration = std::max(state.force.penetration, -distance);
  }
}

namespace {

/// Pressure around each marker, averaged over a cell to either side. What a single marker carries is not unique
/// (several share the same nodes); what a cell carries is.
std::vector<double> cell_mean(const std::vector<double>& pressure, std::size_t reach) {
  const std::size_t n = pressure.size();
  std::vector<double> sum(n + 1, 0.0), mean(n);
  for (std::size_t k = 0; k < n; ++k) sum[k + 1] = sum[k] + pressure[k];
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t from = k > reach ? k - reach : 0, to = std::min(n, k + reach + 1);
    mean[k] = (sum[to] - sum[from]) / static_cast<double>(to - from);
  }
  return mean;
}

}  // namespace

void press_rake_face(State& state, double rake, double stiffness) {
  Crack& crack = state.crack;
  const Face& face = crack.face[above];
  const double normal_x = std::cos(rake), normal_y = std::sin(rake);  // from the tool into the chip
  const double length = crack.spacing;
  crack.rake_pressure.assign(crack.size(), 0.0);
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (face.inverse_mass[k] == 0.0) continue;
    const double distance = (face.x[k] - state.tool.x) * normal_x + (face.y[k] - state.tool.y) * normal_y;
    if (distance >= 0.0) continue;
    const double pressure = -stiffness * distance;
    crack.rake_pressure[k] = pressure;
    push_face(state, above, k, pressure * length * normal_x, pressure * length * normal_y);
    state.contact_energy += 0.5 * pressure * -distance * length;
    state.force.rake_normal += pressure * length;
    state.force.penetration = std::max(state.force.penetration, -distance);
  }
}

void rub_rake_face(State& state, double rake, const Friction& friction, double shear_yield, double stiffness) {
  Crack& crack = state.crack;
  const Face& face = crack.face[above];
  const double along_x = -std::sin(rake), along_y = std::cos(rake);  // up the face
  const double length = crack.spacing;
  const auto reach = static_cast<std::size_t>(std::lround(state.grid.cell / length));
  const std::vector<double> mean = cell_mean(crack.rake_pressure, reach);
  for (std::size_t k = 0; k < crack.size(); ++k) {
    const double pressure = crack.rake_pressure[k];
    if (pressure == 0.0) {
      crack.rake_slip[k] = 0.0;
      continue;
    }
    const double ratio = std::min(friction.coefficient, friction.yield_cap * shear_yield / mean[k]);
    const double reach_of_spring = ratio * pressure / stiffness;
    const double sliding = state.step * ((face.velocity_x[k] - state.tool.speed) * along_x +
                                         (face.velocity_y[k] - state.tool.vertical_speed) * along_y);
    const double trial = crack.rake_slip[k] + sliding;
    crack.rake_slip[k] = std::clamp(trial, -reach_of_spring, reach_of_spring);
    const double shear = -stiffness * crack.rake_slip[k];  // on the chip, up the face
    push_face(state, above, k, shear * length * along_x, shear * length * along_y);
    state.work.friction -= shear * (trial - crack.rake_slip[k]) * length;
    state.contact_energy += 0.5 * stiffness * crack.rake_slip[k] * crack.rake_slip[k] * length;
    state.force.rake_tangential -= shear * length;
    state.force.slip_limit += ratio * pressure * length;
  }
}

}  // namespace kerf::forward
