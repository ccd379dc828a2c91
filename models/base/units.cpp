#include "models/base/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace kerf {
namespace {

/// The quantities Kerf knows are products of powers of these. UDUNITS counts an angle as a pure number but keeps the
/// radian among its basic units, which is how the two are told apart here.
enum Base { length, mass, time, temperature, angle };
constexpr std::array<std::string_view, 5> si_symbol{"m", "kg", "s", "K", "rad"};
constexpr std::array<std::string_view, 5> consistent_symbol{"mm", "tonne", "s", "K", "rad"};

struct Measure {
  double si_scale = 1.0;  ///< one unit in m, kg, s, K, rad
  std::array<int, 5> powers{};
  bool usable = true;
};

ut_status add_basic(const ut_unit* unit, int power, Measure& measure) {
  const char* symbol = ut_get_symbol(unit, UT_ASCII);
  for (std::size_t base = 0; base < si_symbol.size(); ++base)
    if (symbol && symbol == si_symbol[base]) {
      measure.powers[base] += power;
      return UT_SUCCESS;
    }
  measure.usable = false;
  return UT_SUCCESS;
}

const ut_visitor& dimension_visitor() {
  static const ut_visitor visitor{
      [](const ut_unit* unit, void* out) { return add_basic(unit, 1, *static_cast<Measure*>(out)); },
      [](const ut_unit*, int count, const ut_unit* const* units, const int* powers, void* out) {
        for (int i = 0; i < count; ++i) add_basic(units[i], powers[i], *static_cast<Measure*>(out));
        return UT_SUCCESS;
      },
      [](const ut_unit*, double scale, const ut_unit* underlying, double offset, void* out) {
        auto& measure = *static_cast<Measure*>(out);
        measure.si_scale *= scale;
        if (offset != 0.0) measure.usable = false;  // a zero point (degC) is not a factor
        return ut_accept_visitor(underlying, &dimension_visitor(), out);
      },
      [](const ut_unit*, const ut_unit*, double, void* out) {
        static_cast<Measure*>(out)->usable = false;
        return UT_SUCCESS;
      },
      [](const ut_unit*, double, const ut_unit*, void* out) {
        static_cast<Measure*>(out)->usable = false;
        return UT_SUCCESS;
      }};
  return visitor;
}

/// UDUNITS skips bytes that it does not know; these are the characters beyond ASCII that stand in units.
bool is_plain_text(std::string_view unit) {
  constexpr std::string_view special[] = {"\u00b5", "\u03bc", "\u00b0", "\u00b9",
                                          "\u00b2", "\u00b3", "\u207b", "\u00b7"};
  while (!unit.empty()) {
    std::size_t length = std::isprint(static_cast<unsigned char>(unit.front())) ? 1 : 0;
    for (const std::string_view character : special)
      if (unit.starts_with(character)) length = character.size();
    if (length == 0) return false;
    unit.remove_prefix(length);
  }
  return true;
}

/// UDUNITS reads numbers inside a unit as factors ("1 200 mm" is 200 mm after the 1, "mm^0.5" is 5). Kerf allows digits
/// only as whole exponents, and a leading "1/".
bool digits_are_exponents(std::string_view unit) {
  if (unit == "1") return true;
  if (unit.starts_with('1')) {
    unit.remove_prefix(1);
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    if (!unit.starts_with('/')) return false;
  }
  const auto is = [&](std::size_t i, auto predicate) { return i < unit.size() && predicate(unit[i]); };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto sign = [](char c) { return c == '-' || c == '+'; };
  const auto carries_exponent = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '^'; };
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (!digit(unit[i]) || (i > 0 && digit(unit[i - 1]))) continue;
    const std::size_t before = is(i - 1, sign) ? i - 2 : i - 1;
    const bool power_stars = before >= 1 && is(before, [](char c) { return c == '*'; }) && unit[before - 1] == '*';
    if (!is(before, carries_exponent) && !power_stars) return false;
  }
  for (std::size_t i = 0; i + 1 < unit.size(); ++i)
    if (digit(unit[i]) && unit[i + 1] == '.' && is(i + 2, digit)) return false;
  return true;
}

/// The one UDUNITS system of the process. The library is not thread-safe, so every use holds the lock; results are
/// kept, because a calibration asks for the same dozen units thousands of times.
class UnitSystem {
 public:
  static Measure measure(std::string_view unit) {
    static UnitSystem system;
    const std::scoped_lock lock(system.mutex_);
    if (const auto known = system.known_.find(unit); known != system.known_.end()) return known->second;
    const Measure measure = system.parse(unit);
    if (system.known_.size() < most_kept) system.known_.emplace(unit, measure);
    return measure;
  }

 private:
  static constexpr std::size_t most_kept = 1000, longest_unit = 60;
  using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;

  UnitSystem() : system_(nullptr, &ut_free_system) {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_) throw std::runtime_error("cannot load the UDUNITS-2 database of units");
    const Unit degree(ut_get_unit_by_name(system_.get(), "degree"), &ut_free);
    ut_map_name_to_unit("deg", UT_ASCII, degree.get());
  }

  Measure parse(std::string_view unit) const {
    if (unit.find_first_not_of(' ') == unit.npos) throw std::invalid_argument("the unit is missing");
    Unit parsed(nullptr, &ut_free);
    if (unit.size() <= longest_unit && is_plain_text(unit) && digits_are_exponents(unit))
      parsed.reset(ut_parse(system_.get(), std::string(unit).c_str(), UT_UTF8));
    if (!parsed) throw std::invalid_argument(fmt::format("\"{}\" is not a unit", unit));
    Measure measure;
    ut_accept_visitor(parsed.get(), &dimension_visitor(), &measure);
    if (!measure.usable || !(measure.si_scale > 0.0) || !std::isfinite(measure.si_scale))
      throw std::invalid_argument(
          fmt::format("\"{}\" is not made of lengths, masses, times, absolute temperatures and angles", unit));
    return measure;
  }

  std::mutex mutex_;
  std::unique_ptr<ut_system, decltype(&ut_free_system)> system_;
  std::map<std::string, Measure, std::less<>> known_;
};

/// The nearest power of ten when `x` is one up to rounding, so that "0.5 GPa" is 500 MPa to the last bit.
double without_rounding(double x) {
  const double power = std::pow(10.0, std::round(std::log10(x)));
  return std::abs(x / power - 1.0) < 1e-14 ? power : x;
}

double pow10(int exponent) {
  double power = 1.0;
  for (int i = 0; i < exponent; ++i) power *= 10.0;
  return power;
}

}  // namespace

double consistent_units_in(std::string_view unit) {
  const Measure measure = UnitSystem::measure(unit);
  const int decades = 3 * (measure.powers[length] - measure.powers[mass]);  // m -> mm, kg -> tonne
  return without_rounding(decades >= 0 ? measure.si_scale * pow10(decades) : measure.si_scale / pow10(-decades));
}

bool same_dimension(std::string_view unit, std::string_view other) {
  return UnitSystem::measure(unit).powers == UnitSystem::measure(other).powers;
}

std::string consistent_unit(std::string_view unit) {
  for (const std::string_view common : {"1", "mm", "MPa", "N/mm", "N", "mm/s", "s", "rad"})
    if (same_dimension(unit, common)) return std::string(common);
  std::string product;
  const auto powers = UnitSystem::measure(unit).powers;
  for (std::size_t base = 0; base < powers.size(); ++base)
    if (powers[base] != 0)
      product += fmt::format("{}{}^{}", product.empty() ? "" : " ", consistent_symbol[base], powers[base]);
  return product;
}

Quantity split_quantity(std::string_view text) {
  const auto strip = [](std::string_view s) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
    while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
    return s;
  };
  text = strip(text);
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double number = 0.0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (status == std::errc::result_out_of_range)
    throw std::invalid_argument(fmt::format("the number in \"{}\" is too large or too small", text));
  if (status != std::errc() || text.starts_with("+-"))
    throw std::invalid_argument(fmt::format("\"{}\" does not begin with a number", text));
  if (!std::isfinite(number)) throw std::invalid_argument(fmt::format("\"{}\" is not a finite number", text));
  const auto rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
  if (rest.starts_with(','))
    throw std::invalid_argument(fmt::format("\"{}\" has a comma in its number; write a decimal point", text));
  return {number, std::string(strip(rest))};
}

}  // namespace kerf
