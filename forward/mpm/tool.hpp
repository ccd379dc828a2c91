#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// The tool is rigid and analytic; it touches the crack-face markers, never particles or nodes, so its normals are
/// exact and contact begins where the face is. A penalty acts on the penetration phi < 0: normal traction -k phi; along
/// the face a spring of the same stiffness follows the sliding up to the slip limit.

/// Advances the tip with the velocity ramp and clears this step's tool force.
void move_tool(State& state, const Cut& cut);

/// A force of the tool on marker k of a face, N/mm, with the work the moving tool does through it.
void push_face(State& state, Side side, std::size_t k, double x, double y);

/// Rake face against the upper side: the half-plane through the tip with normal (cos alpha, sin alpha).
void press_rake_face(State& state, double rake, double stiffness);

/// Friction on the pressures just found: tau = min(mu p, cap sigma_y / sqrt 3), the dissipation booked. The cap looks
/// at the pressure of a cell, not of a marker.
void rub_rake_face(State& state, double rake, const Friction& friction, double shear_yield, double stiffness);

}  // namespace kerf::forward
