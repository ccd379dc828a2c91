#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "inverse/local_model.hpp"

namespace kerf::inverse {

enum class Verdict { measured, bounded, bounded_above, bounded_below, not_measurable };
/// "measured", "bounded above and below", "bounded above", "bounded below", "not measurable with these cuts".
const char* name(Verdict verdict);

struct Interval {
  double lower = 0, upper = 0;
};

/// What the data say about one parameter; consistent units.
struct ParameterEstimate {
  std::string name, path;
  std::string unit;  ///< to show it in
  bool key = false;
  double value = 0;
  double standard_error = 0;  ///< infinite when the data do not see the parameter
  Interval interval;          ///< 95 %, by profile
  Interval bounds;            ///< what was searched
  Verdict verdict = Verdict::not_measurable;
};

/// What the data say about all of them, to first order about the estimate.
struct Identifiability {
  std::vector<ParameterEstimate> parameters;  ///< the free ones in the job's order, then the edge force
  double chi2 = 0;
  int degrees_of_freedom = 0;
  double error_scale = 1;  ///< sqrt(chi2/dof) when above 1: standard errors and intervals contain this factor
  double quantile = 1.96;  ///< half width of a 95 % interval in standard errors: Student's t when scaled, else normal
  Eigen::VectorXd singular_values;   ///< of the weighted Jacobian by ln(parameter), falling; 1/s is the log error
  Eigen::MatrixXd singular_vectors;  ///< right ones, one per column
  Eigen::MatrixXd correlation;       ///< NaN where a parameter is not seen at all

  const ParameterEstimate* find(const std::string& name) const;
};

/// Standard errors from the weighted Jacobian (singular values shown, never a pseudo-inverse: a combination the data do
/// not see has an infinite error), 95 % intervals from the profile of the misfit over the local model, and a verdict
/// from both. A parameter is measured when its relative standard error is at most a third and its interval keeps away
/// from the bounds of the search.
Identifiability identify(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space);

/// The verdict on an interval inside bounds.
Verdict judge(double value, double standard_error, const Interval& interval, const Interval& bounds);

}  // namespace kerf::inverse
