#include "forward/bodies/accelerate.hpp"

#include "forward/bodies/batch.hpp"
#include "forward/bodies/walls.hpp"
#include "forward/mpm/stencil.hpp"

namespace kerf::forward::bodies {
namespace {

template <class Shape>
void weigh_with(const Shape& shape, State& state, const Scene& scene) {
  for (Body& body : state.bodies) {
    const Points& p = body.points;
    const Array &x = p.kernel_x(frame_of(scene)), &y = p.kernel_y(frame_of(scene));
    const double density = density_of(body);
    for (std::size_t first = 0; first < p.size(); first += lane_count) {
      const StencilOf<Shape> stencil(state.grid, load(&x[first]), load(&y[first]), shape);
      const Lanes mass = density * load(&p.volume[first]);
      std::array<Lanes, 6> share;
      for (std::size_t i = 0; i < 3; ++i) {
        share[2 * i] = stencil.weight_x[i] * mass * scene.gravity->x;
        share[2 * i + 1] = stencil.weight_x[i] * mass * scene.gravity->y;
      }
      stencil.add(body.field.force.data(), share);
    }
  }
}

void change_velocity(State& state, const Scene& scene, VelocityField& field) {
  state.piston.force += fold_force(state, scene, field);
  for (std::size_t node = 0; node < state.grid.nodes(); ++node)
    for (std::size_t k = 2 * node; k < 2 * node + 2; ++k)
      field.change[k] = field.mass[node] > 0.0 ? state.step * field.force[k] / field.mass[node] : 0.0;
}

}  // namespace

void weigh(State& state, const Scene& scene) {
  std::visit([&](const auto& shape) { weigh_with(shape, state, scene); }, scene.numerics.shape);
}

void accelerate(State& state, const Scene& scene) {
  state.piston.force = 0.0;
  for (Body& body : state.bodies) change_velocity(state, scene, body.field);
}

}  // namespace kerf::forward::bodies
