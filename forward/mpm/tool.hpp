#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// The tool is rigid and analytic; it touches the crack-face markers, never particles or nodes, so its normals are
/// exact and contact begins where the face is. A penalty acts on the penetration phi < 0: normal traction -k phi; along
/// the face a spring of the same stiffness follows the sliding up to the slip limit.

/// Advances the tip with the velocity ramp and clears this step's tool force.
void move_tool(State& state, const Cut& cut);

/// The base lifts as the layer is pulled off it, by a few per cent of h. Held at the machine's height, an edge would
/// squeeze that lift back down through a patch of a cell, and the force would measure the mesh. So the tip follows the
/// lower face,
///     d y_tip / d travel = (mean height of the face 0.1 h ... 0.3 h ahead + lift - y_tip) / (0.3 h),
/// and the work of that vertical motion is booked.
void follow_face(State& state, double depth, double lift);

/// A force of the tool on marker k of a face, N/mm, with the work the moving tool does through it.
void push_face(State& state, Side side, std::size_t k, double x, double y);

/// Rake face against the upper side: the half-plane through the tip with normal (cos alpha, sin alpha).
void press_rake_face(State& state, double rake, double stiffness);

/// The clearance plane through the tip: behind the tip the lower face cannot rise into the tool, however strongly bonds
/// that still hold pull it. Frictionless; a free face does not reach it.
void block_underside(State& state, double clearance, double stiffness);

/// Friction on the pressures just found: tau = min(mu p, cap sigma_y / sqrt 3), the dissipation booked. The cap looks
/// at the pressure of a cell, not of a marker.
void rub_rake_face(State& state, double rake, const Friction& friction, double shear_yield, double stiffness);

}  // namespace kerf::forward
