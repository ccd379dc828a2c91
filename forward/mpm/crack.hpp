#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Markers ride on the crack faces. Velocities are interpolated from, and forces shared to, the nodes of the marker's
/// own side with the mass-weighted kernel W_i = w_i m_i / sum_j w_j m_j: nothing is asked of nearly empty nodes, so
/// that neither creep nor null-space noise arises, and with one kernel for both ways the work of a marker force is the
/// work it does on the grid.

/// Reads the projected velocity at every marker, moves it, and clears its force.
void move_markers(State& state);

/// Cohesive tractions between unbroken pairs. Openings are measured in the crack plane's directions; each mode follows
/// its own law, unloading to the origin; the pair breaks, both tractions at once, when
/// (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1 (theory Eq. 8), in the reading that the scene names (see MixedMode).
void pull_faces(State& state, const Cohesive& cohesive);

/// Takes a pair's tractions away; what its laws had used up is added to the broken energy.
void break_bond(State& state, const Cohesive& cohesive, std::size_t k);

/// The upper face cannot enter the lower one, wherever it has slid to: a penalty (`stiffness`, MPa/mm) on the gap
/// between an upper marker and the segment of the lower face below it. Frictionless.
void close_faces(State& state, double stiffness);

/// Shares the markers' forces to the nodes they were interpolated from.
void spread_marker_forces(State& state);

}  // namespace kerf::forward
