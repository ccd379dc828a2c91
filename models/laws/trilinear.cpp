#include "models/laws/trilinear.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "models/base/error.hpp"

namespace kerf::laws {
namespace {

enum Symbol : std::size_t {
  strength,
  peak_opening,
  bridging_stress,
  knee_opening,
  critical_opening,
  initiation_toughness,
  bridging_toughness,
  toughness,
  peak,
  symbol_count
};
constexpr std::array<const char*, symbol_count> keys{"strength",           "peak_opening",     "bridging_stress",
                                                     "knee_opening",       "critical_opening", "initiation_toughness",
                                                     "bridging_toughness", "toughness",        "peak"};
constexpr std::size_t independent = 5;  ///< nine quantities less four relations

using Known = std::array<std::optional<double>, symbol_count>;

/// One relation between the quantities: when all but one are known it gives the last.
struct Relation {
  const char* equation;
  std::vector<Symbol> symbols;
  double (*solve)(Symbol wanted, const Known& known);
};

const std::vector<Relation>& relations() {
  static const std::vector<Relation> all{
      {.equation = "bridging_toughness = bridging_stress * critical_opening / 2",
       .symbols = {bridging_toughness, bridging_stress, critical_opening},
       .solve =
           [](Symbol wanted, const Known& k) {
             if (wanted == bridging_stress) return 2.0 * *k[bridging_toughness] / *k[critical_opening];
             if (wanted == critical_opening) return 2.0 * *k[bridging_toughness] / *k[bridging_stress];
             return 0.5 * *k[bridging_stress] * *k[critical_opening];
           }},
      {.equation = "toughness = initiation_toughness + bridging_toughness",
       .symbols = {toughness, initiation_toughness, bridging_toughness},
       .solve =
           [](Symbol wanted, const Known& k) {
             if (wanted == initiation_toughness) return *k[toughness] - *k[bridging_toughness];
             if (wanted == bridging_toughness) return *k[toughness] - *k[initiation_toughness];
             return *k[initiation_toughness] + *k[bridging_toughness];
           }},
      {.equation = "peak = peak_opening / knee_opening",
       .symbols = {peak, peak_opening, knee_opening},
       .solve =
           [](Symbol wanted, const Known& k) {
             if (wanted == peak_opening) return *k[peak] * *k[knee_opening];
             if (wanted == knee_opening) return *k[peak_opening] / *k[peak];
             return *k[peak_opening] / *k[knee_opening];
           }},
      {.equation = "initiation_toughness = (strength * knee_opening - bridging_stress * peak_opening) / 2",
       .symbols = {initiation_toughness, strength, knee_opening, bridging_stress, peak_opening},
       .solve = [](Symbol wanted, const Known& k) {
         if (wanted == strength)
           return (2.0 * *k[initiation_toughness] + *k[bridging_stress] * *k[peak_opening]) / *k[knee_opening];
         if (wanted == knee_opening)
           return (2.0 * *k[initiation_toughness] + *k[bridging_stress] * *k[peak_opening]) / *k[strength];
         if (wanted == bridging_stress)
           return (*k[strength] * *k[knee_opening] - 2.0 * *k[initiation_toughness]) / *k[peak_opening];
         if (wanted == peak_opening)
           return (*k[strength] * *k[knee_opening] - 2.0 * *k[initiation_toughness]) / *k[bridging_stress];
         return 0.5 * (*k[strength] * *k[knee_opening] - *k[bridging_stress] * *k[peak_opening]);
       }}};
  return all;
}

/// The two ways in which relations must be solved together because none of them has a single unknown.
bool solve_together(Known& k) {
  if (!k[knee_opening] && !k[peak_opening] && k[peak] && k[initiation_toughness] && k[strength] && k[bridging_stress]) {
    k[knee_opening] = 2.0 * *k[initiation_toughness] / (*k[strength] - *k[bridging_stress] * *k[peak]);
    return true;
  }
  if (!k[bridging_stress] && k[toughness] && k[strength] && k[knee_opening] && k[peak_opening] && k[critical_opening]) {
    k[bridging_stress] =
        (2.0 * *k[toughness] - *k[strength] * *k[knee_opening]) / (*k[critical_opening] - *k[peak_opening]);
    return true;
  }
  return false;
}

/// Fills in every quantity that follows from the given ones.
void deduce(Known& known) {
  for (bool found = true; found;) {
    found = false;
    for (const Relation& relation : relations()) {
      std::vector<Symbol> unknown;
      for (const Symbol symbol : relation.symbols)
        if (!known[symbol]) unknown.push_back(symbol);
      if (unknown.size() != 1) continue;
      known[unknown.front()] = relation.solve(unknown.front(), known);
      found = true;
    }
    found = found || solve_together(known);
  }
}

std::vector<std::string> names(const Known& known, bool present) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < symbol_count; ++i)
    if (known[i].has_value() == present) found.emplace_back(keys[i]);
  return found;
}

std::string listed(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

/// Says why the given quantities do not make one law: too few, too many, or some that say the same.
[[noreturn]] void refuse_choice(const std::string& where, const Known& given, const Known& deduced) {
  const auto present = names(given, true);
  const std::string so_far = present.empty() ? "nothing is given" : fmt::format("given: {}", listed(present));
  if (present.size() > independent)
    throw InputError(fmt::format("{}: the trilinear law takes exactly {} quantities, {} are too many; {}; leave {} out",
                                 where, independent, present.size(), so_far, present.size() - independent));
  for (const Relation& relation : relations()) {
    bool tied = true;
    std::vector<std::string> members;
    for (const Symbol symbol : relation.symbols) {
      tied = tied && given[symbol];
      members.emplace_back(keys[symbol]);
    }
    if (tied)
      throw InputError(fmt::format("{}: {} are not independent, because {}; {}; replace one of them by one of: {}",
                                   where, listed(members), relation.equation, so_far, listed(names(deduced, false))));
  }
  const std::size_t missing = independent > present.size() ? independent - present.size() : 1;
  throw InputError(fmt::format(
      "{}: the trilinear law takes exactly {} independent quantities, {} {} missing; {}; missing: {} of {}", where,
      independent, missing, missing == 1 ? "is" : "are", so_far, missing, listed(names(deduced, false))));
}

void check_order(const std::string& where, const Known& given, const Trilinear::Shape& shape) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: no trilinear law has these values together: {}; given: {}", where, why,
                                 listed(names(given, true))));
  };
  const auto check_positive = [&](const char* key, double value, const char* unit) {
    if (!(value > 0.0)) refuse(fmt::format("{} would be {:.6g} {}, not positive", key, value, unit));
  };
  const auto check_below = [&](const char* low, double low_value, const char* high, double high_value,
                               const char* unit) {
    if (!(low_value < high_value))
      refuse(fmt::format("{} = {:.6g} {} must be below {} = {:.6g} {}", low, low_value, unit, high, high_value, unit));
  };
  check_positive("bridging_stress", shape.bridging_stress, "MPa");
  check_positive("strength", shape.strength, "MPa");
  check_positive("peak_opening", shape.peak_opening, "mm");
  check_positive("knee_opening", shape.knee_opening, "mm");
  check_positive("critical_opening", shape.critical_opening, "mm");
  check_below("peak_opening", shape.peak_opening, "knee_opening", shape.knee_opening, "mm");
  check_below("knee_opening", shape.knee_opening, "critical_opening", shape.critical_opening, "mm");
  check_below("bridging_stress", shape.bridging_stress, "strength", shape.strength, "MPa");
}

}  // namespace

Trilinear::Shape Trilinear::complete(const Values& values) {
  Known given;
  std::string where = values.where("law");
  for (std::size_t i = symbol_count; i-- > 0;)
    if (values.has(keys[i])) {
      given[i] = values.number(keys[i]);
      where = values.where(keys[i]);
    }
  Known known = given;
  deduce(known);
  const auto complete = names(known, false).empty();
  if (names(given, true).size() != independent || !complete) refuse_choice(where, given, known);
  const Shape shape{.strength = *known[laws::strength],
                    .peak_opening = *known[laws::peak_opening],
                    .bridging_stress = *known[laws::bridging_stress],
                    .knee_opening = *known[laws::knee_opening],
                    .critical_opening = *known[laws::critical_opening]};
  check_order(where, given, shape);
  return shape;
}

TractionLawKind trilinear() {
  return {
      .name = "trilinear",
      .meaning =
          "initiation and bridging: up to the strength, down to the bridging stress, down to zero; give any five "
          "independent ones of its quantities",
      .parameters =
          {number("strength", "MPa", 1e-4, 1e5, "largest cohesive traction sigma_c").if_given(),
           number("peak_opening", "mm", 1e-9, 1e2, "opening delta_1 at the strength").if_given(),
           number("bridging_stress", "MPa", 1e-6, 1e5, "traction sigma_b at which bridging sets in").if_given(),
           number("knee_opening", "mm", 1e-9, 1e2, "opening delta_2 at the bridging stress").if_given(),
           number("critical_opening", "mm", 1e-9, 1e3, "opening delta_c from which nothing is carried").if_given(),
           number("initiation_toughness", "J/m^2", 1e-3, 1e7, "G_init = (sigma_c delta_2 - sigma_b delta_1)/2")
               .if_given(),
           number("bridging_toughness", "J/m^2", 1e-3, 1e7, "G_b = sigma_b delta_c/2").if_given(),
           number("toughness", "J/m^2", 1e-3, 1e7, "whole area G = G_init + G_b").if_given(),
           number("peak", "1", 1e-3, 0.999,
                  "delta_1/delta_2; shifts the cutting force by several percent, so it has no default (0.1 is usual)")
               .if_given()},
      .make = [](const Values& values) -> std::unique_ptr<TractionLaw> {
        return std::make_unique<Trilinear>(Trilinear::complete(values));
      }};
}

}  // namespace kerf::laws
