#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Frictionless walls by mirror images. A wall with velocity V lies midway between two nodes; a node behind it holds
/// the mirror image of the node before it, v_n = 2 V - v_n', v_t = v_t', so that what the nodes behind are given
/// belongs to those before: m' += m, p_n' += 2 m V - p_n, f_n' -= f_n, and tangential parts are added. A linear field
/// is then reproduced up to the wall, and the virtual work of the forces is kept.

/// A node behind a wall with the node whose image it holds.
struct Mirror {
  std::size_t behind, before;
};

/// Calls visit(mirror, edge) for the walls whose normal is along `normal`, 0: x, 1: y. Rows behind the upper and the
/// lower wall are emptied when they are folded, and so count nowhere else.
template <class Visit>
void each_mirror(const Grid& grid, const Scene& scene, std::size_t normal, Visit&& visit) {
  const int across = normal == 0 ? grid.rows : grid.columns, last = (normal == 0 ? grid.columns : grid.rows) - 1;
  const auto node = [&](int along, int other) {
    return normal == 0 ? grid.node(along, other) : grid.node(other, along);
  };
  for (const bool far : {false, true}) {
    const Edge edge = normal == 0 ? (far ? right : left) : (far ? top : bottom);
    if (scene.walls[edge] != Wall::roller) continue;
    for (int other = 0; other < across; ++other)
      for (int k = 0; k < 2; ++k)
        visit(Mirror{node(far ? last - k : k, other), node(far ? last - 3 + k : 3 - k, other)}, edge);
  }
}

/// Before velocities are p/m: masses and momenta of the nodes behind the walls move before them.
void fold_momentum(const State& state, const Scene& scene, VelocityField& field);
/// The images of velocities.
void mirror_velocity(const State& state, const Scene& scene, VelocityField& field);
/// Forces move like momenta. Returns the force of the piston on the body, +x: what the change of momentum leaves over.
double fold_force(const State& state, const Scene& scene, VelocityField& field);
/// The images of velocity changes.
void mirror_change(const State& state, const Scene& scene, VelocityField& field);

}  // namespace kerf::forward::bodies
