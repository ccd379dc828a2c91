#include "forward/bodies/walls.hpp"

namespace kerf::forward::bodies {
namespace {

double speed_of(const State& state, Edge edge) {
  return edge == right ? state.piston.speed : 0.0;
}

}  // namespace

void fold_momentum(const State& state, const Scene& scene, VelocityField& field) {
  for (const std::size_t normal : {1u, 0u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state.grid, scene, normal, [&](const Mirror& m, Edge edge) {
      const double mass = field.mass[m.behind];
      field.mass[m.before] += mass;
      field.momentum[2 * m.before + normal] +=
          2.0 * mass * speed_of(state, edge) - field.momentum[2 * m.behind + normal];
      field.momentum[2 * m.before + tangent] += field.momentum[2 * m.behind + tangent];
      if (normal == 1) field.mass[m.behind] = field.momentum[2 * m.behind] = field.momentum[2 * m.behind + 1] = 0.0;
    });
  }
}

void mirror_velocity(const State& state, const Scene& scene, VelocityField& field) {
  for (const std::size_t normal : {0u, 1u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state.grid, scene, normal, [&](const Mirror& m, Edge edge) {
      field.velocity[2 * m.behind + normal] = 2.0 * speed_of(state, edge) - field.velocity[2 * m.before + normal];
      field.velocity[2 * m.behind + tangent] = field.velocity[2 * m.before + tangent];
    });
  }
}

double fold_force(const State& state, const Scene& scene, VelocityField& field) {
  double reaction = 0.0;
  for (const std::size_t normal : {1u, 0u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state.grid, scene, normal, [&](const Mirror& m, Edge edge) {
      const double behind = field.force[2 * m.behind + normal];
      double& before = field.force[2 * m.before + normal];
      const double mass = field.mass[m.before];
      if (edge == right && mass > 0.0) {
        const double share = field.mass[m.behind] / mass;
        reaction += (1.0 - 2.0 * share) * (before - behind) - (before + behind);
      }
      before -= behind;
      field.force[2 * m.before + tangent] += field.force[2 * m.behind + tangent];
      if (normal == 1) field.force[2 * m.behind] = field.force[2 * m.behind + 1] = 0.0;
    });
  }
  return reaction;
}

void mirror_change(const State& state, const Scene& scene, VelocityField& field) {
  for (const std::size_t normal : {0u, 1u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state.grid, scene, normal, [&](const Mirror& m, Edge) {
      field.change[2 * m.behind + normal] = -field.change[2 * m.before + normal];
      field.change[2 * m.behind + tangent] = field.change[2 * m.before + tangent];
    });
  }
}

}  // namespace kerf::forward::bodies
