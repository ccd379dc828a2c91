#pragma once

#include <Eigen/Core>
#include <vector>

namespace kerf::inverse {

/// How far values depart from a smooth plane, on the scale of their changes and per search coordinates.
struct Texture {
  double roughness = 0;  ///< standard deviation that no two values share
  double ripple = 0;     ///< standard deviation that values share with those much nearer than ripple_length
  double bend = 1;       ///< curvature and third order, in multiples of the usual ones
};

/// How a quantity with a texture answers small steps d of the parameters, from its changes over any number of such
/// steps,
///     y(d) - y(0) = g d + d^T H d / 2 + errors,                                                             (1)
/// with slopes g of any size and curvatures H that are no larger than usual unless the data say so: Gaussian priors, of
/// a logarithm per square of a search coordinate. Errors are roughness, ripples and terms of third order, each with
/// that of y(0) in common to all changes; neighbours far away share their terms of third order. The posterior mean is
/// linear in the changes, so one and the same operator serves all quantities seen over the same steps (a Gaussian
/// process with a polynomial kernel: Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, sec. 2.1).
class QuadraticResponse {
 public:
  static constexpr double any_slope = 30, usual_curvature = 0.4, usual_third_order = 0.4;
  /// Assumed, for all materials: between the longest difference, 0.15, over which chips mostly swing alike, and the
  /// reach of a parabola.
  static constexpr double ripple_length = 0.3;

  /// `steps`: one per row, none of length zero. A quantity that is no logarithm has its texture on its own scale.
  QuadraticResponse(const Eigen::MatrixXd& steps, const Texture& texture);

  Eigen::VectorXd slopes(const Eigen::VectorXd& changes) const;
  /// H, symmetric.
  Eigen::MatrixXd curvatures(const Eigen::VectorXd& changes) const;

  /// -2 ln of the density of such changes under (1), but for a constant.
  double unlikeliness(const Eigen::VectorXd& changes) const;

  /// Standard errors of the slopes: all that is not known of them.
  const Eigen::VectorXd& slope_errors() const { return slope_errors_; }
  /// What roughness and ripples contribute to them, in common for several where the steps leave their sum best known.
  const Eigen::MatrixXd& rough_covariance() const { return rough_covariance_; }

 private:
  Eigen::Index parameters_;
  Eigen::MatrixXd design_;   ///< changes from the terms of (1)
  Eigen::MatrixXd weights_;  ///< inverse of the covariance of the errors in (1)
  Eigen::VectorXd information_of_priors_;
  Eigen::MatrixXd mean_;  ///< (slopes, then H_00, H_10, H_11, H_20 ...) from the changes
  Eigen::VectorXd slope_errors_;
  Eigen::MatrixXd rough_covariance_;
  double log_volume_ = 0;  ///< ln of the determinant of the changes' covariance
};

/// Changes of one quantity over steps from one place, and the texture that it is said to have.
struct ResponseSample {
  Eigen::MatrixXd steps;
  Eigen::VectorXd changes;
  Texture said;
};

/// The textures that make samples of alike quantities likeliest, with the ripples that were said (type II maximum
/// likelihood with priors: sec. 5.4 of the same book). First all get rougher and more bent than said by the same
/// factors, which they know together and not alone, then each by its own, both for good reasons only.
std::vector<Texture> likeliest_textures(const std::vector<ResponseSample>& samples);

}  // namespace kerf::inverse
