#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Adds the weight of every body to the forces on its nodes.
void weigh(State& state, const Scene& scene);

/// Changes of the nodal velocities by these forces under the walls, and the piston's force.
void accelerate(State& state, const Scene& scene);

}  // namespace kerf::forward::bodies
