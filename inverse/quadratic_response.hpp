#pragma once

#include <Eigen/Core>

namespace kerf::inverse {

/// How a rough quantity answers small steps d of the parameters, from its changes over any number of such steps,
///     y(d) - y(0) = g d + d^T H d / 2 + errors,                                                             (1)
/// with slopes g of any size and curvatures H that are no larger than usual unless the data say so: Gaussian priors, of
/// a logarithm per square of a search coordinate. Every value has a roughness of its own, that of y(0) is common to all
/// changes, and terms of third order count as errors, the same for neighbours far away. The posterior mean is
/// linear in the changes, so one and the same operator serves all quantities seen over the same steps (regression by a
/// polynomial kernel: Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, sec. 2.1).
class QuadraticResponse {
 public:
  static constexpr double any_slope = 30, usual_curvature = 0.4, usual_third_order = 0.4;

  /// `steps`: one per row, none of length zero. `roughness` >= 0, of a logarithm; a quantity of another scale has its
  /// errors on that scale.
  QuadraticResponse(const Eigen::MatrixXd& steps, double roughness);

  Eigen::VectorXd slopes(const Eigen::VectorXd& changes) const;
  /// H, symmetric.
  Eigen::MatrixXd curvatures(const Eigen::VectorXd& changes) const;

  /// By what factor the changes exceed what (1), its priors and the roughness let expect: errors are as much larger.
  /// At least 1, which it is where the runs are no more than the slopes.
  double surprise(const Eigen::VectorXd& changes) const;

  /// Standard errors of the slopes: all that is not known of them.
  const Eigen::VectorXd& slope_errors() const { return slope_errors_; }
  /// What roughness alone contributes to them, in common for several where the steps leave their sum best known.
  const Eigen::MatrixXd& rough_covariance() const { return rough_covariance_; }

 private:
  Eigen::Index parameters_;
  Eigen::MatrixXd design_;   ///< changes from the terms of (1)
  Eigen::MatrixXd weights_;  ///< inverse of the covariance of the errors in (1)
  Eigen::VectorXd information_of_priors_;
  Eigen::MatrixXd mean_;  ///< (slopes, then H_00, H_10, H_11, H_20 ...) from the changes
  Eigen::VectorXd slope_errors_;
  Eigen::MatrixXd rough_covariance_;
};

}  // namespace kerf::inverse
