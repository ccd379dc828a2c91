#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Points take their new velocities from the nodes, as bodies/transfer.hpp says, and move. What a transfer loses is
/// booked as damping.
void advance(State& state, const Scene& scene);

}  // namespace kerf::forward::bodies
