#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "inverse/misfit.hpp"
#include "inverse/parameter_space.hpp"
#include "inverse/run_database.hpp"

namespace kerf::inverse {

/// Thrown instead of a run that the budget does not cover.
struct BudgetSpent {};

/// One step of a search, for the report.
struct TraceEntry {
  std::string what;  ///< "start", "differences", "trial accepted", ...
  std::size_t runs = 0;
  double chi2 = 0;
  Eigen::VectorXd point;
  double edge_force = 0;
  std::size_t failed_cuts = 0;
};

/// What a search may ask: simulated cuts at points of the parameter space, and the misfit they mean.
class Objective {
 public:
  /// All references outlive the objective. `max_runs` counts distinct runs of the database.
  Objective(const Job& job, const ParameterSpace& space, Misfit& misfit, RunDatabase& database, std::size_t max_runs);

  const ParameterSpace& space() const { return space_; }
  Misfit& misfit() { return misfit_; }
  const Misfit& misfit() const { return misfit_; }
  const Budget& budget() const { return job_.budget; }
  const OptimiserChoice& choice() const { return job_.optimiser; }
  std::size_t cuts() const { return job_.cuts.size(); }

  /// All cuts at every point, as one batch. Throws BudgetSpent before the first run of a batch it cannot pay.
  std::vector<Evaluation> evaluate(const std::vector<Eigen::VectorXd>& points);
  Evaluation evaluate(const Eigen::VectorXd& point) { return evaluate(std::vector{point}).front(); }

  /// Single cuts, as one batch.
  struct Probe {
    Eigen::VectorXd point;
    std::size_t cut;
  };
  std::vector<RunRecord> simulate(const std::vector<Probe>& probes);

  /// Remembers a step of the search and reports it as progress.
  void trace(std::string what, const Evaluation& at);
  const std::vector<TraceEntry>& trace() const { return trace_; }
  /// The traced point of the smallest misfit among those where the fewest cuts failed, if any was traced.
  const std::optional<Evaluation>& best() const { return best_; }
  std::function<void(const TraceEntry&)> on_trace;

  /// Changes what may be spent in all.
  void limit(std::size_t max_runs) { max_runs_ = max_runs; }

  /// Share of the cuts that failed.
  double failing_share(const Evaluation& evaluation) const;

 private:
  RunRequest request(const Eigen::VectorXd& point, std::size_t cut) const;

  const Job& job_;
  const ParameterSpace& space_;
  Misfit& misfit_;
  RunDatabase& database_;
  std::size_t max_runs_;
  std::vector<TraceEntry> trace_;
  std::optional<Evaluation> best_;
};

}  // namespace kerf::inverse
