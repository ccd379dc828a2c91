#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "inverse/local_model.hpp"

namespace kerf::inverse {

enum class Verdict { measured, bounded, bounded_above, bounded_below, not_measurable };
/// "measured", "bounded above and below", "bounded above", "bounded below", "not measurable with these cuts".
const char* name(Verdict verdict);

struct Interval {
  double lower = 0, upper = 0;
};

/// An end of a 95 % interval: where the other parameters go, and the misfit there.
struct ProfileEnd {
  Eigen::VectorXd point;
  double predicted = 0;             ///< chi^2 of the local model
  std::optional<double> simulated;  ///< chi^2 of real simulations, where they were paid for
};

/// parameter * partner^exponent is what the data know, to a relative standard error.
struct TradeOff {
  std::string partner;
  double exponent = 0;
  double relative_error = 0;
};

/// What the data say about one parameter, or about a quantity that follows from them; consistent units.
struct ParameterEstimate {
  std::string name, path;
  std::string unit;  ///< to show it in
  bool key = false;
  double value = 0;
  double standard_error = 0;   ///< infinite when the data do not see the parameter
  Eigen::VectorXd slope = {};  ///< d value / d ln(parameter) of all parameters, F_b last
  Interval interval;           ///< 95 %, by profile
  Interval bounds;             ///< what was searched
  Verdict verdict = Verdict::not_measurable;
  std::optional<ProfileEnd> lower_end = {}, upper_end = {};  ///< where the interval ends inside the bounds
  std::optional<TradeOff> trade_off = {};
  std::vector<std::pair<double, double>> profile = {};  ///< value, least chi^2 with it held; drawn when asked for
};

/// What the data say about all of them, to first order about the estimate.
struct Identifiability {
  std::vector<ParameterEstimate> parameters;  ///< the free ones in the job's order, then the edge force
  std::vector<ParameterEstimate> derived;     ///< the job's derived quantities; `path` is the expression
  double chi2 = 0;
  int degrees_of_freedom = 0;
  double error_scale = 1;    ///< sqrt(chi2/dof) when above 1: standard errors and intervals contain this factor
  double quantile = 1.96;    ///< half width of a 95 % interval in standard errors: Student's t when scaled, else normal
  Eigen::MatrixXd jacobian;  ///< d weighted residual / d ln(parameter), F_b last
  Eigen::MatrixXd covariance;        ///< of the logarithms, as far as they are seen; contains error_scale^2
  Eigen::VectorXd singular_values;   ///< of the Jacobian, falling; 1/s is the log error
  double condition = 0;              ///< largest over smallest of them; infinite when a combination is not seen
  Eigen::MatrixXd singular_vectors;  ///< right ones, one per column
  Eigen::MatrixXd correlation;       ///< NaN where a parameter is not seen at all

  /// By how much chi^2 may rise within a 95 % interval.
  double allowed_rise() const { return quantile * quantile * error_scale * error_scale; }
  /// A parameter or a derived quantity.
  const ParameterEstimate* find(const std::string& name) const;
};

/// Standard errors from the weighted Jacobian (singular values shown, never a pseudo-inverse: a combination the data do
/// not see has an infinite error), 95 % intervals from the profile of the misfit over the local model, and a verdict
/// from both. A parameter is measured when its relative standard error is at most a third and its interval keeps away
/// from the bounds of the search. The estimate is where the model was simulated, unless `estimate` says otherwise.
Identifiability identify(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                         const std::vector<DerivedQuantity>& derived = {},
                         const std::optional<Eigen::VectorXd>& estimate = {});

/// Adds the profiles about every interval, for a picture.
void add_profiles(Identifiability& known, const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                  const std::vector<DerivedQuantity>& derived);

/// The verdict on an interval inside bounds.
Verdict judge(double value, double standard_error, const Interval& interval, const Interval& bounds);

}  // namespace kerf::inverse
