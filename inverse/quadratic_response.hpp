#pragma once

#include <Eigen/Core>

namespace kerf::inverse {

/// How a rough quantity answers small steps d of the parameters, from its changes over any number of such steps,
///     y(d) - y(0) = g d + d^T H d / 2 + errors,                                                             (1)
/// with slopes g of any size and curvatures H that are no larger than usual unless the data say so: Gaussian priors, of
/// a logarithm per square of a search coordinate. Every value has a roughness of its own, that of y(0) is common to all
/// changes, and terms of third order count as errors that grow with the length of the step. The posterior mean is
/// linear in the changes, so one and the same operator serves all quantities seen over the same steps (regression by a
/// polynomial kernel: Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, sec. 2.1).
class QuadraticResponse {
 public:
  static constexpr double any_slope = 30, usual_curvature = 0.4;

  /// `steps`: one per row, none of length zero. `roughness` >= 0, on the scale of the quantity.
  QuadraticResponse(const Eigen::MatrixXd& steps, double roughness);

  Eigen::VectorXd slopes(const Eigen::VectorXd& changes) const;
  /// H, symmetric.
  Eigen::MatrixXd curvatures(const Eigen::VectorXd& changes) const;

  /// Standard errors of the slopes: all that is not known of them, and what roughness alone contributes.
  const Eigen::VectorXd& slope_errors() const { return slope_errors_; }
  const Eigen::VectorXd& rough_errors() const { return rough_errors_; }

 private:
  Eigen::Index parameters_;
  Eigen::MatrixXd mean_;  ///< (slopes, then H_00, H_10, H_11, H_20 ...) from the changes
  Eigen::VectorXd slope_errors_, rough_errors_;
};

}  // namespace kerf::inverse
