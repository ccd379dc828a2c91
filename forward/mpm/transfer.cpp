#include "forward/mpm/transfer.hpp"

#include <algorithm>
#include <memory>

#include "forward/mpm/stencil.hpp"

namespace kerf::forward {
namespace {

/// Batches that take each part of a pass one right after the other. What a batch does is a long chain of operations
/// that wait for one another; the processor works on several chains at once only where they stand close together.
constexpr std::size_t together = 4;

/// Asks for what a pass reads of the particles a few microseconds before it does: the processor foresees so many arrays
/// only within a page.
template <class... Arrays>
[[gnu::always_inline]] inline void prefetch(std::size_t first, const Arrays&... arrays) {
  constexpr std::size_t ahead = 16 * lane_count;
  (__builtin_prefetch(arrays.data() + first + ahead), ...);
}

void clear(Array& values) {
  std::fill(values.begin(), values.end(), 0.0);
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
    // Everything, because the spans may have left some nodes.
    for (auto* values : {&field.mass, &field.momentum, &field.velocity, &field.change, &field.force}) clear(*values);
  }
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; i += lane_count)
      Stencil(state.grid, load(&p.x[i]), load(&p.y[i]))
          .add_momentum(state.grid.side[side].momentum.data(), state.grid.side[side].mass.data(),
                        load(&p.volume[i]) * state.density, load(&p.velocity_x[i]), load(&p.velocity_y[i]));
}

namespace {

/// 1/m of eight nodes, zero where they are empty.
Lanes inverse_mass(const VelocityField& field, std::size_t node, double smallest) {
  const Lanes mass = load(&field.mass[node]);
  return mass > smallest ? 1.0 / mass : Lanes{};
}
/// A scalar of eight nodes as the factor of their interleaved vectors: the first four nodes, the last four.
std::array<Lanes, 2> both_components(Lanes v) {
  return {__builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3), __builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7)};
}

}  // namespace

void project_velocity(State& state) {
  for (VelocityField& field : state.grid.side) {
    state.grid.each_batch(field, [&](std::size_t node) {
      const auto inverse = both_components(inverse_mass(field, node, state.smallest_mass));
      for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t k = 2 * node + half * lane_count;
        store(&field.velocity[k], load(&field.momentum[k]) * inverse[half]);
        store(&field.force[k], Lanes{});
      }
    });
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
    const std::size_t end = p.begin[side + 1];
    for (std::size_t begin = p.begin[side]; begin < end; begin += together * lane_count) {
      const std::size_t batches = std::min(together, (end - begin) / lane_count);
      std::array<Stencil, together> stencils;
      std::array<laws::StrainIncrement, together> strains;
      for (std::size_t b = 0; b < batches; ++b) {
        const std::size_t first = begin + b * lane_count;
        prefetch(first, p.x, p.y, p.stress_xx, p.stress_yy, p.stress_zz, p.stress_xy, p.plastic_strain, p.volume);
        if constexpr (Law::has_axes) prefetch(first, p.axis_x, p.axis_y);
        const Stencil& stencil = *std::construct_at(&stencils[b], grid, load(&p.x[first]), load(&p.y[first]));
        if (b == 0) {
          stencil.prefetch<2>(field.velocity.data());
          stencil.prefetch<2>(field.force.data());
        }
        const auto [xx, xy, yx, yy] = stencil.gradient(field.velocity.data());
        strains[b] = {.xx = strain_x * xx, .xy = strain_y * xy, .yx = strain_x * yx, .yy = strain_y * yy};
      }
      for (std::size_t b = 0; b < batches; ++b) {
        laws::MaterialPoints points = p.material_points<Law::has_axes>(begin + b * lane_count);
        mapped &= material.update(strains[b], points);
        p.set<Law::has_axes>(begin + b * lane_count, points);
      }
      for (std::size_t b = 0; b < batches; ++b) {
        const std::size_t first = begin + b * lane_count;
        const Stencil& stencil = stencils[b];
        const Lanes volume = load(&p.volume[first]), stress_xy = load(&p.stress_xy[first]);
        const Lanes along = -grid.inverse_cell_x * volume, across = -grid.inverse_cell_y * volume;
        const Lanes along_x = along * load(&p.stress_xx[first]), along_y = along * stress_xy;
        const Lanes across_x = across * stress_xy, across_y = across * load(&p.stress_yy[first]);
        std::array<Lanes, 6> by_weight, by_slope;
        for (std::size_t i = 0; i < 3; ++i) {
          by_weight[2 * i] = stencil.slope_x[i] * along_x;
          by_weight[2 * i + 1] = stencil.slope_x[i] * along_y;
          by_slope[2 * i] = stencil.weight_x[i] * across_x;
          by_slope[2 * i + 1] = stencil.weight_x[i] * across_y;
        }
        stencil.add(field.force.data(), by_weight, by_slope);
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
  for (VelocityField& field : state.grid.side) {
    // A node that is held loses what momentum it was given.
    hold_boundary(state.grid, [&](std::size_t node, bool both) {
      const double mass = field.mass[node];
      for (std::size_t k = 2 * node; k < 2 * node + (both ? 2 : 1); ++k) {
        field.velocity[k] = mass > state.smallest_mass ? field.momentum[k] / mass : 0.0;
        field.force[k] = -field.momentum[k] / state.step;
      }
    });
    const Lanes none{};
    state.grid.each_batch(field, [&](std::size_t node) {
      const auto impulse = both_components(state.step * inverse_mass(field, node, state.smallest_mass));
      for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t k = 2 * node + half * lane_count;
        store(&field.change[k], load(&field.force[k]) * impulse[half]);
        store(&field.momentum[k], none);
      }
      store(&field.mass[node], none);
    });
  }
}

namespace {

enum class Blend { none, pic, xpic };

template <Blend blend>
void advance_all(State& state, double rate) {
  Particles& p = state.particles;
  const Grid& grid = state.grid;
  const double dt = state.step;
  Lanes lost{}, outside{};
  for (std::size_t side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[side];
    const std::size_t end = p.begin[side + 1];
    for (std::size_t begin = p.begin[side]; begin < end; begin += together * lane_count) {
      const std::size_t batches = std::min(together, (end - begin) / lane_count);
      for (std::size_t b = 0; b < batches; ++b) {
        const std::size_t first = begin + b * lane_count;
        prefetch(first, p.x, p.y, p.velocity_x, p.velocity_y, p.volume);
        const Lanes x = load(&p.x[first]), y = load(&p.y[first]), mass = load(&p.volume[first]) * state.density;
        const Stencil stencil(grid, x, y);
        if (b == 0) {
          stencil.prefetch<2>(field.velocity.data());
          stencil.prefetch<2>(field.change.data());
          stencil.prefetch<2>(field.momentum.data());
          stencil.prefetch<1>(field.mass.data());
        }
        const auto [old_x, old_y] = stencil.sum(field.velocity.data());
        const auto [change_x, change_y] = stencil.sum(field.change.data());
        const Lanes move_x = old_x + change_x, move_y = old_y + change_y;
        Lanes vx = load(&p.velocity_x[first]) + change_x, vy = load(&p.velocity_y[first]) + change_y;
        if constexpr (blend != Blend::none) {
          Lanes target_x = move_x, target_y = move_y;
          if constexpr (blend == Blend::xpic) {
            const auto filtered = stencil.sum(field.filtered.data());
            target_x = filtered[0];
            target_y = filtered[1];
          }
          const Lanes flip_x = vx, flip_y = vy;
          vx += rate * (target_x - vx);
          vy += rate * (target_y - vy);
          lost += 0.5 * mass * (flip_x * flip_x + flip_y * flip_y - vx * vx - vy * vy);
        }
        store(&p.velocity_x[first], vx);
        store(&p.velocity_y[first], vy);
        store(&p.x[first], x + dt * move_x);
        store(&p.y[first], y + dt * move_y);
      }
      for (std::size_t b = 0; b < batches; ++b) {
        const std::size_t first = begin + b * lane_count;
        const Stencil next(grid, load(&p.x[first]), load(&p.y[first]));
        outside = next.outside(outside);
        next.add_momentum(field.momentum.data(), field.mass.data(), load(&p.volume[first]) * state.density,
                          load(&p.velocity_x[first]), load(&p.velocity_y[first]));
      }
    }
  }
  if (sum(outside) > 0.0) state.breakdown = "a particle left the grid or its position is not a number";
  state.work.damping += sum(lost);
}

}  // namespace

void advance(State& state, double pic) {
  pic > 0.0 ? advance_all<Blend::pic>(state, pic) : advance_all<Blend::none>(state, 0.0);
}

void advance_filtered(State& state, double rate) {
  advance_all<Blend::xpic>(state, rate);
}

}  // namespace kerf::forward
