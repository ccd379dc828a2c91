#pragma once

#include <string>

#include "inverse/calibration.hpp"

namespace kerf::inverse {

/// What a calibration does and does not determine, in plain English: value, error and verdict of every parameter, how
/// much of the answer hangs on the assumption about the edge, whether the model fits, what failed, and why it stopped.
std::string state(const Job& job, const Calibration& calibration);

/// A value in a unit with three significant digits: "1050 MPa".
std::string show(double value, const std::string& unit);

}  // namespace kerf::inverse
