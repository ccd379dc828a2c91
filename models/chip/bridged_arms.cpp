#include "models/chip/bridged_arms.hpp"

#include <ceres/dynamic_numeric_diff_cost_function.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kerf::chip {
namespace {

struct State {
  double w, psi, M, V;
};

constexpr double steps_per_height = 40;  // and as many at least

class Zone {
 public:
  Zone(const Arms& arms, const BridgedCrack& crack)
      : arms_(arms),
        crack_(crack),
        bending_(arms.bending_stiffness()),
        shear_(arms.shear_stiffness()),
        stretch_(arms.transverse_compliance()),
        critical_(2 * crack.bridging_toughness / crack.bridging_stress) {
    if (crack.strength > 0) {
      knee_ = 2 * crack.initiation_toughness / (crack.strength - crack.peak * crack.bridging_stress);
      front_ = crack.peak * knee_;
      at_front_ = 0.5 * front_ + stretch_ * crack.strength;
      at_knee_ = 0.5 * knee_ + stretch_ * crack.bridging_stress;
    }
    is_point_ = at_knee_ <= at_front_;
    if (is_point_) {
      knee_ = front_ = 0;
      foundation_ = 1 / stretch_;
      at_front_ = at_knee_ = std::sqrt(crack.initiation_toughness / foundation_);
      at_end_ = at_front_ + 0.5 * critical_;
    } else {
      foundation_ = 1 / (stretch_ + 0.5 * front_ / crack.strength);
      at_end_ = 0.5 * critical_;
    }
  }

  /// Behind the front, where an arm has deflected by w.
  double traction(double w) const {
    if (w >= at_end_) return 0;
    if (w >= at_knee_ || is_point_) return crack_.bridging_stress * std::min((at_end_ - w) / (at_end_ - at_knee_), 1.0);
    const double share = std::max(w - at_front_, 0.0) / (at_knee_ - at_front_);
    return crack_.strength + share * (crack_.bridging_stress - crack_.strength);
  }
  double opening(double w) const {
    return is_point_ ? 2 * std::max(w - at_front_, 0.0) : 2 * (w - stretch_ * traction(w));
  }
  /// Area under T up to an opening behind the front's: what the front takes, a trapezium down to the knee, one of the
  /// tail.
  double work(double opening) const {
    double taken = is_point_ ? crack_.initiation_toughness : 0.5 * crack_.strength * front_;
    const auto between = [&](double from, double to, double first, double last) {
      if (opening <= from || to <= from) return;
      const double share = std::min((opening - from) / (to - from), 1.0);
      taken += share * (to - from) * (first + 0.5 * share * (last - first));
    };
    between(front_, knee_, crack_.strength, crack_.bridging_stress);
    between(knee_, critical_, crack_.bridging_stress, 0);
    return taken;
  }

  /// At the notch's end, when the shear force at the front is `tip_pull`.
  State across(double tip_pull, double extension) const {
    const double root = std::sqrt(bending_ * foundation_);
    const double length = std::sqrt(bending_ / shear_ + 2 * bending_ / root);
    const double slope_at_front = length * foundation_ / root * at_front_ - tip_pull / root;  // Eqs. (3)
    State y{at_front_, slope_at_front - tip_pull / shear_, root * at_front_ - length * tip_pull, tip_pull};
    const auto slope = [&](const State& s) { return State{s.psi + s.V / shear_, s.M / bending_, -s.V, traction(s.w)}; };
    const auto moved = [](const State& s, const State& d, double by) {
      return State{s.w + by * d.w, s.psi + by * d.psi, s.M + by * d.M, s.V + by * d.V};
    };
    const double longest = extension / std::ceil(steps_per_height * std::max(extension / arms_.height, 1.0));
    for (double left = extension; left > 1e-9 * extension;) {
      const double dx = y.w < at_end_ ? std::min(longest, left) : left;  // exact for free arms
      const State a = slope(y), b = slope(moved(y, a, dx / 2)), c = slope(moved(y, b, dx / 2)),
                  d = slope(moved(y, c, dx));  // Runge-Kutta of fourth order
      y = moved(moved(moved(moved(y, a, dx / 6), b, dx / 3), c, dx / 3), d, dx / 6);
      left -= dx;
    }
    return y;
  }

  /// M where the pull acts: falls as the shear force at the front grows.
  double moment_at_pull(double tip_pull, double extension) const {
    const State end = across(tip_pull, extension);
    return end.M - end.V * arms_.notch;
  }

 private:
  const Arms& arms_;
  const BridgedCrack& crack_;
  double bending_, shear_, stretch_, critical_;
  double foundation_;
  double knee_ = 0, front_ = 0;                 // openings
  double at_front_ = 0, at_knee_ = 0, at_end_;  // deflections
  bool is_point_;
};

struct Misfit {
  Arms arms;
  std::vector<ResistancePoint> points;
  BridgedCrack known;
  bool weighted;

  bool operator()(double const* const* unknowns, double* residuals) const {
    BridgedCrack crack = known;
    crack.initiation_toughness = unknowns[0][0];
    crack.bridging_toughness = unknowns[0][1];
    crack.bridging_stress = unknowns[0][2];
    if (!(crack.initiation_toughness > 0 && crack.bridging_toughness > 0 && crack.bridging_stress > 0)) return false;
    if (crack.strength > 0 && !(crack.bridging_stress < crack.strength)) return false;
    for (std::size_t i = 0; i < points.size(); ++i)
      residuals[i] = (resistance(arms, crack, points[i].extension).G_R - points[i].G_R) /
                     (weighted ? points[i].standard_error : 1.0);
    return true;
  }
};

}  // namespace

Resistance resistance(const Arms& arms, const BridgedCrack& crack, double extension) {
  const Zone zone(arms, crack);
  // Without bridging the pull of a tip that takes G_init; a zone may push the tip's shear to the other side.
  const double stiffness = arms.bending_stiffness();
  const double unit = std::sqrt(crack.initiation_toughness * stiffness) / (arms.notch + extension);
  double low = -unit, high = 2 * unit;
  while (zone.moment_at_pull(low, extension) < 0 && std::isfinite(low)) low *= 2;
  while (zone.moment_at_pull(high, extension) > 0 && std::isfinite(high)) high *= 2;
  std::uintmax_t evaluations = 60;
  const auto root =
      boost::math::tools::toms748_solve([&](double pull) { return zone.moment_at_pull(pull, extension); }, low, high,
                                        boost::math::tools::eps_tolerance<double>(44), evaluations);
  const State end = zone.across(0.5 * (root.first + root.second), extension);
  const double opening = zone.opening(end.w), turned = arms.notch * (end.M - 0.5 * end.V * arms.notch) / stiffness;
  return {.G_R = zone.work(opening),
          .opening = opening,
          .traction = zone.traction(end.w),
          .pull = end.V,
          .rotation = end.psi + turned + 0.5 * end.V / arms.shear_stiffness()};
}

Fit fit_r_curve(const Arms& arms, const std::vector<ResistancePoint>& points, const BridgedCrack& known) {
  const bool weighted = std::all_of(points.begin(), points.end(), [](const auto& p) { return p.standard_error > 0; });
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Misfit>(new Misfit{arms, points, known, weighted});
  cost->AddParameterBlock(3);
  cost->SetNumResiduals(static_cast<int>(points.size()));
  const auto [least, largest] =
      std::minmax_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.G_R < b.G_R; });
  const double rise = std::max(largest->G_R - least->G_R, 0.1 * largest->G_R);
  LeastSquares problem;
  // The equations end at zero, where a tip without resistance has no curvature and a zone without stress no length, and
  // where bridging is as strong as the peak.
  const double tiny = 1e-6 * largest->G_R;
  problem.unknowns = {{.name = "initiation_toughness", .unit = "J/m^2", .lower = tiny},
                      {.name = "bridging_toughness", .unit = "J/m^2", .lower = tiny},
                      {.name = "bridging_stress", .unit = "MPa", .lower = 1e-6}};
  if (known.strength > 0) problem.unknowns[2].upper = 0.999 * known.strength;
  problem.residuals = std::shared_ptr<const ceres::CostFunction>(cost);
  for (const double stress : {0.3, 3.0}) problem.starts.push_back({std::max(least->G_R, tiny), rise, stress});
  problem.noise = {.measured = weighted, .freedom = weighted ? std::numeric_limits<double>::infinity() : 0.0};
  return solve(problem);
}

}  // namespace kerf::chip
