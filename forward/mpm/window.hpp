#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Lays the first window of material around the tool: a block that begins at x = 0 with the notch cut, the tip at its
/// end.
State lay_out(const Scene& scene);

/// Follows the tool by one cell: retires the wake and the chip's end (their energies are booked), feeds a column of
/// virgin material with its markers ahead, sorts the particles by (side, cell row, cell) and pads the batches.
void shift_window(State& state, const Scene& scene);

/// Gives a state whose particles have been put in their places the time step and the grid momentum that go with them.
void settle(State& state, const Scene& scene);

/// The stable time step of material whose grain points along this unit vector: the Courant number in transits of a
/// cell, along or across, by an elastic wave and the tool's speed.
double stable_step(const Scene& scene, double grain_x, double grain_y);

}  // namespace kerf::forward
