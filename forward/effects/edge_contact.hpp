#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// A worn edge on the freshly cut face. Held at the machine's height, an edge would squeeze the elastic lift of the
/// base back down through a patch of a cell, and the force would measure the mesh. So the edge follows the face: the
/// separation point (the tip of the rake plane) keeps the mean height of the lower face just ahead of it,
///     d y_tip / d travel = (mean height of the face 0.1 h ... 0.3 h ahead - y_tip) / (0.3 h),
/// and what presses is geometry: an arc of radius R_L whose lowest point lies `press_in` below the separation point.
/// The arc runs from the clearance angle to the separation angle theta_s = arccos(1 - press_in / R_L), each end
/// continued by its tangent. The work of the tool's vertical motion is booked.

void follow_face(State& state, double depth);

/// Normal penalty and Coulomb friction of the arc on the lower side.
void press_edge(State& state, const EdgeContact& edge, double stiffness);

}  // namespace kerf::forward
