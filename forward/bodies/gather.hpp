#pragma once

#include <functional>

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Nodal masses and velocities p/m of every body under the walls; forces and changes are set to zero. A
/// point that is not on the grid breaks the run down.
void gather_momentum(State& state, const Scene& scene);

/// The nodal velocities that XPIC(m) takes, see effects/xpic.hpp. `share` gives bodies that are one their common
/// velocity.
void filter_velocity(State& state, const Scene& scene, const std::function<void(State&)>& share);

}  // namespace kerf::forward::bodies
