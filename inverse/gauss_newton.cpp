#include <algorithm>
#include <cmath>

#include "inverse/optimiser.hpp"

namespace kerf::inverse {
namespace {

constexpr double first_radius = 0.5;    // in search coordinates: a factor of 1.65
constexpr double largest_radius = 1.0;  // slopes do not reach further
constexpr int most_iterations = 60;
constexpr double standard_error_squared = 1;  // the rise of chi^2 at a distance of one standard error of one parameter

/// Minimum of the local model no further than `radius` from its base in any coordinate.
ModelMinimum propose(const Objective& objective, const LocalModel& model, double radius) {
  const ParameterSpace& space = objective.space();
  const Eigen::VectorXd centre = model.base().point;
  const Eigen::VectorXd reach = Eigen::VectorXd::Constant(centre.size(), radius);
  return minimise(model, objective.misfit(), space, centre, space.clamp(centre - reach), space.clamp(centre + reach));
}

/// Enough cuts in common to say which of two points is better.
bool comparable(const Objective& objective, const CutMask& common) {
  return static_cast<double>(count(common)) >=
         (1.0 - objective.budget().failing_share) * static_cast<double>(objective.cuts());
}

/// A trust-region search that says what it does in terms of simulated cuts. Its inner problem, bounded least squares
/// over the local model, is solved by Ceres; the outer loop is ours because a trial here is a batch of simulations, of
/// which some may fail, and because the same runs must come back in the same order when a journal is replayed.
class GaussNewton {
 public:
  GaussNewton(Objective& objective, LocalModel model) : objective_(objective), model_(std::move(model)) {}

  SearchResult search() {
    try {
      for (int i = 0; i < most_iterations && !done_; ++i) iterate();
      if (!done_) stop(false, "no convergence within the iterations allowed");
    } catch (const BudgetSpent&) {
      stop(false, "the budget of runs is spent");
    }
    return {.best = here(), .converged = converged_, .reason = reason_, .model = model_};
  }

 private:
  const Evaluation& here() const { return model_.base(); }

  void stop(bool converged, const char* reason) {
    done_ = true;
    converged_ = converged;
    reason_ = reason;
  }

  double worthwhile() const { return objective_.worthwhile(here()); }

  void difference() {
    model_.difference(objective_);
    objective_.trace("differences", here());
  }

  void iterate() {
    const double known_chi2 = objective_.misfit().chi2(here(), model_.known());
    const ModelMinimum bold = propose(objective_, model_, radius_);
    const double promise = known_chi2 - bold.chi2;
    // The slopes at the end are wanted anyway; once it is near, they come before another step.
    const bool near = promise <= std::max(worthwhile(), standard_error_squared);
    if (near && objective_.choice().confirm && !model_.is_sure(objective_)) return difference();
    if (promise <= worthwhile()) return conclude(known_chi2);
    std::vector<Eigen::VectorXd> points{bold.point};
    const ModelMinimum careful = propose(objective_, model_, radius_ / 3);
    if ((careful.point - bold.point).lpNorm<Eigen::Infinity>() > 0.05 * radius_) points.push_back(careful.point);
    take_best(objective_.evaluate(points), promise);
  }

  /// Nothing worthwhile lies within the radius. Beyond it, where earlier steps had failed, there may be.
  void conclude(double known_chi2) {
    const auto simulated = static_cast<double>(count(here().usable));
    if (static_cast<double>(count(model_.known())) < (1.0 - objective_.budget().failing_share) * simulated)
      return stop(false, "the differences of too many cuts failed");
    const double beyond = known_chi2 - propose(objective_, model_, largest_radius).chi2;
    if (beyond <= std::max(worthwhile(), standard_error_squared))
      return stop(true, "no step promises a decrease that could be told from noise");
    if (widened_) return stop(false, "steps that the slopes promise do not lower the misfit");
    widened_ = true;
    radius_ = first_radius;
  }

  void take_best(const std::vector<Evaluation>& trials, double promise) {
    const Evaluation* best = nullptr;
    double best_decrease = worthwhile();
    for (const Evaluation& trial : trials) {
      const CutMask common = both(here().usable, trial.usable);
      if (!comparable(objective_, common)) continue;
      const double decrease = objective_.misfit().chi2(here(), common) - objective_.misfit().chi2(trial, common);
      if (decrease <= best_decrease) continue;
      best_decrease = decrease;
      best = &trial;
    }
    const double step = (trials.front().point - here().point).lpNorm<Eigen::Infinity>();
    for (const Evaluation& trial : trials) model_.learn(trial);
    if (!best) return refuse(step, promise, trials.front());
    refused_short_ = 0;
    const bool new_branch = LocalModel::branches_differ(here(), *best);
    if (best == &trials.front() && best_decrease > 0.75 * promise) radius_ = std::min(largest_radius, 2 * radius_);
    if (best_decrease < 0.25 * promise) radius_ = std::max(0.5 * step, 2 * objective_.choice().step);
    model_.move_to(*best);
    objective_.trace("trial accepted", here());
    if (new_branch) {
      model_.difference_unknown(objective_);
      objective_.trace("differences on another branch", here());
    }
  }

  void refuse(double step, double promise, const Evaluation& trial) {
    objective_.trace("trial refused", trial);
    radius_ = step / 4;
    const bool worth_slopes = objective_.choice().confirm || promise > standard_error_squared;
    if (worth_slopes && !model_.is_sure(objective_)) {
      radius_ = std::max(radius_, 2 * objective_.choice().step);
      return difference();
    }
    // The refused trial has changed the model: what it promises next is another step.
    const double least_radius = objective_.choice().step / 2;
    if (radius_ >= least_radius || ++refused_short_ == 1) {
      radius_ = std::max(radius_, least_radius);
      return;
    }
    const bool at_noise = promise <= std::max(10 * worthwhile(), standard_error_squared);
    stop(at_noise, at_noise ? "the steps left promise little and deliver less: the end of what the simulation resolves"
                            : "steps that the slopes promise do not lower the misfit");
  }

  Objective& objective_;
  LocalModel model_;
  double radius_ = first_radius;
  int refused_short_ = 0;  ///< steps in a row that were refused although short
  bool widened_ = false;   ///< a shrunken radius was given up once
  bool done_ = false, converged_ = false;
  std::string reason_;
};

}  // namespace

SearchResult gauss_newton(Objective& objective, const LocalModel& model) {
  return GaussNewton(objective, model).search();
}

SearchResult gauss_newton(Objective& objective, const Evaluation& start) {
  std::optional<LocalModel> model;
  try {
    model = LocalModel::by_differences(objective, start);
  } catch (const BudgetSpent&) {
    return {.best = start,
            .converged = false,
            .reason = "the budget of runs does not cover the first differences",
            .model = {}};
  }
  objective.trace("differences", start);
  return gauss_newton(objective, *model);
}

}  // namespace kerf::inverse
