#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Particles to grid: mass and momentum of both sides, from scratch. Every step ends with this for the next one
/// (see `advance`), so it is called on its own only after the window has moved.
void gather_momentum(State& state);

/// Grid velocities p/m under the fixed boundary: the projected velocity that strains, markers and the ledger share.
void project_velocity(State& state);

/// Update stress first: velocity gradients from the projected velocity, the material law, then the internal force
/// f_i = -sum_p V tau grad w_ip, in one pass over the particles.
void update_stress(State& state, const laws::Material& material);

/// The change dt f/m of the grid velocities, under the fixed boundary; makes room for the momentum of the next step.
void accelerate(State& state);

/// Moves the particles (FLIP; blended with a share `pic` of PIC, whose loss is booked as damping) and gathers their
/// momentum for the next step in the same pass.
void advance(State& state, double pic);

/// The same, blended towards the filtered velocity (see effects/xpic.hpp).
void advance_filtered(State& state, double rate);

}  // namespace kerf::forward
