#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

#include "inverse/objective.hpp"

namespace kerf::inverse {

/// The observables near a simulated point: ln F_c, F_t, ln(chip ratio) and the chip curvature linear in the search
/// coordinates. Slopes come from differences of simulations and are then improved by every further simulation
/// (Broyden's update). A difference never spans two branches of the cut (touching, bending), where slopes mean nothing.
class LocalModel {
 public:
  /// Slopes by one-sided differences inside the bounds (two-sided ones if the job wants them central), all as one
  /// batch. A run that fails or lands on another branch is tried again on the other side and at half the step, near a
  /// jump down to an eighth; a cut with a slope still missing is left out of the model. Throws BudgetSpent.
  static LocalModel by_differences(Objective& objective, const Evaluation& base);

  const Evaluation& base() const { return base_; }
  /// Slopes were differenced at the present base.
  bool is_fresh() const { return fresh_; }
  /// Cuts that the model predicts.
  CutMask known() const { return both(has_slopes_, base_.usable); }

  /// Cuts of which a difference landed on another branch: the point lies within a step of a jump.
  const CutMask& at_jump() const { return at_jump_; }

  Observations predict(const Eigen::VectorXd& point) const;

  /// One observable of one cut; T is double or an automatic derivative.
  template <class T>
  T predict(Eigen::Index cut, Eigen::Index observable, const T* const* point) const {
    using std::exp;
    const auto& slopes = slopes_[static_cast<std::size_t>(observable)];
    T change(0.0);
    for (Eigen::Index j = 0; j < slopes.cols(); ++j) change += slopes(cut, j) * (point[j][0] - base_.point[j]);
    const double here = base_.simulated(cut, observable);
    return is_logarithmic(observable) ? here * exp(change) : here + change;
  }

  /// Makes the model agree with `other` by the smallest change of the slopes, as far as the surprise is not likelier to
  /// be the roughness of the two than a curved response.
  void learn(const Evaluation& other);
  /// The same slopes about a run of another fidelity: never fresh.
  void borrow_for(const Evaluation& other) {
    base_ = other;
    fresh_ = false;
  }
  /// d ln F_c, d F_t or d ln(chip ratio) by a search coordinate: cuts x parameters.
  const Eigen::MatrixXd& slopes(Eigen::Index observable) const { return slopes_[static_cast<std::size_t>(observable)]; }
  /// Standard errors of the slopes, from how rough the simulated values are over the steps of their differences.
  const Eigen::MatrixXd& slope_errors(Eigen::Index observable) const {
    return slope_errors_[static_cast<std::size_t>(observable)];
  }
  /// With every slope by the coordinates replaced by its product with `share`: parameters x parameters.
  LocalModel scaled(const Eigen::MatrixXd& share) const;
  static bool is_logarithmic(Eigen::Index observable) { return is_positive(static_cast<std::size_t>(observable)); }

  /// The same slopes about another simulated point.
  void move_to(const Evaluation& other);

  /// True when a cut usable at both points is on different branches.
  static bool branches_differ(const Evaluation& a, const Evaluation& b);

 private:
  explicit LocalModel(Evaluation base);
  /// Change of one transformed observable of `cut` between the base and a run.
  double change(Eigen::Index cut, Eigen::Index observable, double simulated) const;

  Evaluation base_;
  std::array<Eigen::MatrixXd, observable_count> slopes_, slope_errors_;  ///< cuts x parameters
  double roughness_ = 0;                                                 ///< of the simulated values, relative
  CutMask has_slopes_, at_jump_;
  bool fresh_ = true;
};

/// The minimum of a misfit over a local model.
struct ModelMinimum {
  Eigen::VectorXd point;
  double edge_force = 0;
  double chi2 = 0;  ///< over the cuts the model knows
};

/// What a minimisation is not free to do.
struct Restriction {
  std::optional<Eigen::Index> fixed = {};  ///< coordinate that stays as it is in the start
  std::optional<double> fixed_edge = {};   ///< F_b
  const DerivedQuantity* held = nullptr;   ///< keeps `held_value`, by a residual too stiff to matter
  double held_value = 0;
  std::vector<double> multiplicity = {};  ///< how often each cut counts; empty: once
};

/// Least squares over (point, F_b) inside [lower, upper] and the bounds of F_b, by Ceres.
ModelMinimum minimise(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                      const Eigen::VectorXd& start, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                      const Restriction& restriction = {});

}  // namespace kerf::inverse
