#pragma once

#include <nlohmann/json.hpp>

#include "inverse/calibration.hpp"

namespace kerf::inverse {

/// What a calibration cost.
struct CalibrationCost {
  std::size_t runs = 0;         ///< distinct simulated cuts behind the answer
  std::size_t failed_runs = 0;  ///< of these, refused or failed
  std::size_t record_runs = 0;  ///< simulated again at the end, to keep the cuts at the estimate in full
  double core_seconds = 0;      ///< of `runs`
  double wall_seconds = 0;      ///< of all sessions
};

/// DIR/result.json:
/// - "parameters": NAME -> value, se, interval (95 %), unit, verdict, path, and interval_over_assumptions when edge
///   assumptions were compared. NAME is the last part of the path (yield_stress, toughness; "friction" for
///   friction.coefficient; "edge_force" for F_b), or the whole path when two would share it.
/// - "alternatives": assumption, parameters, chi2, ... of the same fit under the other edge assumption
/// - "identifiability": singular values of the weighted Jacobian by ln(parameter), their right singular vectors (one
/// row
///   each, components in the order of "names"), correlation
/// - "error_budget": NAME -> share of its variance by source: measurement, specimen, simulation (its standard errors),
///   discrepancy, prior, unexplained (misfit above the stated errors); null for what the data do not see
/// - "cuts": what was measured, simulated and fitted (simulated plus edge force) at every cut of the estimate,
/// residuals
///   (measured - fitted) in standard errors, acceptance; "fitted_se" is the standard error of the fitted value that
///   follows from those of the parameters, "residual_sd" the standard deviation of measured - fitted
/// - "trace": the search, "statement": what is and is not determined, "exit_code", "converged", "reason", ...
/// - "stopped_at": NAME -> value, unit, path where a search without slopes stopped, whose "parameters" are empty
/// - "partial": true when the user stopped the search, else absent
/// A number that is not finite (the error of a parameter the data do not see) is null. Forces per width are in N/m.
nlohmann::ordered_json calibration_json(const Job& job, const Calibration& calibration, const CalibrationCost& cost);

}  // namespace kerf::inverse
