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
  double core_seconds = 0;  ///< of these runs
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
  const Job& job() const { return job_; }
  RunDatabase& database() { return database_; }
  const Budget& budget() const { return job_.budget; }
  /// As the job says, or as the noise audit found.
  const OptimiserChoice& choice() const { return choice_; }
  void choose(const OptimiserChoice& choice) { choice_ = choice; }
  std::size_t cuts() const { return job_.cuts.size(); }
  double depth(std::size_t cut) const { return job_.cuts[cut].depth; }

  /// All cuts at every point, as one batch. Throws BudgetSpent before the first run of a batch it cannot pay.
  std::vector<Evaluation> evaluate(const std::vector<Eigen::VectorXd>& points);
  Evaluation evaluate(const Eigen::VectorXd& point) { return evaluate(std::vector{point}).front(); }

  /// Single cuts, as one batch.
  struct Probe {
    Eigen::VectorXd point;
    std::size_t cut;
    double jitter = 0;  ///< the crack's start is moved by this many depths of cut, which a steady force cannot feel
  };
  std::vector<RunRecord> simulate(const std::vector<Probe>& probes);

  /// A cheaper answer than the simulation; such runs are neither journaled nor counted.
  std::function<RunRecord(const Document& scene)> closed_form;
  /// Changes every answer, as the correction of a coarse model does. The database keeps what was simulated.
  std::function<void(const Probe&, RunRecord&)> correct;
  std::string fidelity;  ///< begins the label of every run

  /// A decrease of chi^2 from `evaluation` below this cannot be told from nothing.
  double worthwhile(const Evaluation& evaluation) const;

  /// Remembers a step of the search and reports it as progress.
  void trace(std::string what, const Evaluation& at);
  /// Remembers a step that another objective on the same database took.
  void pass_on(const std::string& prefix, TraceEntry entry);
  const std::vector<TraceEntry>& trace() const { return trace_; }
  /// The traced point of the smallest misfit among those where the fewest cuts failed, if any was traced.
  const std::optional<Evaluation>& best() const { return best_; }
  std::function<void(const TraceEntry&)> on_trace;

  /// Changes what may be spent in all.
  void limit(std::size_t max_runs) { max_runs_ = max_runs; }
  std::size_t limit() const { return max_runs_; }

  /// Share of the cuts that failed.
  double failing_share(const Evaluation& evaluation) const;

 private:
  RunRequest request(const Probe& probe) const;

  const Job& job_;
  const ParameterSpace& space_;
  Misfit& misfit_;
  RunDatabase& database_;
  std::size_t max_runs_;
  OptimiserChoice choice_;
  std::vector<TraceEntry> trace_;
  std::optional<Evaluation> best_;
};

}  // namespace kerf::inverse
