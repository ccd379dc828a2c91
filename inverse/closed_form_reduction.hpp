#pragma once

#include "data/curve.hpp"
#include "models/chip/measured_cut.hpp"

namespace kerf::inverse {

/// A measured curve as the closed forms' fits take it: means with standard errors.
chip::Measurements measurements_of(const data::Curve& curve);

}  // namespace kerf::inverse
