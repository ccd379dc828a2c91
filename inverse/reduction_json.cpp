#include "inverse/reduction_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "models/base/units.hpp"

namespace kerf::inverse {

namespace {

using nlohmann::ordered_json;

constexpr double newton_per_metre = 1e-3;  // in N/mm
constexpr double degree = std::numbers::pi / 180.0;

ordered_json finite(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json optional(const std::optional<double>& value) {
  return value ? finite(*value) : ordered_json(nullptr);
}

ordered_json estimate(const Estimate& estimate, const std::string& unit) {
  const double scale = consistent_units_in(unit);
  ordered_json json;
  json["value"] = finite(estimate.value / scale);
  json["se"] = finite(estimate.standard_error / scale);
  json["unit"] = unit;
  return json;
}

/// Columns, so that a plot can take them as they are.
ordered_json forces_json(const std::vector<chip::FittedForces>& cuts) {
  ordered_json depth = ordered_json::array();
  ordered_json rake = ordered_json::array();
  ordered_json F_c = ordered_json::array();
  ordered_json F_t = ordered_json::array();
  bool transverse = false;
  for (const auto& cut : cuts) {
    depth.push_back(cut.depth);
    rake.push_back(cut.rake / degree);
    F_c.push_back(finite(cut.F_c / newton_per_metre));
    F_t.push_back(cut.F_t ? finite(*cut.F_t / newton_per_metre) : ordered_json(nullptr));
    transverse = transverse || cut.F_t.has_value();
  }
  ordered_json json;
  json["depth_mm"] = std::move(depth);
  json["rake_deg"] = std::move(rake);
  json["F_c_N_per_m"] = std::move(F_c);
  if (transverse) json["F_t_N_per_m"] = std::move(F_t);
  return json;
}

ordered_json correlation_json(const Eigen::MatrixXd& correlation) {
  ordered_json rows = ordered_json::array();
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < correlation.cols(); ++j) row.push_back(finite(correlation(i, j)));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string status_of(const chip::MethodResult& result) {
  const auto& fit = result.fit;
  if (!fit.converged) return "not converged";
  if (!fit.determined()) return "not determined";
  if (!result.out_of_range.empty()) return "out of range";
  return fit.rejected() ? "rejected" : fit.p_value ? "accepted" : "not tested";
}

ordered_json method_json(const chip::MethodResult& result) {
  ordered_json json;
  json["meaning"] = result.meaning;
  if (!result.not_applied.empty()) {
    json["parameters"] = ordered_json::object();
    json["verdict"] = {{"fit", "not applied"}, {"statement", result.not_applied}};
    return json;
  }
  const auto& fit = result.fit;
  json["parameters"] = ordered_json::object();
  ordered_json verdict;
  verdict["fit"] = status_of(result);
  verdict["statement"] = verdict_of(result);
  for (const auto& parameter : fit.parameters) {
    json["parameters"][parameter.name] = to_json(result, parameter);
    verdict[parameter.name] = verdict_of(result, parameter);
  }
  json["verdict"] = std::move(verdict);
  json["correlation"] = correlation_json(fit.correlation);
  json["singular_values"] = fit.singular_values;
  json["chi2"] = finite(fit.chi2);
  json["degrees_of_freedom"] = fit.freedom;
  json["p_value"] = optional(fit.p_value);
  json["aicc"] = optional(fit.aicc);
  json["data"] = fit.data;
  json["errors"] = fit.noise.measured ? "measured" : "from the scatter about the fit";
  json["fitted"] = forces_json(result.points);
  json["curve"] = forces_json(result.curve);
  return json;
}

ordered_json line_json(const chip::FrictionLine& line) {
  ordered_json json;
  json["rake"] = {{"value", line.rake / degree}, {"unit", "deg"}};
  json["points"] = line.points;
  json["slope"] = estimate(line.slope, "1");
  json["friction"] = estimate(line.friction, "1");
  json["intercept"] = estimate(line.intercept, "N/mm");
  json["scatter"] = {{"value", line.scatter}, {"unit", "N/mm"}};
  json["chi2"] = optional(line.chi2);
  json["outliers"] = ordered_json::array();
  for (const auto& outlier : line.outliers) {
    ordered_json entry;
    entry["line"] = outlier.line;
    entry["depth"] = {{"value", outlier.depth}, {"unit", "mm"}};
    entry["studentized_residual"] = outlier.studentized;
    json["outliers"].push_back(std::move(entry));
  }
  return json;
}

ordered_json measured_json(const chip::Measurements& measurements) {
  std::vector<chip::FittedForces> forces;
  for (const auto& cut : measurements.cuts()) forces.push_back({cut.depth, cut.rake, cut.F_c, cut.F_t});
  ordered_json json = forces_json(forces);
  ordered_json F_c_error = ordered_json::array();
  ordered_json F_t_error = ordered_json::array();
  ordered_json line = ordered_json::array();
  const auto error = [](const std::optional<double>& value) {
    return value ? finite(*value / newton_per_metre) : ordered_json(nullptr);
  };
  for (const auto& cut : measurements.cuts()) {
    F_c_error.push_back(error(cut.F_c_error));
    F_t_error.push_back(error(cut.F_t_error));
    line.push_back(cut.line);
  }
  json["F_c_se_N_per_m"] = std::move(F_c_error);
  json["F_t_se_N_per_m"] = std::move(F_t_error);
  json["line"] = std::move(line);
  return json;
}

}  // namespace

std::string verdict_of(const chip::MethodResult& result, const chip::FittedParameter& parameter) {
  std::string words = in_words(parameter.verdict);
  if (result.fit.rejected()) return words + ", by a rejected model";
  if (!result.out_of_range.empty()) return words + ", by a model out of its range";
  return words;
}

std::string verdict_of(const chip::MethodResult& result) {
  const auto& fit = result.fit;
  const int parameters = fit.data - fit.freedom;
  if (!fit.converged) return "no minimum was found";
  if (!fit.determined()) {
    return fmt::format("not determined: {} forces for {} parameters; measure at more depths", fit.data, parameters);
  }
  if (!result.out_of_range.empty()) return "out of range: " + result.out_of_range;
  if (!fit.p_value) {
    return fmt::format("not tested: without measured errors the scatter of {:.3g} N/mm about the fit is all there is",
                       fit.scatter);
  }
  return fmt::format("{}: chi2 = {:.3g} on {} degrees of freedom, p = {:.2g}", fit.rejected() ? "rejected" : "accepted",
                     fit.chi2, fit.freedom, *fit.p_value);
}

ordered_json to_json(const chip::MethodResult& result, const chip::FittedParameter& parameter) {
  const double scale = consistent_units_in(parameter.unit);
  ordered_json json;
  json["value"] = finite(parameter.value / scale);
  json["se"] = finite(parameter.standard_error / scale);
  json["interval"] = ordered_json::array({finite(parameter.lower / scale), finite(parameter.upper / scale)});
  json["unit"] = parameter.unit;
  json["verdict"] = verdict_of(result, parameter);
  return json;
}

ordered_json to_json(const chip::Reduction& reduction, const chip::Measurements& measurements) {
  ordered_json json;
  json["methods"] = ordered_json::object();
  for (const auto& result : reduction.methods) json["methods"][result.method] = method_json(result);
  json["friction_lines"] = ordered_json::array();
  const chip::FrictionLine* largest = nullptr;
  for (const auto& line : reduction.friction_lines) {
    json["friction_lines"].push_back(line_json(line));
    if (!largest || line.points > largest->points) largest = &line;
  }
  json["friction_line"] = largest ? line_json(*largest) : ordered_json(nullptr);
  json["measured"] = measured_json(measurements);
  json["warnings"] = reduction.warnings;
  return json;
}

}  // namespace kerf::inverse
