#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Frictionless walls by mirror images. A wall with velocity V lies midway between two nodes; a node behind it holds
/// the mirror image of the node before it, v_n = 2 V - v_n', v_t = v_t', so that what the nodes behind are given
/// belongs to those before: m' += m, p_n' += 2 m V - p_n, f_n' -= f_n, and tangential parts are added. A linear field
/// is then reproduced up to the wall, and the virtual work of the forces is kept.

/// Before velocities are p/m: masses and momenta of the nodes behind the walls move before them.
void fold_momentum(const State& state, const Scene& scene, VelocityField& field);
/// The images of velocities.
void mirror_velocity(const State& state, const Scene& scene, VelocityField& field);
/// Forces move like momenta. Returns the force of the piston on the body, +x: what the change of momentum leaves over.
double fold_force(const State& state, const Scene& scene, VelocityField& field);
/// The images of velocity changes.
void mirror_change(const State& state, const Scene& scene, VelocityField& field);

}  // namespace kerf::forward::bodies
