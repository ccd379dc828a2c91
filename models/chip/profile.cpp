#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "models/chip/minimum.hpp"

namespace kerf::chip {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double beyond_the_domain = 1e3;  // stands for an infinite chi2: a root finder wants finite numbers

/// One side of one unknown's profile, walked outwards: each minimum starts from the last one within the limit. One from
/// beyond may lie where the model is flat (an exponential whose rate has run off to -infinity) and lead nowhere.
class Walk {
 public:
  Walk(const LeastSquares& problem, const Minimum& best, int unknown, double rise, const Eigen::VectorXd& tangent)
      : problem_(problem), best_(best), last_(best), unknown_(unknown), rise_(rise), tangent_(tangent) {}

  /// sqrt(rise of chi2 / wanted rise) - 1 with the unknown held at `value`: nearly linear, zero at the limit.
  double excess(double value) {
    Minimum here = follow(last_.values, value);
    if (!std::isfinite(here.chi2)) here = follow(best_.values, value);
    if (!std::isfinite(here.chi2)) return beyond_the_domain;
    if (here.chi2 < lowest_.chi2) lowest_ = here;
    const double excess = std::sqrt(std::max(here.chi2 - best_.chi2, 0.0) / rise_) - 1.0;
    if (excess < 0.0) last_ = here;
    return std::min(excess, beyond_the_domain);
  }

  /// The lowest minimum met, wherever the unknown was held.
  const Minimum& lowest() const { return lowest_; }

 private:
  /// The others move along the valley of the quadratic model first; where that leaves the domain, not at all.
  Minimum follow(const std::vector<double>& from, double value) const {
    std::vector<double> start = from;
    const double step = value - from[static_cast<std::size_t>(unknown_)];
    for (std::size_t i = 0; i < start.size(); ++i) {
      const double move = tangent_[static_cast<Eigen::Index>(i)] * step;
      if (std::isfinite(move)) start[i] += move;
    }
    start[static_cast<std::size_t>(unknown_)] = value;
    Minimum minimum = minimise(problem_, start, unknown_);
    if (std::isfinite(minimum.chi2)) return minimum;
    start = from;
    start[static_cast<std::size_t>(unknown_)] = value;
    return minimise(problem_, start, unknown_);
  }

  const LeastSquares& problem_;
  const Minimum& best_;
  Minimum last_;
  Minimum lowest_;
  int unknown_;
  double rise_;
  const Eigen::VectorXd& tangent_;
};

/// The limit on the side `sign`; infinite when chi2 stays low up to the end of the range or 10^6 first steps away.
double limit(Walk& walk, const LeastSquares& problem, const Minimum& best, int unknown, double sign, double step) {
  const auto& declared = problem.unknowns[static_cast<std::size_t>(unknown)];
  const double centre = best.values[static_cast<std::size_t>(unknown)];
  const double end = sign > 0.0 ? declared.upper : declared.lower;
  double inner = centre;
  double inner_excess = -1.0;
  constexpr int strides = 27;  // 1.7^26 is about 10^6
  double reach = step;
  for (int stride = 0; stride < strides; ++stride, reach *= 1.7) {
    double outer = centre + sign * reach;
    const bool at_end = sign * (outer - end) >= 0.0;
    if (at_end) outer = end;
    if (outer == inner) return sign * infinity;
    const double outer_excess = walk.excess(outer);
    if (outer_excess >= 0.0) {
      std::uintmax_t iterations = 40;
      const double tolerance = 1e-6 * std::max(std::abs(outer - centre), 1e-300);
      const auto close = [&](double a, double b) { return std::abs(a - b) <= tolerance; };
      const bool rising = outer > inner;
      const auto [a, b] = boost::math::tools::toms748_solve(
          [&](double value) { return walk.excess(value); }, rising ? inner : outer, rising ? outer : inner,
          rising ? inner_excess : outer_excess, rising ? outer_excess : inner_excess, close, iterations);
      return 0.5 * (a + b);
    }
    if (at_end) return sign * infinity;
    inner = outer;
    inner_excess = outer_excess;
  }
  return sign * infinity;
}

}  // namespace

Limits profile(const LeastSquares& problem, Minimum& best, int unknown, double rise,
               const Eigen::MatrixXd& covariance) {
  const double variance = covariance(unknown, unknown);
  const double value = best.values[static_cast<std::size_t>(unknown)];
  const bool seen = std::isfinite(variance) && variance > 0.0;
  const double step = seen ? std::sqrt(variance * rise) : 0.1 * std::max(std::abs(value), 1.0);
  const Eigen::VectorXd tangent =
      seen ? Eigen::VectorXd(covariance.col(unknown) / variance) : Eigen::VectorXd::Zero(covariance.rows());

  constexpr int restarts = 4;
  Limits limits{};
  for (int attempt = 0; attempt <= restarts; ++attempt) {
    Walk up(problem, best, unknown, rise, tangent);
    limits.upper = limit(up, problem, best, unknown, 1.0, step);
    Walk down(problem, best, unknown, rise, tangent);
    limits.lower = limit(down, problem, best, unknown, -1.0, step);
    const Minimum& lowest = up.lowest().chi2 < down.lowest().chi2 ? up.lowest() : down.lowest();
    if (lowest.chi2 >= best.chi2 - 1e-6 * rise) break;
    const Minimum better = minimise(problem, lowest.values);
    best = better.chi2 < lowest.chi2 ? better : lowest;
  }
  return limits;
}

}  // namespace kerf::chip
