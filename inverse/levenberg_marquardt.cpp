#include <ceres/ceres.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "inverse/optimiser.hpp"

namespace kerf::inverse {
namespace {

/// Weighted residuals of all cuts, F_b projected out, as one Ceres cost function: one call is one batch of runs. Ceres
/// asks twice for the same point and ends the search when a Jacobian fails, so the last evaluation and the best one are
/// kept here; a cut that failed at the start is left out throughout, because Ceres compares vectors of one length.
class CutResiduals : public ceres::CostFunction {
 public:
  CutResiduals(Objective& objective, const Evaluation& start)
      : objective_(objective), compared_(start.usable), last_(start), best_(start) {
    set_num_residuals(static_cast<int>(objective.misfit().residual_count()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(objective.space().dimension()));
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    if (failure_ || spent_) return false;
    try {
      const Eigen::VectorXd point =
          objective_.space().clamp(Eigen::Map<const Eigen::VectorXd>(blocks[0], objective_.space().dimension()));
      if (point != last_.point) {
        last_ = objective_.evaluate(point);
        objective_.trace("trial", last_);
      }
      if (both(last_.usable, compared_) != compared_) return false;
      const Misfit& misfit = objective_.misfit();
      const Residuals here = misfit.residuals(last_.simulated, point, compared_);
      Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = here.weighted;
      if (here.chi2 < misfit.chi2(best_, compared_)) best_ = last_;
      return jacobians == nullptr || jacobians[0] == nullptr || differentiate(here, jacobians[0]);
    } catch (const BudgetSpent&) {
      spent_ = true;
    } catch (...) {
      failure_ = std::current_exception();
    }
    return false;
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  bool spent() const { return spent_; }
  const Evaluation& best() const { return best_; }
  /// Slopes about `best`, if Ceres asked for them.
  std::optional<LocalModel> model() const {
    return model_ && model_->base().point == best_.point ? model_ : std::nullopt;
  }

 private:
  /// Derivative of the projected residuals: simulations are differenced once, the projection costs nothing.
  bool differentiate(const Residuals& here, double* jacobian) const {
    if (!model_ || model_->base().point != last_.point) {
      model_ = LocalModel::by_differences(objective_, last_);
      objective_.trace("differences", last_);
    }
    if (both(model_->known(), compared_) != compared_) return false;
    const double tiny = 1e-6;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> columns(
        jacobian, num_residuals(), last_.point.size());
    for (Eigen::Index j = 0; j < last_.point.size(); ++j) {
      Eigen::VectorXd moved = last_.point;
      moved[j] += tiny;
      columns.col(j) =
          (objective_.misfit().residuals(model_->predict(moved), moved, compared_).weighted - here.weighted) / tiny;
    }
    return true;
  }

  Objective& objective_;
  CutMask compared_;
  mutable Evaluation last_, best_;
  mutable std::optional<LocalModel> model_;
  mutable bool spent_ = false;
  mutable std::exception_ptr failure_;
};

}  // namespace

SearchResult levenberg_marquardt(Objective& objective, const Evaluation& start) {
  const ParameterSpace& space = objective.space();
  CutResiduals residuals(objective, start);
  Eigen::VectorXd point = start.point;
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&residuals, nullptr, point.data());
  for (int j = 0; j < static_cast<int>(space.dimension()); ++j) {
    problem.SetParameterLowerBound(point.data(), j, space.lower()[j]);
    problem.SetParameterUpperBound(point.data(), j, space.upper()[j]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 50;
  options.max_num_consecutive_invalid_steps = 6;
  options.initial_trust_region_radius = 10;
  const double chi2 = objective.misfit().residuals(start).chi2;
  options.function_tolerance = std::clamp(objective.budget().tolerance / std::max(chi2, 1e-12), 1e-12, 0.1);
  options.parameter_tolerance = objective.choice().step / 100;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  residuals.rethrow();
  const bool converged = !residuals.spent() && summary.termination_type == ceres::CONVERGENCE;
  return {.best = residuals.best(),
          .converged = converged,
          .reason = residuals.spent() ? "the budget of runs is spent" : summary.message,
          .model = residuals.model()};
}

}  // namespace kerf::inverse
