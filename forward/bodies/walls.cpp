#include "forward/bodies/walls.hpp"

namespace kerf::forward::bodies {
namespace {

/// A node behind a wall with the node whose image it holds.
struct Mirror {
  std::size_t behind, before;
};

/// Calls visit(mirror, velocity of the wall, is it the piston) for the walls whose normal is along `normal`, 0: x, 1:
/// y. Rows behind the upper and the lower wall are emptied when they are folded, and so count nowhere else.
template <class Visit>
void each_mirror(const State& state, const Scene& scene, std::size_t normal, Visit&& visit) {
  const Grid& grid = state.grid;
  const int across = normal == 0 ? grid.rows : grid.columns, last = (normal == 0 ? grid.columns : grid.rows) - 1;
  const auto node = [&](int along, int other) {
    return normal == 0 ? grid.node(along, other) : grid.node(other, along);
  };
  for (const bool far : {false, true}) {
    const Edge edge = normal == 0 ? (far ? right : left) : (far ? top : bottom);
    if (scene.walls[edge] != Wall::roller) continue;
    const double speed = edge == right ? state.piston.speed : 0.0;
    for (int other = 0; other < across; ++other)
      for (int k = 0; k < 2; ++k) {
        const int behind = far ? last - k : k, before = far ? last - 3 + k : 3 - k;
        visit(Mirror{node(behind, other), node(before, other)}, speed, edge == right);
      }
  }
}

}  // namespace

void fold_momentum(const State& state, const Scene& scene, VelocityField& field) {
  for (const std::size_t normal : {1u, 0u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state, scene, normal, [&](const Mirror& m, double speed, bool) {
      const double mass = field.mass[m.behind];
      field.mass[m.before] += mass;
      field.momentum[2 * m.before + normal] += 2.0 * mass * speed - field.momentum[2 * m.behind + normal];
      field.momentum[2 * m.before + tangent] += field.momentum[2 * m.behind + tangent];
      if (normal == 1) field.mass[m.behind] = field.momentum[2 * m.behind] = field.momentum[2 * m.behind + 1] = 0.0;
    });
  }
}

void mirror_velocity(const State& state, const Scene& scene, VelocityField& field) {
  for (const std::size_t normal : {0u, 1u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state, scene, normal, [&](const Mirror& m, double speed, bool) {
      field.velocity[2 * m.behind + normal] = 2.0 * speed - field.velocity[2 * m.before + normal];
      field.velocity[2 * m.behind + tangent] = field.velocity[2 * m.before + tangent];
    });
  }
}

double fold_force(const State& state, const Scene& scene, VelocityField& field) {
  double reaction = 0.0;
  for (const std::size_t normal : {1u, 0u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(state, scene, normal, [&](const Mirror& m, double, bool is_piston) {
      const double behind = field.force[2 * m.behind + normal];
      double& before = field.force[2 * m.before + normal];
      const double mass = field.mass[m.before];
      if (is_piston && mass > 0.0) {
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
    each_mirror(state, scene, normal, [&](const Mirror& m, double, bool) {
      field.change[2 * m.behind + normal] = -field.change[2 * m.before + normal];
      field.change[2 * m.behind + tangent] = field.change[2 * m.before + tangent];
    });
  }
}

}  // namespace kerf::forward::bodies
