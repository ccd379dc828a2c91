#include "models/chip/least_squares.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "models/chip/minimum.hpp"

namespace kerf::chip {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double unknown_number = std::numeric_limits<double>::quiet_NaN();

/// Half-width of a 95 % interval in standard errors.
double coverage_factor(double freedom) {
  if (std::isinf(freedom)) return boost::math::quantile(boost::math::normal(), 0.975);
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

double chance_of(double chi2, int freedom, const Noise& noise) {
  if (std::isinf(noise.freedom)) return boost::math::cdf(complement(boost::math::chi_squared(freedom), chi2));
  return boost::math::cdf(complement(boost::math::fisher_f(freedom, noise.freedom), chi2 / freedom));
}

/// AICc = -2 ln L + 2 k n / (n - k - 1), k parameters; an unknown variance is one more.
std::optional<double> corrected_aic(double chi2, int data, int parameters, const Noise& noise) {
  const int k = parameters + (noise.measured ? 0 : 1);
  if (data - k - 1 <= 0) return {};
  const double penalty = 2.0 * k * data / (data - k - 1);
  if (noise.measured) return chi2 + penalty;
  return chi2 > 0.0 ? std::optional(data * std::log(chi2 / data) + penalty) : std::nullopt;
}

Verdict judge(const FittedParameter& parameter, bool positive) {
  const bool below = std::isfinite(parameter.lower);
  const bool above = std::isfinite(parameter.upper);
  if (!below && !above) return Verdict::not_measurable;
  if (parameter.lower <= 0.0 && parameter.upper >= 0.0) {
    // No lower limit and zero inside: for what cannot be negative that is an upper bound, else it is nothing.
    if (above) return below || positive ? Verdict::zero : Verdict::bounded_above;
    return positive ? Verdict::not_measurable : Verdict::bounded_below;
  }
  if (positive && above && parameter.upper < 0.0) return Verdict::negative;
  if (!above) return Verdict::bounded_below;
  if (!below) return Verdict::bounded_above;
  return parameter.upper - parameter.lower <= std::abs(parameter.value) ? Verdict::measured : Verdict::bounded;
}

Minimum best_of_starts(const LeastSquares& problem) {
  Minimum best;
  for (const auto& start : problem.starts) {
    if (auto minimum = minimise(problem, start); minimum.chi2 < best.chi2) best = std::move(minimum);
  }
  return std::isfinite(best.chi2) ? polish(problem, best) : best;
}

/// An estimate that differs from a bound by less than the minimum can tell lies on it: the bound's value is the answer,
/// not the last digits of a search that ran into it.
void settle_on_bounds(const LeastSquares& problem, Minimum& best) {
  constexpr double indifferent = 1e-6;
  for (std::size_t i = 0; i < best.values.size(); ++i) {
    for (const double bound : {problem.unknowns[i].lower, problem.unknowns[i].upper}) {
      if (!std::isfinite(bound) || best.values[i] == bound) continue;
      auto settled = best.values;
      settled[i] = bound;
      const double chi2 = chi2_at(problem, settled);
      if (chi2 <= best.chi2 * (1.0 + indifferent)) {
        best.values = std::move(settled);
        best.chi2 = chi2;
      }
    }
  }
}

/// Size of the residuals if the model predicted nothing: what "exactly fitted" is measured against.
double total(const LeastSquares& problem, const Minimum& best, const Eigen::MatrixXd& jacobian) {
  double sum = 0.0;
  for (std::size_t i = 0; i < problem.unknowns.size(); ++i) {
    sum += (jacobian.col(static_cast<Eigen::Index>(i)) * best.values[i]).squaredNorm();
  }
  return sum;
}

/// Covariance of what is free: an estimate that rests on a bound is not free to spread. Singular values are of all.
Covariance spread_at(const LeastSquares& problem, const std::vector<double>& values) {
  Eigen::MatrixXd jacobian = linearise(problem, values).jacobian;
  auto singular_values = covariance(jacobian).singular_values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& unknown = problem.unknowns[i];
    if (values[i] <= unknown.lower || values[i] >= unknown.upper) jacobian.col(static_cast<Eigen::Index>(i)).setZero();
  }
  auto spread = covariance(jacobian);
  spread.singular_values = std::move(singular_values);
  return spread;
}

}  // namespace

std::string in_words(Verdict verdict) {
  switch (verdict) {
    case Verdict::measured:
      return "measured";
    case Verdict::bounded:
      return "bounded above and below";
    case Verdict::bounded_below:
      return "bounded below";
    case Verdict::bounded_above:
      return "bounded above";
    case Verdict::zero:
      return "indistinguishable from zero";
    case Verdict::negative:
      return "below zero: contradicts the model";
    case Verdict::not_measurable:
      break;
  }
  return "not measurable with these cuts";
}

const FittedParameter* Fit::find(std::string_view name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const FittedParameter& parameter) { return parameter.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

Fit solve(const LeastSquares& problem) {
  const int unknowns = static_cast<int>(problem.unknowns.size());
  const int reported = unknowns - problem.nuisances;
  Minimum best = best_of_starts(problem);
  settle_on_bounds(problem, best);

  Fit fit;
  fit.noise = problem.noise;
  fit.data = problem.residuals->num_residuals() - problem.nuisances;
  fit.freedom = fit.data - reported;
  fit.converged = std::isfinite(best.chi2) && best.converged;
  if (!std::isfinite(best.chi2)) {
    best.values.assign(problem.unknowns.size(), unknown_number);
    best.chi2 = unknown_number;
  }

  Covariance spread = spread_at(problem, best.values);
  std::vector<Limits> limits(problem.unknowns.size(), {-infinity, infinity});
  if (fit.determined() && fit.converged) {
    const double lowest = best.chi2;
    for (int pass = 0; pass < 3; ++pass) {  // again only if a walk came upon a lower minimum
      const double before = best.chi2;
      const double variance = problem.noise.measured ? 1.0 : best.chi2 / fit.freedom;
      const double factor = coverage_factor(problem.noise.measured ? problem.noise.freedom : fit.freedom);
      const double rise = factor * factor * variance;
      const bool exact = rise <= 1e-18 * total(problem, best, linearise(problem, best.values).jacobian);
      for (int i = 0; i < reported; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (exact) {
          const double half = std::sqrt(spread.matrix(i, i) * rise);
          if (std::isfinite(half)) limits[at] = {best.values[at] - half, best.values[at] + half};
        } else {
          limits[at] = profile(problem, best, i, rise, spread.matrix);
        }
      }
      if (best.chi2 >= before) break;
      spread = spread_at(problem, best.values);
    }
    fit.converged = best.converged && best.chi2 <= lowest;
  }

  fit.values = best.values;
  fit.chi2 = best.chi2;
  fit.singular_values = spread.singular_values;
  fit.scatter = fit.determined() ? std::sqrt(best.chi2 / fit.freedom) : unknown_number;
  if (fit.determined() && fit.converged) {
    if (problem.noise.measured) fit.p_value = chance_of(best.chi2, fit.freedom, problem.noise);
    fit.aicc = corrected_aic(best.chi2, fit.data, reported, problem.noise);
  }

  const double error_scale = problem.noise.measured ? 1.0 : fit.scatter;
  fit.correlation = Eigen::MatrixXd::Constant(reported, reported, unknown_number);
  for (int i = 0; i < reported; ++i) {
    for (int j = 0; j < reported; ++j) {
      fit.correlation(i, j) = spread.matrix(i, j) / std::sqrt(spread.matrix(i, i) * spread.matrix(j, j));
    }
    const auto at = static_cast<std::size_t>(i);
    const auto& unknown = problem.unknowns[at];
    FittedParameter parameter{.name = unknown.name, .unit = unknown.unit, .value = best.values[at]};
    parameter.standard_error = fit.determined() ? std::sqrt(spread.matrix(i, i)) * error_scale : unknown_number;
    parameter.lower = limits[at].lower;
    parameter.upper = limits[at].upper;
    parameter.verdict = fit.determined() ? judge(parameter, unknown.positive) : Verdict::not_measurable;
    if (parameter.verdict == Verdict::not_measurable) {
      parameter.lower = -infinity;
      parameter.upper = infinity;
    } else if (unknown.positive && parameter.verdict != Verdict::negative) {
      parameter.lower = std::max(parameter.lower, 0.0);
    }
    fit.parameters.push_back(std::move(parameter));
  }
  return fit;
}

}  // namespace kerf::chip
