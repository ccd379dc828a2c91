#include "forward/bodies/advance.hpp"

#include <cmath>

#include "forward/bodies/batch.hpp"
#include "forward/bodies/walls.hpp"
#include "forward/mpm/stencil.hpp"

namespace kerf::forward::bodies {
namespace {

/// C = D^-1 sum w_i v_i (x_i - x_p)^T, row by row, of a stencil that holds moments.
template <class Shape>
std::array<Lanes, 4> affine_part(const Grid& grid, const StencilOf<Shape>& moments, const std::array<Lanes, 2>& spread,
                                 const Array& nodal) {
  const auto [value, rise] = moments.value_and_rise(nodal.data());
  std::array<Lanes, 4> C{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      C[2 * k] += moments.slope_x[i] * value[2 * i + k];
      C[2 * k + 1] += moments.weight_x[i] * rise[2 * i + k];
    }
  // A linear shape function knows no gradient on a node.
  const auto over = [](Lanes a, Lanes b) { return b > 1e-9 ? a / (b > 1e-9 ? b : all_lanes(1.0)) : Lanes{}; };
  for (std::size_t k = 0; k < 2; ++k) {
    C[2 * k] = over(C[2 * k], spread[0]) * grid.inverse_cell_x;
    C[2 * k + 1] = over(C[2 * k + 1], spread[1]) * grid.inverse_cell_y;
  }
  return C;
}

/// Gives the points their gradients; returns the work per mass of what changes them beside the forces, see
/// `advance`.
template <class Shape>
Lanes take_affine(const Grid& grid, StencilOf<Shape> stencil, const VelocityField& field, Points::Affine& to,
                  std::size_t first) {
  const std::array<Lanes, 2> spread = stencil.take_moments();
  const std::array<Lanes, 4> old = affine_part(grid, stencil, spread, field.velocity);
  const std::array<Lanes, 4> change = affine_part(grid, stencil, spread, field.change);
  const std::array<Array*, 4> values{&to.xx, &to.xy, &to.yx, &to.yy};
  std::array<Lanes, 4> taken, sum;
  for (std::size_t k = 0; k < 4; ++k) {
    const Lanes before = load(&(*values[k])[first]), now = old[k] + change[k];
    taken[k] = before + change[k] - now;
    sum[k] = before + now;
    store(&(*values[k])[first], now);
  }
  const Lanes spread_x = grid.cell_x * grid.cell_x * spread[0], spread_y = grid.cell_y * grid.cell_y * spread[1];
  store(&to.spread_x[first], spread_x);
  store(&to.spread_y[first], spread_y);
  return affine_energy(taken, sum, spread_x, spread_y);
}

template <class Transfer, class Shape>
void move_points(State& state, const Scene& scene, Body& body, const Shape& shape) {
  constexpr bool is_flip = std::is_same_v<Transfer, Flip>;
  Points& p = body.points;
  const Frame frame = frame_of(scene);
  const Array &kernel_x = p.kernel_x(frame), &kernel_y = p.kernel_y(frame);
  const double dt = state.step;
  const double rate = scene.pic_damping ? 1.0 - std::exp(-scene.pic_damping->rate * scene.courant_number) : 0.0;
  const double density = density_of(body);
  Lanes lost{};
  for (std::size_t first = 0; first < p.size(); first += lane_count) {
    const Lanes x = load(&p.x[first]), y = load(&p.y[first]);
    const StencilOf<Shape> stencil(state.grid, load(&kernel_x[first]), load(&kernel_y[first]), shape);
    const auto [old_x, old_y] = stencil.sum(body.field.velocity.data());
    const auto [change_x, change_y] = stencil.sum(body.field.change.data());
    const Lanes move_x = old_x + change_x, move_y = old_y + change_y;
    const Lanes before_x = load(&p.velocity_x[first]), before_y = load(&p.velocity_y[first]);
    Lanes vx = before_x + change_x, vy = before_y + change_y;
    if (!is_flip || rate > 0.0) {
      const Lanes flip_x = vx, flip_y = vy, mass = density * load(&p.volume[first]);
      if constexpr (is_flip) {
        vx += rate * (move_x - vx);
        vy += rate * (move_y - vy);
      } else if constexpr (Transfer::filters) {
        const auto [filtered_x, filtered_y] = stencil.sum(body.field.filtered.data());
        vx = filtered_x;
        vy = filtered_y;
      } else {
        vx = move_x;
        vy = move_y;
      }
      lost += 0.5 * mass * ((flip_x - vx) * (before_x + vx) + (flip_y - vy) * (before_y + vy));
      if constexpr (Transfer::is_affine) lost += mass * take_affine(state.grid, stencil, body.field, p.affine, first);
    }
    store(&p.velocity_x[first], vx);
    store(&p.velocity_y[first], vy);
    store(&p.x[first], x + dt * move_x);
    store(&p.y[first], y + dt * move_y);
  }
  state.damping += sum(lost);
}

}  // namespace

void advance(State& state, const Scene& scene) {
  for (Body& body : state.bodies) {
    mirror_change(state, scene, body.field);
    std::visit([&](const auto& shape,
                   const auto& transfer) { move_points<std::decay_t<decltype(transfer)>>(state, scene, body, shape); },
               scene.numerics.shape, scene.numerics.transfer);
  }
}

}  // namespace kerf::forward::bodies
