#include "models/base/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "models/base/units.hpp"

namespace kerf {
namespace {

/// Units that people write in cutting papers; the pool from which hints are drawn.
const std::vector<std::string>& usual_units() {
  static const std::vector<std::string> units{
      "mm",  "um",   "m",    "nm",  "MPa",    "GPa",    "kPa",    "Pa",    "J/m^2",  "kJ/m^2", "N/mm",
      "N/m", "kN/m", "N",    "kN",  "mN",     "mm/s",   "m/s",    "m/min", "mm/min", "s",      "ms",
      "us",  "min",  "deg",  "rad", "kg/m^3", "g/cm^3", "1/s",    "1/ms",  "mm^2",   "m^2",    "tonne/mm^3",
      "K",   "1/K",  "1/mm", "1/m", "MPa/mm", "GPa/m",  "N/mm^3", "N mm",  "N m",    "J",      "mJ"};
  return units;
}

std::vector<std::string> usual_units_like(std::string_view unit) {
  std::vector<std::string> alike;
  for (const std::string& candidate : usual_units())
    if (same_dimension(candidate, unit)) alike.push_back(candidate);
  return alike;
}

/// The number and unit written at `node`, refused when the parameter wants another kind of value.
Quantity written_at(const Node& node, const Parameter& parameter) {
  const bool pure = parameter.unit == "1";
  if (const auto* bare = std::get_if<double>(&node.value)) {
    if (!std::isfinite(*bare)) throw std::invalid_argument("is not a finite number");
    if (!pure)
      throw std::invalid_argument(fmt::format("has no unit; write for example \"{} {}\"", *bare, parameter.unit));
    return {*bare, parameter.unit};
  }
  const std::string wanted =
      pure ? "a number" : fmt::format("a number with its unit, such as \"1 {}\",", parameter.unit);
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) throw std::invalid_argument(fmt::format("is {}; {} belongs here", kind_of(node), wanted));
  Quantity quantity;
  try {
    quantity = split_quantity(*text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("is refused: {}; {} belongs here", error.what(), wanted));
  }
  if (pure)
    throw std::invalid_argument(fmt::format("is a string, but a pure number belongs here; write {}", quantity.number));
  if (quantity.unit.empty())
    throw std::invalid_argument(
        fmt::format("has no unit; write for example \"{} {}\"", quantity.number, parameter.unit));
  return quantity;
}

/// A usual unit that would put `number` into the allowed range: people mistake the prefix, not the digits.
std::string in_range_hint(double number, std::string_view unit, const Parameter& parameter, double lower,
                          double upper) {
  const double written = consistent_units_in(unit);
  std::vector<std::string> closest;
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::string& candidate : usual_units_like(parameter.unit)) {
    constexpr double same = 1e-9;
    const double factor = consistent_units_in(candidate);
    const double decades = std::abs(std::log10(factor / written));
    const double value = number * factor;
    if (value < lower || value > upper || decades < same || decades > smallest + same) continue;
    if (decades < smallest - same) closest.clear();
    smallest = std::min(smallest, decades);
    closest.push_back(candidate);
  }
  if (closest.empty()) return "";
  return fmt::format("; did you mean {}?", nearest(unit, closest).value_or(closest.front()));
}

}  // namespace

std::string kind_of(const Node& node) {
  constexpr std::array<const char*, 5> words{"a number", "true or false", "a string", "a list", "a table"};
  return words.at(node.value.index());
}

std::string what_belongs(std::string_view expected) {
  return expected == "1" ? "; a pure number belongs here, without a unit"
                         : fmt::format("; a unit such as {} belongs here", expected);
}

std::string unit_hint(std::string_view unit, std::string_view expected) {
  const auto alike = usual_units_like(expected);
  // Case is the usual slip ("Mpa"), and then the pool of all dimensions would only confuse.
  if (const auto near = nearest(unit, alike)) return fmt::format("; did you mean {}?", *near);
  return what_belongs(expected);
}

double read_number(const Node& node, const Parameter& parameter) {
  const auto [number, unit] = written_at(node, parameter);
  return in_range(number, unit, parameter);
}

double in_range(double number, std::string_view unit, const Parameter& parameter) {
  double factor = 1.0;
  try {
    factor = consistent_units_in(unit);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("is refused: {}{}", error.what(), unit_hint(unit, parameter.unit)));
  }
  if (!same_dimension(unit, parameter.unit))
    throw std::invalid_argument(
        fmt::format("is in {}, which does not measure this{}", unit, what_belongs(parameter.unit)));

  const double value = number * factor;
  const double scale = consistent_units_in(parameter.unit);
  // A bound given in another unit may differ from itself by rounding.
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  const double lower = parameter.lower * scale - std::abs(parameter.lower * scale) * rounding;
  const double upper = parameter.upper * scale + std::abs(parameter.upper * scale) * rounding;
  if (!(value >= lower && value <= upper)) {
    const bool below = value < lower;
    const double bound = below ? parameter.lower : parameter.upper;
    const std::string words =
        parameter.unit == "1" ? fmt::format("{:g}", bound) : fmt::format("{:g} {}", bound, parameter.unit);
    throw std::invalid_argument(fmt::format("is {} {} (allowed: {}){}", below ? "below" : "above", words,
                                            allowed_range(parameter),
                                            in_range_hint(number, unit, parameter, lower, upper)));
  }
  return value;
}

Node::Value write_number(double value, const Parameter& parameter) {
  if (parameter.unit == "1") return value;
  const double factor = consistent_units_in(parameter.unit);
  const double quotient = value / factor;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double number : {quotient, std::nextafter(quotient, -infinity), std::nextafter(quotient, infinity)})
    if (std::bit_cast<std::uint64_t>(number * factor) == std::bit_cast<std::uint64_t>(value))
      return fmt::format("{} {}", number, parameter.unit);
  return fmt::format("{} {}", value, consistent_unit(parameter.unit));
}

}  // namespace kerf
