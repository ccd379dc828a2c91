#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// A worn edge on the freshly cut face: an arc of radius R_L whose lowest point lies `press_in` below the tip of the
/// rake plane, which follows the face (see follow_face). The arc runs from the clearance angle to the separation angle
/// theta_s = arccos(1 - press_in / R_L), each end continued by its tangent.
/// Normal penalty and Coulomb friction of the arc on the lower side.
void press_edge(State& state, const EdgeContact& edge, double clearance, double stiffness);

}  // namespace kerf::forward
