#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "inverse/objective.hpp"
#include "inverse/quadratic_response.hpp"

namespace kerf::inverse {

/// The observables near a simulated point, on the scale where they answer most nearly linearly (see model_scale), as
/// quadratics of the search coordinates that QuadraticResponse finds through all runs of a cut on one branch. Slopes
/// mean nothing between two branches (touching, bending), and beyond `reach` they stay as they are there: a parabola
/// would turn back.
class LocalModel {
 public:
  static constexpr double reach = 0.5;  ///< in search coordinates

  /// Nothing but the base; every slope is unsure.
  LocalModel(Evaluation base, const OptimiserChoice& choice);
  /// With differences about it.
  static LocalModel by_differences(Objective& objective, const Evaluation& base);

  /// Simulates one difference (two on both sides if the job wants them central) for every slope whose error matters,
  /// inside the bounds and away from what is known, all as one batch. A run that fails or lands on another branch is
  /// tried again on the other side and at half the step, near a jump down to an eighth; a cut with a slope still
  /// missing is left out of the model. Throws BudgetSpent.
  void difference(Objective& objective);
  /// The same for slopes of which nothing is known, as those of a cut are that jumped to another branch with the base.
  void difference_unknown(Objective& objective);
  /// Differences would not change what is known of the parameters: they were taken at the present base, or would be no
  /// better than what other runs of the same fidelity tell, or the errors of the slopes add less than a tenth to the
  /// information on any.
  bool is_sure(const Objective& objective) const;

  const Evaluation& base() const { return base_; }
  /// Cuts that the model predicts.
  CutMask known() const { return both(has_slopes_, base_.usable); }
  /// Cuts of which a run within a step of the base, or at another point that is `allowed`, landed on another branch.
  CutMask at_jump(const std::function<bool(const Eigen::VectorXd&)>& allowed) const;

  Observations predict(const Eigen::VectorXd& point) const;

  /// One observable of one cut; T is double or an automatic derivative.
  template <class T>
  T predict(Eigen::Index cut, Eigen::Index observable, const T* const* point) const {
    using std::exp;
    const double here = base_.simulated(cut, observable);
    if (observable == static_cast<Eigen::Index>(Observable::F_t)) {
      const auto F_c = static_cast<Eigen::Index>(Observable::F_c);
      return predict(cut, F_c, point) * (here / base_.simulated(cut, F_c) + change(cut, observable, point));
    }
    return is_logarithmic(observable) ? here * exp(change(cut, observable, point))
                                      : here + change(cut, observable, point);
  }

  /// Takes another simulated point into account.
  void learn(const Evaluation& other);
  /// The same response about a run of another fidelity; nothing is known of a cut on another branch there.
  void borrow_for(const Evaluation& other);
  /// The same runs about another simulated point.
  void move_to(const Evaluation& other);

  /// Of an observable on the model's scale by a search coordinate: cuts x parameters.
  const Eigen::MatrixXd& slopes(Eigen::Index observable) const { return slopes_[static_cast<std::size_t>(observable)]; }
  /// Covariance of the slopes d ln(observable), of F_t and curvature d(observable), of one cut that comes from how
  /// rough the simulated values are: parameters x parameters.
  Eigen::MatrixXd slope_covariance(Eigen::Index cut, Eigen::Index observable) const;
  /// With every slope by the coordinates replaced by its product with `share`: parameters x parameters.
  LocalModel scaled(const Eigen::MatrixXd& share) const;
  static bool is_logarithmic(Eigen::Index observable) { return is_positive(static_cast<std::size_t>(observable)); }

  /// True when a cut usable at both points is on different branches.
  static bool branches_differ(const Evaluation& a, const Evaluation& b);

 private:
  using SlopeMask = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

  struct Run {
    Eigen::VectorXd point;
    Eigen::RowVectorXd scaled;  ///< the observables on the model's scale
    forward::Branch branch;
    bool borrowed = false;  ///< from another fidelity
  };

  /// g d + d^T H d / 2, along every ray from the base straight on beyond the reach.
  template <class T>
  T change(Eigen::Index cut, Eigen::Index observable, const T* const* point) const {
    using std::sqrt;
    const auto k = static_cast<std::size_t>(observable);
    const Eigen::MatrixXd& bend = curvatures_[k][static_cast<std::size_t>(cut)];
    T straight(0.0), bent(0.0), length2(0.0);
    for (Eigen::Index i = 0; i < bend.rows(); ++i) {
      const T step = point[i][0] - base_.point[i];
      straight += slopes_[k](cut, i) * step;
      length2 += step * step;
      for (Eigen::Index j = 0; j < bend.cols(); ++j) bent += bend(i, j) * step * (point[j][0] - base_.point[j]);
    }
    T share(1.0);
    if (length2 > reach * reach) share = reach / sqrt(length2);
    return straight + share * (1.0 - 0.5 * share) * bent;
  }

  void add(std::size_t cut, const Eigen::VectorXd& point, const RunRecord& run, const Eigen::RowVectorXd& simulated);
  void refit();
  /// Of one observable; steps and changes (runs x observables) of every cut.
  void refit(Eigen::Index observable, const std::vector<Eigen::MatrixXd>& steps,
             const std::vector<Eigen::MatrixXd>& changes);
  Eigen::MatrixXd steps_of(const std::vector<const Run*>& runs) const;
  /// Errors of slopes over such steps if all were as rough as the audit says and as bent as usual.
  Eigen::VectorXd errors_if_usual(const Eigen::MatrixXd& steps) const;
  /// Of an observable on the model's scale: what the noise audit and the cut's own error say.
  Texture said_texture(std::size_t cut, Eigen::Index observable) const;
  /// A parameter alone that changes an observable by not one bit does not act on it: no fit through other runs may say
  /// so. One step and one change of every run per row.
  void silence(std::size_t cut, const Eigen::MatrixXd& steps, const Eigen::MatrixXd& changes);
  /// Error of the slope that a difference gives of a quantity with this texture.
  double fresh_error(const Texture& texture) const;
  /// From which error on a slope counts as not known at all.
  double unknown_error() const { return std::max(1.0, 2 * fresh_error({.roughness = choice_.roughness})); }
  /// Of the slopes, those that a difference should improve: cuts x parameters.
  SlopeMask unsure(const Objective& objective) const;
  /// Simulates differences for the slopes chosen.
  void improve(Objective& objective, const SlopeMask& chosen);

  Evaluation base_;
  OptimiserChoice choice_;
  std::vector<std::vector<Run>> runs_;                                     ///< of every cut
  std::array<Eigen::MatrixXd, observable_count> slopes_;                   ///< cuts x parameters
  std::array<std::vector<Eigen::MatrixXd>, observable_count> curvatures_;  ///< of every cut: parameters x parameters
  std::array<SlopeMask, observable_count> silent_;        ///< slopes that are zero to the last bit: cuts x parameters
  std::array<Eigen::MatrixXd, observable_count> errors_;  ///< of the slopes, all that is not known: cuts x parameters
  std::array<std::vector<Eigen::MatrixXd>, observable_count> rough_covariances_;  ///< of the slopes of every cut
  Eigen::MatrixXd fresh_errors_;  ///< of a difference: cuts x observables
  Eigen::MatrixXd told_;          ///< errors_if_usual() of what is heard: whether it tells a slope at all
  CutMask has_slopes_;
  bool fresh_ = false;  ///< every difference that matters was taken at the present base
};

/// Derivatives of the weighted residuals by the search coordinates at `point`, and by F_b as the last column if the job
/// has one: residuals x parameters.
Eigen::MatrixXd residual_slopes(const LocalModel& model, const Misfit& misfit, const Eigen::VectorXd& point,
                                double edge_force);

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
