#include "models/chip/reduction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "models/chip/chip_shape.hpp"
#include "models/chip/plastic_bending.hpp"

namespace kerf::chip {

namespace {

constexpr double joule_per_square_metre = 1e-3;  // in N/mm
constexpr double degree = std::numbers::pi / 180.0;

void warn_about_data(const Measurements& data, std::vector<std::string>& warnings) {
  if (!data.errors_known()) {
    warnings.push_back(
        "not every force has a standard deviation above zero: all forces weigh the same, and the scatter about each "
        "fit "
        "sets its errors");
  }
  int repeats = data.cuts().front().repeats;
  for (const auto& cut : data.cuts()) repeats = std::min(repeats, cut.repeats);
  constexpr int enough_repeats = 6;
  if (data.errors_known() && repeats > 1 && repeats < enough_repeats) {
    warnings.push_back(
        fmt::format("standard deviations from {} repeats are themselves known to {:.0f} % only: weights made of them "
                    "give intervals "
                    "that are too narrow and reject too often, the more so the more depths there are",
                    repeats, 100.0 / std::sqrt(2.0 * (repeats - 1))));
  }
  double radius = 0.0;
  for (const auto& cut : data.cuts()) radius = std::max(radius, cut.tool_radius.value_or(0.0));
  if (radius > 0.1 * data.depths().front()) {
    warnings.push_back(
        fmt::format("the tool's radius of {:.3g} mm is not small against the least depth of {:.3g} mm: part of the "
                    "force ploughs, and "
                    "a force at zero depth is no clean toughness",
                    radius, data.depths().front()));
  }
  if (data.depths().size() < 3) {
    warnings.push_back(fmt::format("{} different depth{} of cut: an extrapolation to zero depth cannot be checked",
                                   data.depths().size(), data.depths().size() == 1 ? "" : "s"));
  } else if (data.depths().back() < 3.0 * data.depths().front()) {
    warnings.push_back(
        fmt::format("the depths span only a factor {:.2g}: toughness and yield stress are strongly correlated",
                    data.depths().back() / data.depths().front()));
  }
}

void warn_about_friction(const std::vector<FrictionLine>& lines, std::vector<std::string>& warnings) {
  for (const auto& line : lines) {
    for (const auto& outlier : line.outliers) {
      warnings.push_back(fmt::format(
          "line {}, depth {:.4g} mm, lies off the friction line by {:.1f} standard errors (rake {:.3g} deg)",
          outlier.line, outlier.depth, outlier.studentized, line.rake / degree));
    }
    if (line.intercept.value > 2.0 * line.intercept.standard_error && line.intercept.standard_error > 0.0) {
      warnings.push_back(
          fmt::format("at zero cutting force {:.3g} +- {:.2g} N/mm of transverse force remain (rake {:.3g} deg): "
                      "adhesion, or a force "
                      "on the tool's edge and bottom; forces alone do not tell which",
                      line.intercept.value, line.intercept.standard_error, line.rake / degree));
    }
  }
}

void warn_about_fits(const std::vector<MethodResult>& methods, std::vector<std::string>& warnings) {
  for (const auto& result : methods) {
    if (!result.not_applied.empty()) continue;
    for (const auto& warning : result.warnings) warnings.push_back(result.method + ": " + warning);
    if (!result.out_of_range.empty()) warnings.push_back(result.method + ": out of range, " + result.out_of_range);
    if (!result.fit.converged) {
      warnings.push_back(result.method + ": the fit found no minimum");
    } else if (!result.fit.determined()) {
      warnings.push_back(fmt::format("{}: {} forces for {} parameters leave nothing to judge them by", result.method,
                                     result.fit.data, result.fit.data - result.fit.freedom));
    } else if (result.fit.rejected()) {
      warnings.push_back(
          fmt::format("{}: rejected, chi2 = {:.3g} on {} degrees of freedom (p = {:.2g}): its intervals do not count",
                      result.method, result.fit.chi2, result.fit.freedom, *result.fit.p_value));
    }
  }
}

/// Among all ways to a toughness that have a standard error and are not rejected, the lowest and the highest.
void warn_about_disagreement(const std::vector<MethodResult>& methods, const std::string& prefix,
                             const std::string& what, std::vector<std::string>& warnings) {
  const FittedParameter* lowest = nullptr;
  const FittedParameter* highest = nullptr;
  std::string low_name;
  std::string high_name;
  for (const auto& result : methods) {
    if (!result.method.starts_with(prefix) || !result.out_of_range.empty() || result.fit.rejected()) continue;
    const auto* toughness = result.fit.find("toughness");
    if (!toughness || !std::isfinite(toughness->standard_error)) continue;
    if (!lowest || toughness->value < lowest->value) {
      lowest = toughness;
      low_name = result.method;
    }
    if (!highest || toughness->value > highest->value) {
      highest = toughness;
      high_name = result.method;
    }
  }
  if (!lowest || lowest == highest) return;
  const double combined = std::hypot(lowest->standard_error, highest->standard_error);
  if (highest->value - lowest->value <= combined) return;
  warnings.push_back(fmt::format(
      "{} disagree about the toughness: {} says {:.4g} +- {:.2g} J/m^2, {} {:.4g} +- {:.2g}; the differences between "
      "them, not their errors, are the uncertainty",
      what, low_name, lowest->value / joule_per_square_metre, lowest->standard_error / joule_per_square_metre,
      high_name, highest->value / joule_per_square_metre, highest->standard_error / joule_per_square_metre));
}

/// Does a chip of the fitted material bend clear of the tool's tip? Then Eq. (4) is about another chip.
void warn_about_branch(const Measurements& data, const FitOptions& options, const std::vector<MethodResult>& methods,
                       std::vector<std::string>& warnings) {
  const auto shear = std::find_if(methods.begin(), methods.end(), [](const MethodResult& result) {
    return result.method == "shear_minimised" && result.fit.converged && result.fit.values.size() > 2;
  });
  if (!options.elastic_modulus || shear == methods.end()) return;
  const auto& values = shear->fit.values;
  for (const auto& cut : data.cuts()) {
    const BendingChip<double> chip{
        .depth = cut.depth,
        .rake = cut.rake,
        .yield_stress = values[1] * plane_yield_stress_factor(options.plane_strain),
        .toughness = values[0],
        .friction = std::max(values[2], 0.0),
        .modulus = plane_modulus(*options.elastic_modulus, options.poisson_ratio, options.plane_strain),
        .hardening = options.hardening_ratio,
        .root_rotation = options.root_rotation};
    if (chip.toughness <= 0.0 || chip.projection(chip.turn()) <= 0.0) return;
    const auto k = root_curvature(chip);
    if (!k || !out_of_bending_range(chip, *k).empty()) continue;
    const auto shape = chip_shape(chip, *k);
    if (shape.touching) continue;
    warnings.push_back(fmt::format(
        "line {}, depth {:.4g} mm: with the toughness and yield stress of shear_minimised the chip would bend clear of "
        "the tool's tip by {:.3g} mm; use plastic_bending there",
        cut.line, cut.depth, shape.tip_gap));
  }
}

}  // namespace

const MethodResult* Reduction::find(std::string_view method) const {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const MethodResult& result) { return result.method == method; });
  return found == methods.end() ? nullptr : &*found;
}

Reduction reduce(const Measurements& measurements, const std::vector<std::string>& methods, const FitOptions& options) {
  Reduction reduction;
  for (const auto& method : fit_methods()) {
    const bool wanted = methods.empty() || std::find(methods.begin(), methods.end(), method.name) != methods.end();
    if (wanted) reduction.methods.push_back(apply(method, measurements, options));
  }
  reduction.friction_lines = friction_lines(measurements);

  warn_about_data(measurements, reduction.warnings);
  warn_about_friction(reduction.friction_lines, reduction.warnings);
  warn_about_fits(reduction.methods, reduction.warnings);
  warn_about_disagreement(reduction.methods, "intercept_", "the intercepts", reduction.warnings);
  warn_about_disagreement(reduction.methods, "shear_minimised_edge", "the assumptions about the edge force",
                          reduction.warnings);
  warn_about_branch(measurements, options, reduction.methods, reduction.warnings);
  return reduction;
}

}  // namespace kerf::chip
