#pragma once

#include <array>
#include <optional>
#include <vector>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {

/// Where the variance of one estimate comes from, as shares that add up to 1.
struct VarianceShares {
  std::array<double, error_source_count> source{};
  double unexplained = 0;  ///< what the misfit above the stated errors adds (error_scale)
};

/// The variance of every parameter, then of every derived quantity, source by source: with G = (J^T J)^-1 J^T, by which
/// the estimator answers to whitened errors, and L_s the errors of a source (Misfit::whitened_errors), the covariance
/// of the estimates is sum_s G L_s L_s^T G^T. None for what the data do not see.
std::vector<std::optional<VarianceShares>> error_budget(const Identifiability& known, const Misfit& misfit,
                                                        const CutMask& mask);

/// Standard errors of the fitted values that follow from those of the parameters, to first order: the band about the
/// fitted curve. It does not contain the scatter of a further measurement.
Observations fitted_errors(const Identifiability& known, const LocalModel& model, const Misfit& misfit,
                           const ParameterSpace& space);

}  // namespace kerf::inverse
