#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// A chip that curls meets the uncut surface, and later its own outside, with its end and its cut face. A penalty
/// (`stiffness`, MPa/mm) acts on the distance of the chip's cut face from the segments of the layer's outer surface,
/// where it has entered them by less than `reach`; further in is the chip itself. Frictionless; what one surface gets
/// the other gives, so momentum is kept.
void touch_itself(State& state, double stiffness, double reach);

}  // namespace kerf::forward
