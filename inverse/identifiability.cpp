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
constexpr double barely_seen = 1e-5;
constexpr double unseen = 1e-9;  // singular values this far below the largest are rounding

/// Everything about the estimate that intervals need.
struct Estimator {
  const LocalModel& model;
  const Misfit& misfit;
  const ParameterSpace& space;
  Eigen::VectorXd point;
  double edge_force;
  double chi2;

  ModelMinimum with(const Restriction& restriction, const Eigen::VectorXd& start) const {
    return minimise(model, misfit, space, start, space.lower(), space.upper(), restriction);
  }

  /// The least chi^2 with parameter `j` (F_b is the last) held at a coordinate, or with a derived quantity at a value.
  ModelMinimum held(Eigen::Index j, double coordinate) const {
    Eigen::VectorXd start = point;
    if (j == point.size()) return with({.fixed_edge = coordinate}, start);
    start[j] = coordinate;
    return with({.fixed = j}, start);
  }
  ModelMinimum held(const DerivedQuantity& quantity, double value) const {
    return with({.held = &quantity, .held_value = value}, point);
  }
};

/// Where the rise of chi^2 reaches `allowed` between the estimate and a bound; the bound itself when it never does.
/// `at` holds what is profiled at a coordinate.
struct Limit {
  double coordinate = 0;
  std::optional<ProfileEnd> end;
};

template <class At>
Limit find_limit(const At& at, double chi2, double estimate, double bound, double allowed) {
  if (at(bound).chi2 - chi2 <= allowed) return {.coordinate = bound, .end = {}};
  double inside = estimate, outside = bound;
  for (int i = 0; i < 40 && std::abs(outside - inside) > 1e-6 * std::abs(bound - estimate); ++i) {
    const double middle = 0.5 * (inside + outside);
    (at(middle).chi2 - chi2 <= allowed ? inside : outside) = middle;
  }
  const double coordinate = 0.5 * (inside + outside);
  const ModelMinimum there = at(coordinate);
  return {.coordinate = coordinate, .end = ProfileEnd{.point = there.point, .predicted = there.chi2, .simulated = {}}};
}

/// Least and largest value of a derived quantity within the bounds of the search.
Interval range_of(const DerivedQuantity& quantity, const std::vector<FreeParameter>& free) {
  Interval range;
  for (const DerivedQuantity::Term& term : quantity.terms) {
    double low = 1, high = 1;
    for (std::size_t j = 0; j < free.size(); ++j) {
      if (term.powers[j] == 0) continue;
      const double a = std::pow(free[j].lower, term.powers[j]), b = std::pow(free[j].upper, term.powers[j]);
      low *= std::min(a, b);
      high *= std::max(a, b);
    }
    range.lower += term.factor * (term.factor > 0 ? low : high);
    range.upper += term.factor * (term.factor > 0 ? high : low);
  }
  return range;
}

/// d quantity / d ln(parameter), F_b last.
Eigen::VectorXd logarithmic_slope(const DerivedQuantity& quantity, const Eigen::VectorXd& values, Eigen::Index all) {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(all);
  for (const DerivedQuantity::Term& term : quantity.terms) {
    double product = term.factor;
    for (Eigen::Index j = 0; j < values.size(); ++j)
      product *= std::pow(values[j], term.powers[static_cast<std::size_t>(j)]);
    for (Eigen::Index j = 0; j < values.size(); ++j) slope[j] += product * term.powers[static_cast<std::size_t>(j)];
  }
  return slope;
}

/// The partner that moves most strictly with parameter `j` along the data's blind direction: of all p q^a the one
/// with a = -C_jk / C_kk is known best, C being the covariance of the logarithms.
std::optional<TradeOff> trade_off(Eigen::Index j, const Eigen::MatrixXd& covariance,
                                  const std::vector<ParameterEstimate>& parameters) {
  std::optional<TradeOff> best;
  double strictest = 0.9;  // correlation below which one partner explains little
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) {
    if (k == j) continue;
    const double correlation = covariance(j, k) / std::sqrt(covariance(j, j) * covariance(k, k));
    if (!(std::abs(correlation) > strictest)) continue;
    strictest = std::abs(correlation);
    const double a = -covariance(j, k) / covariance(k, k);  // leaves the least variance
    best = TradeOff{.partner = parameters[static_cast<std::size_t>(k)].name,
                    .exponent = a,
                    .relative_error = std::sqrt(std::max(0.0, covariance(j, j) + a * covariance(j, k)))};
  }
  return best;
}

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
  for (const std::vector<ParameterEstimate>* all : {&parameters, &derived})
    for (const ParameterEstimate& estimate : *all)
      if (estimate.name == wanted) return &estimate;
  return nullptr;
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

Identifiability identify(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                         const std::vector<DerivedQuantity>& derived, const std::optional<Eigen::VectorXd>& estimated) {
  const Eigen::VectorXd& centre_point = estimated ? *estimated : model.base().point;
  const Residuals here = misfit.residuals(model.predict(centre_point), centre_point, model.known());
  const Estimator estimator{model, misfit, space, centre_point, here.edge_force, here.chi2};
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
  Eigen::VectorXd unit(all);  // d(coordinate or F_b) / d ln(parameter)
  for (Eigen::Index j = 0; j < n; ++j) {
    const double value = space.value(j, estimator.point[j]);
    unit[j] = std::max(std::abs(value), 1e-12) / space.slope(j, estimator.point[j]);
  }
  if (all > n) {
    const double typical = misfit.measured().col(static_cast<Eigen::Index>(Observable::F_t)).cwiseAbs().maxCoeff();
    unit[n] = here.edge_force != 0 ? std::abs(here.edge_force) : std::max(typical, 1e-12);
  }
  result.jacobian = residual_slopes(model, misfit, centre_point, here.edge_force) * unit.asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(result.jacobian, Eigen::ComputeThinU | Eigen::ComputeFullV);
  result.singular_values = Eigen::VectorXd::Zero(all);
  result.singular_values.head(svd.singularValues().size()) = svd.singularValues();
  result.singular_vectors = svd.matrixV();
  const double smallest = result.singular_values[all - 1];
  result.condition = smallest > unseen * result.singular_values[0] ? result.singular_values[0] / smallest : infinity;

  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(all, all);
  Eigen::MatrixXd floored = covariance;  // what is not seen varies widely instead of without limit
  std::vector<bool> seen(static_cast<std::size_t>(all), true);
  for (Eigen::Index c = 0; c < all; ++c) {
    const Eigen::VectorXd vector = result.singular_vectors.col(c);
    const double floor = std::max(result.singular_values[c], barely_seen * result.singular_values[0]);
    floored += vector * vector.transpose() / (floor * floor);
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

  result.covariance = covariance * result.error_scale * result.error_scale;

  const double allowed = result.allowed_rise();
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
    estimate.slope = Eigen::VectorXd::Unit(all, j) * unit[j] * (is_edge ? 1 : space.slope(j, estimator.point[j]));
    estimate.standard_error =
        seen[static_cast<std::size_t>(j)] ? std::sqrt(result.covariance(j, j)) * estimate.slope[j] : infinity;
    const double centre = is_edge ? here.edge_force : estimator.point[j];
    const auto at = [&](double coordinate) { return estimator.held(j, coordinate); };
    const Limit low = find_limit(at, here.chi2, centre, is_edge ? estimate.bounds.lower : space.lower()[j], allowed);
    const Limit high = find_limit(at, here.chi2, centre, is_edge ? estimate.bounds.upper : space.upper()[j], allowed);
    const double lower = low.coordinate, upper = high.coordinate;
    estimate.lower_end = low.end;
    estimate.upper_end = high.end;
    estimate.interval = is_edge ? Interval{lower, upper} : Interval{space.value(j, lower), space.value(j, upper)};
    estimate.verdict = judge(estimate.value, estimate.standard_error, estimate.interval, estimate.bounds);
    result.parameters.push_back(std::move(estimate));
  }
  for (Eigen::Index j = 0; j < all; ++j)
    if (ParameterEstimate& p = result.parameters[static_cast<std::size_t>(j)]; p.verdict != Verdict::measured)
      p.trade_off = trade_off(j, floored * result.error_scale * result.error_scale, result.parameters);

  const Eigen::VectorXd values = space.values(estimator.point);
  for (const DerivedQuantity& quantity : derived) {
    ParameterEstimate estimate{.name = quantity.name,
                               .path = quantity.expression,
                               .unit = quantity.unit,
                               .interval = {},
                               .bounds = range_of(quantity, space.parameters())};
    estimate.slope = logarithmic_slope(quantity, values, all);
    estimate.value = quantity.of(std::vector<double>(values.begin(), values.end()));
    estimate.standard_error = std::sqrt(estimate.slope.dot(result.covariance * estimate.slope));
    for (Eigen::Index c = 0; c < all; ++c)
      if (result.singular_values[c] <= unseen * result.singular_values[0] &&
          std::abs(result.singular_vectors.col(c).dot(estimate.slope)) > 1e-6 * estimate.slope.norm())
        estimate.standard_error = infinity;
    const auto at = [&](double value) { return estimator.held(quantity, value); };
    const Limit low = find_limit(at, here.chi2, estimate.value, estimate.bounds.lower, allowed);
    const Limit high = find_limit(at, here.chi2, estimate.value, estimate.bounds.upper, allowed);
    estimate.interval = {low.coordinate, high.coordinate};
    estimate.lower_end = low.end;
    estimate.upper_end = high.end;
    estimate.verdict = judge(estimate.value, estimate.standard_error, estimate.interval, estimate.bounds);
    result.derived.push_back(std::move(estimate));
  }
  return result;
}

void add_profiles(Identifiability& known, const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                  const std::vector<DerivedQuantity>& derived) {
  constexpr int points = 17;
  const Residuals here = misfit.residuals(model.base().simulated, model.base().point, model.known());
  const Estimator estimator{model, misfit, space, model.base().point, here.edge_force, here.chi2};
  const auto draw = [&](ParameterEstimate& p, const auto& at) {
    // A third further than the interval, which then does not end at the edge of the picture.
    const double low = std::max(p.bounds.lower, p.interval.lower - (p.value - p.interval.lower) / 3);
    const double high = std::min(p.bounds.upper, p.interval.upper + (p.interval.upper - p.value) / 3);
    if (!std::isfinite(high - low)) return;
    for (int i = 0; i < points; ++i) {
      const double value = low + (high - low) * i / (points - 1);
      p.profile.emplace_back(value, at(value).chi2);
    }
  };
  const Eigen::Index n = space.dimension();
  for (std::size_t j = 0; j < known.parameters.size(); ++j) {
    const auto index = static_cast<Eigen::Index>(j);
    draw(known.parameters[j],
         [&](double value) { return estimator.held(index, index < n ? space.coordinate(index, value) : value); });
  }
  for (std::size_t q = 0; q < derived.size(); ++q)
    draw(known.derived[q], [&](double value) { return estimator.held(derived[q], value); });
}

}  // namespace kerf::inverse
