#include "forward/effects/spindle.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::forward {

Spindle::Spindle(const Scene& scene) : spiral_(scene.log->path), core_(scene.log->core) {}

void Spindle::turn(State& state) {
  const Grid& grid = state.grid;
  VelocityField& field = state.grid.side[below];
  const Roll roll = spiral_.roll(state.tool.x, state.tool.speed);
  state.spin = roll.spin;
  held_.clear();
  const auto node_range = [&](double from, double to, int count) {
    return std::pair{std::max(0, static_cast<int>(std::ceil(from))), std::min(count - 1, static_cast<int>(to))};
  };
  const auto [bottom, top] = node_range(grid.row_of(roll.y - core_), grid.row_of(roll.y + core_), grid.rows);
  for (int j = bottom; j <= top; ++j) {
    const double y = grid.origin_y + j * grid.cell_y;
    const double reach = std::sqrt(std::max(0.0, core_ * core_ - (y - roll.y) * (y - roll.y)));
    const auto [left, right] = node_range(grid.column_of(roll.x - reach), grid.column_of(roll.x + reach), grid.columns);
    for (int i = left; i <= right; ++i) {
      const std::size_t node = grid.node(i, j);
      if (field.mass[node] <= state.smallest_mass) continue;
      const double x = grid.origin_x + i * grid.cell_x;
      held_.push_back({node, roll.velocity_x(y), roll.velocity_y(x)});
      field.velocity[2 * node] = held_.back().velocity_x;
      field.velocity[2 * node + 1] = held_.back().velocity_y;
    }
  }
}

void Spindle::drive(State& state) const {
  VelocityField& field = state.grid.side[below];
  for (const Held& at : held_) {
    const double mass = field.mass[at.node];
    const auto lead = [&](std::size_t k, double velocity) {
      const double force = (mass * velocity - field.momentum[k]) / state.step;
      state.work.tool += (force - field.force[k]) * velocity * state.step;
      field.force[k] = force;
      field.velocity[k] = field.momentum[k] / mass;
    };
    lead(2 * at.node, at.velocity_x);
    lead(2 * at.node + 1, at.velocity_y);
  }
}

}  // namespace kerf::forward
