#include "inverse/convergence.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <set>

#include "models/chip/least_squares.hpp"

namespace kerf::inverse {
namespace {

constexpr double least_order = 0.25, largest_order = 8;
constexpr double significant = 0.05;
constexpr double normal_95 = 1.959963984540054;

struct PowerLaw {
  std::vector<ForceAtCell> forces;  ///< cells in shares of the largest
  bool weighted;

  double error(const ForceAtCell& at) const { return weighted ? at.force.standard_error : 1.0; }

  template <class T>
  bool operator()(const T* unknowns, T* residuals) const {
    using std::pow;
    for (const ForceAtCell& at : forces)
      *residuals++ = (unknowns[0] + unknowns[1] * pow(T(at.cell), unknowns[2]) - at.force.value) / error(at);
    return true;
  }
};

double chance_above(double chi2, int freedom) {
  return boost::math::cdf(complement(boost::math::chi_squared(freedom), chi2));
}

struct Mean {
  Estimate mean;
  double chi2 = 0;
};

Mean weighted_mean(const PowerLaw& law) {
  double weights = 0, sum = 0;
  for (const ForceAtCell& at : law.forces) {
    const double weight = std::pow(law.error(at), -2);
    weights += weight;
    sum += weight * at.force.value;
  }
  Mean mean{.mean = {sum / weights, 1 / std::sqrt(weights)}};
  for (const ForceAtCell& at : law.forces) mean.chi2 += std::pow((at.force.value - mean.mean.value) / law.error(at), 2);
  return mean;
}

chip::Fit fit(const PowerLaw& law, bool errors_count) {
  const auto by_cell = [](const ForceAtCell& a, const ForceAtCell& b) { return a.cell < b.cell; };
  const auto [fine, coarse] = std::minmax_element(law.forces.begin(), law.forces.end(), by_cell);
  std::vector<std::vector<double>> starts;
  for (const double order : {1.0, 2.0, 4.0}) {
    const double amplitude = (coarse->force.value - fine->force.value) / (1 - std::pow(fine->cell, order));
    starts.push_back({coarse->force.value - amplitude, amplitude, order});
  }
  return chip::solve({.unknowns = {{.name = "limit", .unit = "N/m", .positive = false},
                                   {.name = "amplitude", .unit = "N/m", .positive = false},
                                   {.name = "order", .unit = "1", .lower = least_order, .upper = largest_order}},
                      .residuals = chip::residual_block<3>(law, static_cast<int>(law.forces.size())),
                      .starts = starts,
                      .noise = {.measured = errors_count, .freedom = std::numeric_limits<double>::infinity()}});
}

/// Standard errors of limit and order from the slopes at the fit.
std::pair<double, double> linearised_errors(const PowerLaw& law, const std::vector<double>& at) {
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(law.forces.size()), 3);
  for (Eigen::Index i = 0; i < slopes.rows(); ++i) {
    const ForceAtCell& force = law.forces[static_cast<std::size_t>(i)];
    const double power = std::pow(force.cell, at[2]);
    slopes.row(i) << 1, power, at[1] * power * std::log(force.cell);
    slopes.row(i) /= law.error(force);
  }
  const Eigen::MatrixXd covariance = (slopes.transpose() * slopes).inverse();
  return {std::sqrt(covariance(0, 0)), std::sqrt(covariance(2, 2))};
}

}  // namespace

Convergence convergence(const std::vector<ForceAtCell>& forces) {
  Convergence result;
  std::set<double> cells;
  for (const ForceAtCell& at : forces) cells.insert(at.cell);
  if (cells.size() < 3) {
    result.not_resolved =
        fmt::format("{} accepted cell size{}: at least three are needed", cells.size(), cells.size() == 1 ? "" : "s");
    return result;
  }
  PowerLaw law{.forces = forces, .weighted = true};
  for (ForceAtCell& at : law.forces) {
    at.cell /= *cells.rbegin();
    law.weighted = law.weighted && std::isfinite(at.force.standard_error) && at.force.standard_error > 0;
  }
  const int count = static_cast<int>(forces.size());
  result.freedom = count - 3;

  const Mean mean = weighted_mean(law);
  const double chance = law.weighted ? chance_above(mean.chi2, count - 1) : 0;
  if (chance > significant) {
    result.limit = mean.mean;
    result.limit_lower = mean.mean.value - normal_95 * mean.mean.standard_error;
    result.limit_upper = mean.mean.value + normal_95 * mean.mean.standard_error;
    result.scatter = std::sqrt(mean.chi2 / (count - 1));
    result.not_resolved = fmt::format(
        "the forces of all cell sizes agree within their standard errors (chance {:.0f} %); their mean stands for the "
        "limit",
        100 * chance);
    return result;
  }

  chip::Fit found = fit(law, law.weighted);
  if (!found.converged) {
    result.not_resolved = "no power law of the cell size fits the forces";
    return result;
  }
  // What the cell size does beside a power law counts as noise.
  if (found.rejected()) found = fit(law, false);
  const auto [limit_error, order_error] = linearised_errors(law, found.values);
  if (result.freedom > 0) result.scatter = std::sqrt(found.chi2 / result.freedom);
  const double widened = law.weighted ? std::max(1.0, result.scatter) : result.scatter;
  result.limit = {found.values[0], widened * limit_error};
  result.amplitude = found.values[1];
  result.order = {found.values[2], widened * order_error};
  if (result.freedom > 0) {
    result.limit_lower = found.find("limit")->lower;
    result.limit_upper = found.find("limit")->upper;
    result.order_lower = found.find("order")->lower;
    result.order_upper = found.find("order")->upper;
  } else if (law.weighted) {
    result.limit_lower = result.limit.value - normal_95 * limit_error;
    result.limit_upper = result.limit.value + normal_95 * limit_error;
    result.order_lower = result.order.value - normal_95 * order_error;
    result.order_upper = result.order.value + normal_95 * order_error;
  } else {
    result.not_resolved = "three forces without errors fix the three unknowns, and nothing tells how well";
    return result;
  }
  const bool bounded = result.order_lower > least_order && result.order_upper < largest_order &&
                       std::isfinite(result.limit_lower) && std::isfinite(result.limit_upper);
  if (!bounded)
    result.not_resolved = fmt::format("the order has no bounds within {:g} ... {:g}: {}", least_order, largest_order,
                                      result.scatter > 2 ? "the forces do not follow a power law of the cell size"
                                                         : "the forces are too few or too noisy");
  return result;
}

}  // namespace kerf::inverse
