#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/chip/least_squares.hpp"

namespace kerf::chip {

/// Least chi2 with the values that give it. chi2 is infinite when no start can be evaluated.
struct Minimum {
  std::vector<double> values;
  double chi2 = std::numeric_limits<double>::infinity();
  bool converged = false;
};

/// Bounded Levenberg-Marquardt (Ceres) from `start`; the unknown `held`, if any, stays where it starts.
Minimum minimise(const LeastSquares& problem, std::vector<double> start, std::optional<int> held = {});

/// One Gauss-Newton step from a minimum that was found by comparing chi2, which fixes only half of the digits. Returns
/// `minimum` itself where the step would leave the bounds or raise chi2.
Minimum polish(const LeastSquares& problem, const Minimum& minimum);

/// Sum of squared residuals; infinite where they are undefined.
double chi2_at(const LeastSquares& problem, const std::vector<double>& values);

/// Residuals, and their derivatives by columns; NaN where undefined.
struct Linearised {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd jacobian;
};
Linearised linearise(const LeastSquares& problem, const std::vector<double>& values);

/// Inverse of J^T J, with NaN for unknowns that take part in a combination J does not see: no pseudo-inverse, which
/// would give such a pair a small variance.
struct Covariance {
  Eigen::MatrixXd matrix;
  std::vector<double> singular_values;  ///< of J with its columns scaled to one
};
Covariance covariance(const Eigen::MatrixXd& jacobian);

/// Limits at which the least chi2 over all the other unknowns has risen by `rise` above the minimum; infinite when it
/// never does. `best` is replaced if the walk comes upon a lower minimum; the limits then belong to the new one.
struct Limits {
  double lower, upper;
};
Limits profile(const LeastSquares& problem, Minimum& best, int unknown, double rise, const Eigen::MatrixXd& covariance);

}  // namespace kerf::chip
