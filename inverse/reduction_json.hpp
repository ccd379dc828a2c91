#pragma once

#include <nlohmann/json.hpp>

#include "models/chip/reduction.hpp"

namespace kerf::inverse {

/// The result of `kerf reduce --json`: {"methods": {NAME: {"parameters", "verdict", ...}}, "friction_line",
/// "friction_lines", "measured", "warnings"}. Absent and infinite numbers are null. Toughness in J/m^2, forces in N/m,
/// depths in mm.
nlohmann::ordered_json to_json(const chip::Reduction& reduction, const chip::Measurements& measurements);

/// {"value", "se", "interval", "unit", "verdict"} of one parameter of a method.
nlohmann::ordered_json to_json(const chip::MethodResult& result, const chip::FittedParameter& parameter);

/// One sentence about a fit: accepted, rejected, out of range or not determined, with the numbers behind it.
std::string verdict_of(const chip::MethodResult& result);

/// What the cuts say about one parameter; says as well when the model itself is not to be believed.
std::string verdict_of(const chip::MethodResult& result, const chip::FittedParameter& parameter);

}  // namespace kerf::inverse
