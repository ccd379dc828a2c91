#pragma once

#include "forward/run.hpp"

namespace kerf::inverse {

/// A cut that costs nothing, in the place of a simulated one: forces and chip ratio of Williams' minimised shear plane
/// with the scene's shear yield stress (as sigma_y = sqrt(3) k), mode I toughness and friction. It knows no strength
/// and no curl, and is refused where it has no solution or the scene no yield stress.
forward::CutResult closed_form_cut(const forward::Scene& scene);

}  // namespace kerf::inverse
