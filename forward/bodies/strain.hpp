#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Deformation, heat and stress of all points after a time `step` with the velocities that the nodes have gathered;
/// and, if asked, the internal forces of these stresses on the nodes.
void strain(State& state, const Scene& scene, const Stroke& stroke, double step, bool with_forces);

/// The same after a whole step with the nodal velocities at its end, without forces.
void strain_last(State& state, const Scene& scene, const Stroke& stroke);

/// Internal forces of the stresses as they are.
void push(State& state, const Scene& scene);

/// The stress of every body for its deformation and temperature as they are.
void find_stress(State& state);

}  // namespace kerf::forward::bodies
