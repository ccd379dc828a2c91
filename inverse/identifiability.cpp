#include "inverse/identifiability.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace kerf::inverse {
namespace {

constexpr double normal_quantile = 1.959963984540054;  // 97.5 %
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unseen = 1e-9;  // singular values this far below the largest are rounding

/// Weighted residuals with F_b held, where projecting it out would hide its column.
Eigen::VectorXd residuals_at(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                             const Eigen::VectorXd& point, double edge_force) {
  const CutMask known = model.known();
  const Observations simulated = model.predict(point);
  const Observations& weights = misfit.weights();
  Eigen::VectorXd residuals = Eigen::VectorXd::Zero(weights.size());
  for (Eigen::Index i = 0; i < weights.rows(); ++i)
    for (Eigen::Index k = 0; k < weights.cols() && known[static_cast<std::size_t>(i)]; ++k)
      residuals[i * weights.cols() + k] =
          weights(i, k) == 0
              ? 0
              : weights(i, k) * (simulated(i, k) - misfit.measured()(i, k) +
                                 edge_force * misfit.edge_share(static_cast<Observable>(k), space.friction(point)));
  return residuals;
}

/// Everything about the estimate that intervals need.
struct Estimator {
  const LocalModel& model;
  const Misfit& misfit;
  const ParameterSpace& space;
  Eigen::VectorXd point;
  double edge_force;
  double chi2;

  /// Columns: d residual / d search coordinate, then d residual / d F_b.
  Eigen::MatrixXd jacobian() const {
    const double tiny = 1e-5;
    const Eigen::Index n = point.size();
    Eigen::MatrixXd columns(misfit.weights().size(), n + (misfit.edge_force() ? 1 : 0));
    for (Eigen::Index j = 0; j < n; ++j) {
      Eigen::VectorXd above = point, below = point;
      above[j] += tiny;
      below[j] -= tiny;
      columns.col(j) = (residuals_at(model, misfit, space, above, edge_force) -
                        residuals_at(model, misfit, space, below, edge_force)) /
                       (2 * tiny);
    }
    if (misfit.edge_force())
      columns.col(n) = residuals_at(model, misfit, space, point, edge_force + 1) -
                       residuals_at(model, misfit, space, point, edge_force);
    return columns;
  }

  /// Rise of the least chi^2 when parameter `j` (F_b is the last) is held at a coordinate.
  double rise(Eigen::Index j, double coordinate) const {
    Eigen::VectorXd start = point;
    if (j < point.size()) {
      start[j] = coordinate;
      return minimise(model, misfit, space, start, space.lower(), space.upper(), j).chi2 - chi2;
    }
    return minimise(model, misfit, space, start, space.lower(), space.upper(), {}, coordinate).chi2 - chi2;
  }

  /// Where the rise reaches `allowed` between the estimate and a bound; the bound itself when it never does.
  double limit(Eigen::Index j, double estimate, double bound, double allowed) const {
    if (rise(j, bound) <= allowed) return bound;
    double inside = estimate, outside = bound;
    for (int i = 0; i < 40 && std::abs(outside - inside) > 1e-6 * std::abs(bound - estimate); ++i) {
      const double middle = 0.5 * (inside + outside);
      (rise(j, middle) <= allowed ? inside : outside) = middle;
    }
    return 0.5 * (inside + outside);
  }
};

bool nearly(double a, double b, double width) {
  return std::abs(a - b) <= 1e-6 * width;
}

}  // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::measured:
      return "measured";
    case Verdict::bounded:
      return "bounded above and below";
    case Verdict::bounded_above:
      return "bounded above";
    case Verdict::bounded_below:
      return "bounded below";
    case Verdict::not_measurable:
      break;
  }
  return "not measurable with these cuts";
}

const ParameterEstimate* Identifiability::find(const std::string& wanted) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const ParameterEstimate& parameter) { return parameter.name == wanted; });
  return found == parameters.end() ? nullptr : &*found;
}

Verdict judge(double value, double standard_error, const Interval& interval, const Interval& bounds) {
  const double width = bounds.upper - bounds.lower;
  const bool open_below = interval.lower <= bounds.lower || nearly(interval.lower, bounds.lower, width);
  const bool open_above = interval.upper >= bounds.upper || nearly(interval.upper, bounds.upper, width);
  if (open_below && open_above) return Verdict::not_measurable;
  if (open_below) return Verdict::bounded_above;
  if (open_above) return Verdict::bounded_below;
  const double half_width = 0.5 * (interval.upper - interval.lower) / normal_quantile;
  return std::max(standard_error, half_width) <= std::abs(value) / 3.0 ? Verdict::measured : Verdict::bounded;
}

Identifiability identify(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space) {
  const Residuals here = misfit.residuals(model.base().simulated, model.base().point, model.known());
  const Estimator estimator{model, misfit, space, model.base().point, here.edge_force, here.chi2};
  const Eigen::Index n = space.dimension(), all = n + (misfit.edge_force() ? 1 : 0);

  Identifiability result;
  result.chi2 = here.chi2;
  result.degrees_of_freedom = here.compared - static_cast<int>(all);
  if (result.degrees_of_freedom > 0 && here.chi2 > result.degrees_of_freedom) {
    result.error_scale = std::sqrt(here.chi2 / result.degrees_of_freedom);
    result.quantile = boost::math::quantile(boost::math::students_t(result.degrees_of_freedom), 0.975);
  } else {
    result.quantile = normal_quantile;
  }

  // One unit for every column, its logarithm, so that singular values compare. An edge force of zero has none: the
  // largest measured F_t stands in.
  Eigen::MatrixXd jacobian = estimator.jacobian();
  Eigen::VectorXd unit(all);  // d(coordinate or F_b) / d ln(parameter)
  for (Eigen::Index j = 0; j < n; ++j) {
    const double value = space.value(j, estimator.point[j]);
    unit[j] = std::max(std::abs(value), 1e-12) / space.slope(j, estimator.point[j]);
  }
  if (all > n) {
    const double typical = misfit.measured().col(static_cast<Eigen::Index>(Observable::F_t)).cwiseAbs().maxCoeff();
    unit[n] = here.edge_force != 0 ? std::abs(here.edge_force) : std::max(typical, 1e-12);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian * unit.asDiagonal(), Eigen::ComputeThinU | Eigen::ComputeFullV);
  result.singular_values = Eigen::VectorXd::Zero(all);
  result.singular_values.head(svd.singularValues().size()) = svd.singularValues();
  result.singular_vectors = svd.matrixV();

  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(all, all);
  std::vector<bool> seen(static_cast<std::size_t>(all), true);
  for (Eigen::Index c = 0; c < all; ++c) {
    const Eigen::VectorXd vector = result.singular_vectors.col(c);
    if (result.singular_values[c] > unseen * result.singular_values[0]) {
      covariance += vector * vector.transpose() / (result.singular_values[c] * result.singular_values[c]);
      continue;
    }
    for (Eigen::Index j = 0; j < all; ++j)
      if (std::abs(vector[j]) > 1e-6) seen[static_cast<std::size_t>(j)] = false;
  }
  result.correlation.resize(all, all);
  for (Eigen::Index a = 0; a < all; ++a)
    for (Eigen::Index b = 0; b < all; ++b)
      result.correlation(a, b) = seen[static_cast<std::size_t>(a)] && seen[static_cast<std::size_t>(b)]
                                     ? covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b))
                                     : std::numeric_limits<double>::quiet_NaN();

  const double allowed = std::pow(result.quantile * result.error_scale, 2);
  for (Eigen::Index j = 0; j < all; ++j) {
    ParameterEstimate estimate;
    const bool is_edge = j == n;
    if (is_edge) {
      estimate = {
          .name = "edge_force", .path = "edge_force", .unit = "N/mm", .key = false, .interval = {}, .bounds = {}};
      estimate.value = here.edge_force;
      estimate.bounds = {misfit.edge_force()->lower, misfit.edge_force()->upper};
    } else {
      const FreeParameter& parameter = space.parameters()[static_cast<std::size_t>(j)];
      estimate = {.name = parameter.name,
                  .path = parameter.path,
                  .unit = parameter.unit,
                  .key = parameter.key,
                  .interval = {},
                  .bounds = {}};
      estimate.value = std::clamp(space.value(j, estimator.point[j]), parameter.lower, parameter.upper);
      estimate.bounds = {parameter.lower, parameter.upper};
    }
    const double slope = is_edge ? 1 : space.slope(j, estimator.point[j]);
    estimate.standard_error = seen[static_cast<std::size_t>(j)]
                                  ? std::sqrt(covariance(j, j)) * unit[j] * slope * result.error_scale
                                  : infinity;
    const double centre = is_edge ? here.edge_force : estimator.point[j];
    const double lower = estimator.limit(j, centre, is_edge ? estimate.bounds.lower : space.lower()[j], allowed);
    const double upper = estimator.limit(j, centre, is_edge ? estimate.bounds.upper : space.upper()[j], allowed);
    estimate.interval = is_edge ? Interval{lower, upper} : Interval{space.value(j, lower), space.value(j, upper)};
    estimate.verdict = judge(estimate.value, estimate.standard_error, estimate.interval, estimate.bounds);
    result.parameters.push_back(std::move(estimate));
  }
  return result;
}

}  // namespace kerf::inverse
