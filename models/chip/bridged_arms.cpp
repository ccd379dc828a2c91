#include "models/chip/bridged_arms.hpp"

#include <ceres/dynamic_numeric_diff_cost_function.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kerf::chip {
namespace {

using State = std::array<double, 4>;  // w, w', w'', w'''

constexpr int steps = 120;

class Zone {
 public:
  Zone(const Arms& arms, const BridgedCrack& crack)
      : arms_(arms),
        crack_(crack),
        stiffness_(arms.modulus * arms.height * arms.height * arms.height / 12),
        critical_(2 * crack.bridging_toughness / crack.bridging_stress) {
    if (crack.strength > 0) {
      knee_ = 2 * crack.initiation_toughness / (crack.strength - crack.peak * crack.bridging_stress);
      front_ = crack.peak * knee_;
    }
  }

  /// From the front's opening on.
  double traction(double opening) const {
    if (opening >= critical_) return 0;
    if (opening >= knee_ || knee_ <= front_)
      return crack_.bridging_stress * (critical_ - std::max(opening, 0.0)) / (critical_ - knee_);
    const double share = (std::max(opening, front_) - front_) / (knee_ - front_);
    return crack_.strength + share * (crack_.bridging_stress - crack_.strength);
  }
  /// What the front takes.
  double at_front() const { return crack_.strength > 0 ? 0.5 * crack_.strength * front_ : crack_.initiation_toughness; }
  /// Area under T from the front's opening to this one: a trapezium down to the knee and one of the tail.
  double work(double opening) const {
    if (opening < knee_) {
      const double reached = std::max(opening, front_);
      return 0.5 * (crack_.strength + traction(reached)) * (reached - front_);
    }
    const double reached = std::clamp(opening, knee_, critical_);
    return 0.5 * (crack_.strength + crack_.bridging_stress) * (knee_ - front_) +
           0.5 * (crack_.bridging_stress + traction(reached)) * (reached - knee_);
  }
  double stiffness() const { return stiffness_; }

  /// At the notch's end, when the shear at the tip is `tip_pull`.
  State across(double tip_pull, double extension) const {
    const double lever = arms_.root_rotation * arms_.height;
    const double share = tip_pull * lever / stiffness_;
    const double curvature = -share + std::sqrt(share * share + at_front() / stiffness_);  // Eq. (2)
    State y{0.5 * front_, lever * curvature, curvature, -tip_pull / stiffness_};
    const double dx = extension / steps;
    const auto slope = [&](const State& s) { return State{s[1], s[2], s[3], -traction(2 * s[0]) / stiffness_}; };
    const auto moved = [](const State& s, const State& d, double by) {
      return State{s[0] + by * d[0], s[1] + by * d[1], s[2] + by * d[2], s[3] + by * d[3]};
    };
    for (int i = 0; i < steps && dx > 0; ++i) {  // Runge-Kutta of fourth order
      const State a = slope(y), b = slope(moved(y, a, dx / 2)), c = slope(moved(y, b, dx / 2)),
                  d = slope(moved(y, c, dx));
      for (std::size_t k = 0; k < y.size(); ++k) y[k] += dx / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    return y;
  }

  /// w'' where the pull acts: falls as the pull at the tip grows.
  double curvature_at_pull(double tip_pull, double extension) const {
    const State end = across(tip_pull, extension);
    return end[2] + end[3] * arms_.notch;
  }

 private:
  const Arms& arms_;
  const BridgedCrack& crack_;
  double stiffness_, critical_;
  double knee_ = 0, front_ = 0;
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
  const double unit = std::sqrt(crack.initiation_toughness * zone.stiffness()) / (arms.notch + extension);
  double low = -unit, high = 2 * unit;
  while (zone.curvature_at_pull(low, extension) < 0 && std::isfinite(low)) low *= 2;
  while (zone.curvature_at_pull(high, extension) > 0 && std::isfinite(high)) high *= 2;
  std::uintmax_t evaluations = 60;
  const auto root =
      boost::math::tools::toms748_solve([&](double pull) { return zone.curvature_at_pull(pull, extension); }, low, high,
                                        boost::math::tools::eps_tolerance<double>(44), evaluations);
  low = root.first;
  high = root.second;
  const State end = zone.across(0.5 * (low + high), extension);
  const double opening = 2 * end[0];
  return {.G_R = zone.at_front() + zone.work(opening),
          .opening = opening,
          .pull = -zone.stiffness() * end[3],
          .rotation = end[1] + end[2] * arms.notch + 0.5 * end[3] * arms.notch * arms.notch};
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
  // The equations end at zero: a tip without resistance has no curvature, a zone without stress no length.
  const double tiny = 1e-6 * largest->G_R;
  problem.unknowns = {{.name = "initiation_toughness", .unit = "J/m^2", .lower = tiny},
                      {.name = "bridging_toughness", .unit = "J/m^2", .lower = tiny},
                      {.name = "bridging_stress", .unit = "MPa", .lower = 1e-6}};
  problem.residuals = std::shared_ptr<const ceres::CostFunction>(cost);
  for (const double stress : {0.3, 3.0}) problem.starts.push_back({std::max(least->G_R, tiny), rise, stress});
  problem.noise = {.measured = weighted, .freedom = weighted ? std::numeric_limits<double>::infinity() : 0.0};
  return solve(problem);
}

}  // namespace kerf::chip
