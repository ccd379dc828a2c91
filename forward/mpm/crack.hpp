#pragma once

#include <optional>

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Markers ride on the crack faces. Velocities are interpolated from, and forces shared to, the nodes of the marker's
/// own side with the mass-weighted kernel W_i = w_i m_i / sum_j w_j m_j: nothing is asked of nearly empty nodes, so
/// that neither creep nor null-space noise arises, and with one kernel for both ways the work of a marker force is the
/// work it does on the grid.

/// Reads the projected velocity at every marker, moves it, and clears its force.
void move_markers(State& state);

/// Cohesive tractions between unbroken pairs. Openings are measured in the crack path's directions; each mode follows
/// its own law, unloading to the origin; the pair breaks, both tractions at once, when
/// (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1 (theory Eq. 8), in the reading that the scene names (see MixedMode).
void pull_faces(State& state, const Cohesive& cohesive);

/// Takes a pair's tractions away; what its laws had used up is added to the broken energy.
void break_bond(State& state, const Cohesive& cohesive, std::size_t k);

/// An upper marker inside the lower face: at the share t of the lower segment j, `depth` below it along the normal of
/// the crack path (mm). The segment's own normal has a component of one along that.
struct Overlap {
  std::size_t segment;
  double t, normal_x, normal_y, depth;
};
std::optional<Overlap> overlap(const State& state, std::size_t k);

/// A force (N/mm) on upper marker k, and its opposite on the segment that it overlaps.
void push_apart(Crack& crack, std::size_t k, const Overlap& touch, double x, double y);

/// The upper face cannot enter the lower one, wherever it has slid to: a penalty (`stiffness`, MPa/mm) on the gap
/// between an upper marker and the segment of the lower face below it. Frictionless.
void close_faces(State& state, double stiffness);

/// Shares the markers' forces to the nodes they were interpolated from.
void spread_marker_forces(State& state);

}  // namespace kerf::forward
