#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Coulomb friction between crack faces that touch where their bonds are gone. As on the tool, a spring along the lower
/// face, as stiff as the penalty that keeps the faces apart (`stiffness`, MPa/mm), follows the sliding of each upper
/// marker up to the slip limit mu p; what slides beyond it is booked as friction.
void rub_faces(State& state, double coefficient, double stiffness);

}  // namespace kerf::forward
