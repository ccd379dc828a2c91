#pragma once

#include <ceres/autodiff_cost_function.h>
#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/chip/measured_cut.hpp"

namespace kerf::chip {

// Weighted least squares with intervals that mean what they say. Estimates are free to leave the physical range (a
// toughness may come out as -2 +- 5): held at zero they would be biased and their neighbours' intervals too short. What
// such an estimate says is put into words by its verdict and a one-sided interval.

/// What a fit looks for.
struct Unknown {
  std::string name;
  std::string unit;                                         ///< to print it in
  double lower = -std::numeric_limits<double>::infinity();  ///< where the equations stop making sense
  double upper = std::numeric_limits<double>::infinity();
  bool positive = true;  ///< physically not below zero
};

/// Residuals are differences over standard errors (or plain differences when errors are unknown).
struct LeastSquares {
  std::vector<Unknown> unknowns;
  std::shared_ptr<const ceres::CostFunction> residuals;  ///< one block with all unknowns; false where undefined
  std::vector<std::vector<double>> starts;               ///< the best minimum of all starts counts
  Noise noise;
  int nuisances = 0;  ///< the last unknowns are not reported; as many of the last residuals are what is known of them
};

/// What the cuts say about one parameter.
enum class Verdict {
  measured,        ///< both limits within half of the value
  bounded,         ///< both limits exist, but wide
  bounded_below,   ///< could be any larger value
  bounded_above,   ///< could be any smaller value
  zero,            ///< indistinguishable from zero: at most the upper limit
  negative,        ///< significantly below zero where physics allows none: the model is wrong
  not_measurable,  ///< no limits at all, or as many parameters as data
};

struct FittedParameter {
  std::string name;
  std::string unit;             ///< to print it in
  double value = 0.0;           ///< consistent units, also below
  double standard_error = 0.0;  ///< NaN when the data do not determine it
  double lower = 0.0;           ///< 95 % profile-likelihood interval, cut to the physical range; infinite: no limit
  double upper = 0.0;
  Verdict verdict = Verdict::not_measurable;
};

/// "indistinguishable from zero"
std::string in_words(Verdict verdict);

struct Fit {
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd correlation;          ///< of `parameters`; NaN where undetermined
  std::vector<double> singular_values;  ///< of the Jacobian with unit columns: one near zero marks a combination of
                                        ///< parameters that the data do not see
  double chi2 = 0.0;                    ///< at the minimum: sum of squared residuals
  int data = 0;                         ///< number of measured forces
  int freedom = 0;                      ///< data less parameters
  Noise noise;
  double scatter = 1.0;           ///< sqrt(chi2/freedom): about one if errors are right; N/mm when they are unknown
  std::optional<double> p_value;  ///< chance of a chi2 this large if the model were right; needs measured errors
  std::optional<double> aicc;     ///< compare only among fits to the same data; none without data to spare
  bool converged = false;

  bool determined() const { return freedom > 0; }
  bool rejected() const { return p_value && *p_value < 0.05; }
  const FittedParameter* find(std::string_view name) const;
  std::vector<double> values;  ///< all unknowns, nuisances included
};

/// Minimum, covariance, profile likelihood and verdicts. With unknown errors the intervals follow Student's t with the
/// fit's degrees of freedom, with measured ones t with those of the repeats.
Fit solve(const LeastSquares& problem);

/// Wraps a functor `bool operator()(const T* unknowns, T* residuals) const` for any T; derivatives are automatic.
template <int unknowns, class Residuals>
std::shared_ptr<const ceres::CostFunction> residual_block(Residuals residuals, int count) {
  using Cost = ceres::AutoDiffCostFunction<Residuals, ceres::DYNAMIC, unknowns>;
  return std::make_shared<Cost>(new Residuals(std::move(residuals)), count);  // Ceres takes ownership
}

}  // namespace kerf::chip
