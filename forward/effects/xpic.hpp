#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// The grid velocities that XPIC(m) blends towards, from the new velocities v:
///     v(m) = sum_{l=1..m} dv(l),   dv(1) = v,   dv(l) = (I - S+ S) dv(l - 1)
/// with S the interpolation to the particles and S+ its mass-weighted transpose. m = 1 is PIC; each further order gives
/// back more of what PIC would damp, until only what the grid cannot hold is left out. Source: Hammerquist & Nairn
/// 2017; Nairn & Hammerquist 2021. Costs m - 1 passes over the particles.
void filter_velocity(State& state, int order);

}  // namespace kerf::forward
