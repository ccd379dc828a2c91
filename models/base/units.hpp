#pragma once

#include <string>
#include <string_view>

namespace kerf {

/// Inside the code every number is in one consistent system: mm, MPa, N, tonne, s, rad (so N/mm for toughness and for
/// force per width, tonne/mm^3 for density, mm/s for speed). These functions are the only edge; UDUNITS-2 does the
/// work.

/// Consistent units in one `unit` ("J/m^2" -> 1e-3, "deg" -> pi/180, "1" -> 1).
/// Throws std::invalid_argument when `unit` is not a unit or has a dimension Kerf does not use.
double consistent_units_in(std::string_view unit);

/// True when both units measure the same dimension. An angle is told apart from a pure number.
bool same_dimension(std::string_view unit, std::string_view other);

/// The unit of the consistent system that measures the same dimension ("J/m^2" -> "N/mm", "kg/m^3" -> "mm^-3 tonne^1");
/// `consistent_units_in` of it is exactly 1.
std::string consistent_unit(std::string_view unit);

/// A quantity as a user writes it: "0.5 mm" -> {0.5, "mm"}; "0.5" -> {0.5, ""}.
/// Throws std::invalid_argument when `text` does not begin with a finite number.
struct Quantity {
  double number;
  std::string unit;
};
Quantity split_quantity(std::string_view text);

}  // namespace kerf
