#pragma once

#include <string>
#include <vector>

#include "inverse/error_propagation.hpp"
#include "inverse/identifiability.hpp"
#include "inverse/job.hpp"
#include "inverse/left_out.hpp"
#include "inverse/noise_audit.hpp"
#include "inverse/numerics_check.hpp"
#include "inverse/optimiser.hpp"
#include "inverse/posterior.hpp"
#include "inverse/run_database.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {

/// The answer under one assumption about the edge force.
struct Fit {
  std::string assumption;  ///< "edge force without a part in F_c", ...
  std::optional<CuttingShare> share;
  Evaluation at;
  Residuals residuals;
  Observations residual_errors;  ///< standard deviations of measured - simulated
  Identifiability identifiability;
  std::vector<std::optional<VarianceShares>> error_budget;  ///< see error_budget()
  Observations fitted_errors;                               ///< see fitted_errors(); empty without slopes
  CutMask at_jump;  ///< cuts that a step, or parameters which the data allow, moved to another branch; or empty
  Resampling resampling;
  std::optional<Posterior> posterior;  ///< none: the job did not ask for it, or there are no slopes
  std::optional<LocalModel> model;     ///< seen_slopes() about `at`; none: the budget did not allow the differences
  bool converged = false;
  std::string reason;
};

/// Everything a calibration found out.
struct Calibration {
  Fit fit;
  std::vector<Fit> alternatives;  ///< the other edge assumptions, fitted to the same runs and some more
  std::vector<TraceEntry> trace;
  Eigen::VectorXd start;
  std::string start_origin;             ///< where the start values come from, in words
  OptimiserChoice choice;               ///< as the job says, or as the audit found
  std::optional<NoiseAudit> audit;      ///< none: the job did not ask for it or the budget did not cover it
  std::vector<NumericsShift> numerics;  ///< what the estimates owe to the scene's numerical choices
  double failing_share = 0;             ///< of the cuts at the estimate
  bool partial = false;                 ///< stopped by the user: the best point so far, usually without errors
  ExitCode exit_code = ExitCode::success;
  std::string statement;  ///< what is and what is not determined, in plain English
};

/// Fits the job's free parameters to its curves by simulation. Deterministic: with equal runs in the database, from the
/// journal or fresh, the answer is bitwise the same. Spends at most job.budget.max_runs distinct runs. When the
/// simulator throws Interrupted the answer is partial; Interrupted passes if not a single point was simulated by then.
Calibration calibrate(const Job& job, RunDatabase& database,
                      const std::function<void(const TraceEntry&)>& on_trace = {});

/// The interval of a parameter over all edge assumptions: what may be claimed without knowing the edge.
Interval over_all_assumptions(const Calibration& calibration, const std::string& name);

}  // namespace kerf::inverse
