#pragma once

#include <string>

#include "inverse/calibration.hpp"

namespace kerf::inverse {

/// What a calibration does and does not determine, in plain English: value, error and verdict of every parameter, how
/// much of the answer hangs on the assumption about the edge, whether the model fits, what failed, and why it stopped.
std::string state(const Job& job, const Calibration& calibration);

/// A value in a unit: to the second digit of its error ("1096 MPa" of an error of 78 MPa), without one to three
/// significant digits or to units.
std::string show(double value, const std::string& unit, double error = 0.0);

}  // namespace kerf::inverse
