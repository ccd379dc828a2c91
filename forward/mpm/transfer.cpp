#include "forward/mpm/transfer.hpp"

#include <algorithm>

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {
namespace {

void clear(std::vector<double>& values) {
  std::fill(values.begin(), values.end(), 0.0);
}

/// Adds one particle's mass and momentum to the nodes around it.
void add_momentum(VelocityField& field, const Grid& grid, const Spline& sx, const Spline& sy, double mass,
                  double velocity_x, double velocity_y) {
  const Lanes weights = sx.row_weights();
  const Lanes momentum = mass * weights * pairs(velocity_x, velocity_y);
  const Quad masses = mass * Quad{weights[0], weights[2], weights[4], 0.0};
  for (int row = 0; row < 3; ++row) {
    const std::size_t node = grid.node(sx.base, sy.base + row);
    const double w = sy.weight(row);
    add_row(&field.mass[node], w * masses);
    double* to = &field.momentum[2 * node];
    store(to, load(to) + w * momentum);
  }
}

/// Bottom row and everything below it does not move; the far end of the window holds its horizontal position, and the
/// vertical one where it is clamped. `hold` is told whether both components are held.
template <class Hold>
void hold_boundary(const Grid& grid, Hold&& hold) {
  constexpr int fixed_rows = 2, fixed_columns = 4;
  for (int j = 0; j < fixed_rows; ++j)
    for (int i = 0; i < grid.columns; ++i) hold(grid.node(i, j), true);
  for (int j = 0; j < grid.rows; ++j)
    for (int i = grid.columns - fixed_columns; i < grid.columns; ++i) hold(grid.node(i, j), grid.clamps_end);
}

}  // namespace

void gather_momentum(State& state) {
  const Particles& p = state.particles;
  for (int side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[static_cast<std::size_t>(side)];
    clear(field.mass);
    clear(field.momentum);
  }
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; ++i)
      add_momentum(state.grid.side[side], state.grid, Spline(state.grid.column_of(p.x[i])),
                   Spline(state.grid.row_of(p.y[i])), p.volume[i] * state.density, p.velocity_x[i], p.velocity_y[i]);
}

void project_velocity(State& state) {
  for (VelocityField& field : state.grid.side) {
    clear(field.force);
    const std::size_t count = state.grid.nodes();
    for (std::size_t node = 0; node < count; ++node) {
      const double inverse = field.mass[node] > state.smallest_mass ? 1.0 / field.mass[node] : 0.0;
      field.velocity[2 * node] = field.momentum[2 * node] * inverse;
      field.velocity[2 * node + 1] = field.momentum[2 * node + 1] * inverse;
    }
    hold_boundary(state.grid, [&](std::size_t node, bool both) {
      field.velocity[2 * node] = 0.0;
      if (both) field.velocity[2 * node + 1] = 0.0;
    });
  }
}

namespace {

template <class Law>
void stress_particles(State& state, const Law& material) {
  Particles& p = state.particles;
  const Grid& grid = state.grid;
  const double strain_x = state.step * grid.inverse_cell_x, strain_y = state.step * grid.inverse_cell_y;
  bool mapped = true;
  for (std::size_t side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[side];
    for (std::size_t first = p.begin[side]; first < p.begin[side + 1]; first += lane_count) {
      double xx[lane_count], xy[lane_count], yx[lane_count], yy[lane_count];
      int column[lane_count], row[lane_count];
      double fx[lane_count], fy[lane_count];
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        const Spline sx(grid.column_of(p.x[first + lane])), sy(grid.row_of(p.y[first + lane]));
        Lanes value{}, rise{};  // sum over rows, weighted by w_y and by its slope
        for (int j = 0; j < 3; ++j) {
          const Lanes v = load(&field.velocity[2 * grid.node(sx.base, sy.base + j)]);
          value += sy.weight(j) * v;
          rise += sy.slope(j) * v;
        }
        const Lanes along_x = sx.row_slopes() * value, along_y = sx.row_weights() * rise;
        xx[lane] = strain_x * sum_x(along_x);
        yx[lane] = strain_x * sum_y(along_x);
        xy[lane] = strain_y * sum_x(along_y);
        yy[lane] = strain_y * sum_y(along_y);
        column[lane] = sx.base;
        row[lane] = sy.base;
        fx[lane] = sx.f;
        fy[lane] = sy.f;
      }
      laws::MaterialPoints points{&p.stress_xx[first],
                                  &p.stress_yy[first],
                                  &p.stress_zz[first],
                                  &p.stress_xy[first],
                                  &p.plastic_strain[first],
                                  nullptr,
                                  nullptr};
      if constexpr (Law::has_axes) {
        points.axis_x = &p.axis_x[first];
        points.axis_y = &p.axis_y[first];
      }
      mapped &= material.update(lane_count, {xx, xy, yx, yy}, points);
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        const std::size_t i = first + lane;
        const Spline sx(column[lane], fx[lane]), sy(row[lane], fy[lane]);
        const double along = -p.volume[i] * grid.inverse_cell_x, across = -p.volume[i] * grid.inverse_cell_y;
        const Lanes by_slope = sx.row_slopes() * pairs(along * p.stress_xx[i], along * p.stress_xy[i]);
        const Lanes by_weight = sx.row_weights() * pairs(across * p.stress_xy[i], across * p.stress_yy[i]);
        for (int j = 0; j < 3; ++j) {
          double* to = &field.force[2 * grid.node(sx.base, sy.base + j)];
          store(to, load(to) + sy.weight(j) * by_slope + sy.slope(j) * by_weight);
        }
      }
    }
  }
  if (!mapped && state.breakdown.empty()) state.breakdown = "the return mapping of the material found no solution";
}

}  // namespace

void update_stress(State& state, const laws::Material& material) {
  std::visit([&](const auto& law) { stress_particles(state, law); }, material);
}

void accelerate(State& state) {
  const double dt = state.step;
  for (VelocityField& field : state.grid.side) {
    const std::size_t count = state.grid.nodes();
    for (std::size_t node = 0; node < count; ++node) {
      const double impulse = field.mass[node] > state.smallest_mass ? dt / field.mass[node] : 0.0;
      for (std::size_t k = 2 * node; k < 2 * node + 2; ++k) {
        field.change[k] = impulse * field.force[k];
        field.next_velocity[k] = field.velocity[k] + field.change[k];
      }
    }
    hold_boundary(state.grid, [&](std::size_t node, bool both) {
      const double inverse = field.mass[node] > state.smallest_mass ? 1.0 / field.mass[node] : 0.0;
      for (std::size_t k = 2 * node; k < 2 * node + (both ? 2 : 1); ++k) {
        field.next_velocity[k] = 0.0;
        field.change[k] = -field.momentum[k] * inverse;
      }
    });
    clear(field.mass);
    clear(field.momentum);
  }
}

namespace {

enum class Blend { none, pic, xpic };

template <Blend blend>
void advance_all(State& state, double rate) {
  Particles& p = state.particles;
  const Grid& grid = state.grid;
  const double dt = state.step;
  double lost = 0.0;
  for (std::size_t side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[side];
    for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; ++i) {
      const Spline sx(grid.column_of(p.x[i])), sy(grid.row_of(p.y[i]));
      Lanes next{}, change{}, target{};
      for (int j = 0; j < 3; ++j) {
        const std::size_t node = 2 * grid.node(sx.base, sy.base + j);
        next += sy.weight(j) * load(&field.next_velocity[node]);
        change += sy.weight(j) * load(&field.change[node]);
        if constexpr (blend == Blend::xpic) target += sy.weight(j) * load(&field.filtered[node]);
      }
      const Lanes weights = sx.row_weights();
      next *= weights;
      change *= weights;
      const double move_x = sum_x(next), move_y = sum_y(next);
      const double mass = p.volume[i] * state.density;
      double vx = p.velocity_x[i] + sum_x(change), vy = p.velocity_y[i] + sum_y(change);
      if constexpr (blend != Blend::none) {
        double target_x = move_x, target_y = move_y;
        if constexpr (blend == Blend::xpic) {
          target *= weights;
          target_x = sum_x(target);
          target_y = sum_y(target);
        }
        const double flip_x = vx, flip_y = vy;
        vx += rate * (target_x - vx);
        vy += rate * (target_y - vy);
        lost += 0.5 * mass * (flip_x * flip_x + flip_y * flip_y - vx * vx - vy * vy);
      }
      p.velocity_x[i] = vx;
      p.velocity_y[i] = vy;
      p.x[i] += dt * move_x;
      p.y[i] += dt * move_y;
      const double column = grid.column_of(p.x[i]), row = grid.row_of(p.y[i]);
      if (!grid.holds(column, row)) [[unlikely]] {
        state.breakdown = "a particle left the grid or its position is not a number";
        return;
      }
      add_momentum(field, grid, Spline(column), Spline(row), mass, vx, vy);
    }
  }
  state.work.damping += lost;
}

}  // namespace

void advance(State& state, double pic) {
  pic > 0.0 ? advance_all<Blend::pic>(state, pic) : advance_all<Blend::none>(state, 0.0);
}

void advance_filtered(State& state, double rate) {
  advance_all<Blend::xpic>(state, rate);
}

}  // namespace kerf::forward
