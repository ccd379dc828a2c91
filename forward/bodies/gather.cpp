#include "forward/bodies/gather.hpp"

#include <algorithm>

#include "forward/bodies/batch.hpp"
#include "forward/bodies/walls.hpp"
#include "forward/mpm/stencil.hpp"

namespace kerf::forward::bodies {
namespace {

/// What a point gives to the nodes when its velocity has a gradient.
template <class Shape>
void add_affine_momentum(const Grid& grid, StencilOf<Shape> stencil, const Points& p, std::size_t first, Lanes mass,
                         VelocityField& field) {
  stencil.take_moments();
  const Lanes vx = load(&p.velocity_x[first]), vy = load(&p.velocity_y[first]);
  const Points::Affine& C = p.affine;
  const Lanes along = mass * grid.cell_x, up = mass * grid.cell_y;
  std::array<Lanes, 6> by_weight, by_moment;
  for (std::size_t i = 0; i < 3; ++i) {
    by_weight[2 * i] = stencil.weight_x[i] * mass * vx + stencil.slope_x[i] * along * load(&C.xx[first]);
    by_weight[2 * i + 1] = stencil.weight_x[i] * mass * vy + stencil.slope_x[i] * along * load(&C.yx[first]);
    by_moment[2 * i] = stencil.weight_x[i] * up * load(&C.xy[first]);
    by_moment[2 * i + 1] = stencil.weight_x[i] * up * load(&C.yy[first]);
  }
  stencil.add(field.momentum.data(), by_weight, by_moment);
  stencil.add_mass(field.mass.data(), mass);
}

/// Nodal velocities under the walls, of points' velocities that `velocity_of(stencil, first point)` tells. Are all
/// points where the grid is?
template <bool is_affine, class Shape, class VelocityOf>
bool gather(State& state, const Scene& scene, const Shape& shape, Body& body, const VelocityOf& velocity_of) {
  VelocityField& field = body.field;
  for (auto* values : {&field.mass, &field.momentum, &field.velocity}) std::fill(values->begin(), values->end(), 0.0);
  const Points& p = body.points;
  const Array &x = p.kernel_x(frame_of(scene)), &y = p.kernel_y(frame_of(scene));
  const double density = density_of(body);
  Lanes outside{};
  for (std::size_t i = 0; i < p.size(); i += lane_count) {
    const StencilOf<Shape> stencil(state.grid, load(&x[i]), load(&y[i]), shape);
    outside = stencil.outside(outside);
    const Lanes mass = density * load(&p.volume[i]);
    if constexpr (is_affine) {
      add_affine_momentum(state.grid, stencil, p, i, mass, field);
    } else {
      const std::array<Lanes, 2> velocity = velocity_of(stencil, i);
      stencil.add_momentum(field.momentum.data(), field.mass.data(), mass, velocity[0], velocity[1]);
    }
  }
  fold_momentum(state, scene, field);
  for (std::size_t node = 0; node < state.grid.nodes(); ++node)
    for (std::size_t k = 2 * node; k < 2 * node + 2; ++k)
      field.velocity[k] = field.mass[node] > 0.0 ? field.momentum[k] / field.mass[node] : 0.0;
  return !any(outside > 0.0);
}

}  // namespace

void gather_momentum(State& state, const Scene& scene) {
  const auto gather_with = [&](const auto& shape, const auto& transfer) {
    for (Body& body : state.bodies) {
      for (auto* values : {&body.field.change, &body.field.force}) std::fill(values->begin(), values->end(), 0.0);
      const Points& p = body.points;
      const bool sound = gather<std::decay_t<decltype(transfer)>::is_affine>(
          state, scene, shape, body, [&](const auto&, std::size_t i) {
            return std::array<Lanes, 2>{load(&p.velocity_x[i]), load(&p.velocity_y[i])};
          });
      if (!sound && state.breakdown.empty())
        state.breakdown = "a body left the box, or its velocity is no longer a number";
    }
  };
  std::visit(gather_with, scene.numerics.shape, scene.numerics.transfer);
}

void filter_velocity(State& state, const Scene& scene, const std::function<void(State&)>& share) {
  const int order = std::get<Xpic>(scene.numerics.transfer).order;
  std::vector<Array> velocity, term;
  for (Body& body : state.bodies) {
    mirror_velocity(state, scene, body.field);
    mirror_change(state, scene, body.field);
    velocity.push_back(body.field.velocity);
    term.push_back(body.field.velocity);
    for (std::size_t k = 0; k < term.back().size(); ++k) term.back()[k] += body.field.change[k];
    body.field.filtered = term.back();
  }
  // Differences of velocities know walls that stand still.
  const double speed = state.piston.speed;
  for (int l = 1; l < order; ++l) {
    std::visit(
        [&](const auto& shape) {
          for (std::size_t b = 0; b < state.bodies.size(); ++b)
            gather<false>(state, scene, shape, state.bodies[b],
                          [&](const auto& stencil, std::size_t) { return stencil.sum(term[b].data()); });
        },
        scene.numerics.shape);
    if (share) share(state);
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
      VelocityField& field = state.bodies[b].field;
      mirror_velocity(state, scene, field);
      for (std::size_t k = 0; k < term[b].size(); ++k) {
        term[b][k] -= field.velocity[k];
        field.filtered[k] += term[b][k];
      }
    }
    state.piston.speed = 0.0;
  }
  state.piston.speed = speed;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) state.bodies[b].field.velocity.swap(velocity[b]);
}

}  // namespace kerf::forward::bodies
