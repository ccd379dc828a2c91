#include <algorithm>
#include <utility>

#include "forward/scene/scene.hpp"
#include "inverse/closed_form_cut.hpp"
#include "inverse/fidelity_correction.hpp"
#include "inverse/optimiser.hpp"

namespace kerf::inverse {
namespace {

constexpr int most_corrections = 8;
// A coarse step that gains less than half a standard error is left to the next correction.
constexpr double coarse_tolerance = 0.25;

RunRecord shear_plane(const Document& scene) {
  return summarise(closed_form_cut(forward::read_scene(scene)));
}

/// The job with its coarse scene, and its own objective on the same database.
class CoarseModel {
 public:
  CoarseModel(Objective& fine, Misfit& misfit)
      : job_(coarse(fine.job())), space_(job_), objective_(job_, space_, misfit, fine.database(), fine.limit()) {
    OptimiserChoice choice = fine.choice();
    choice.confirm = false;
    objective_.choose(choice);
    objective_.fidelity = "coarse, ";
    if (job_.coarse.closed_form) objective_.closed_form = shear_plane;
    objective_.on_trace = [&fine](const TraceEntry& entry) { fine.pass_on("coarse: ", entry); };
  }

  Objective& objective() { return objective_; }

  /// What is simulated, without the correction; a closed form knows no branches and takes those of `fine`.
  Evaluation raw_like(const Evaluation& fine) {
    const auto kept = std::exchange(objective_.correct, nullptr);
    if (job_.coarse.closed_form)
      objective_.correct = [&](const Objective::Probe& probe, RunRecord& run) {
        run.branch = fine.runs[probe.cut].branch;
      };
    Evaluation raw;
    try {
      raw = objective_.evaluate(fine.point);
    } catch (...) {
      objective_.correct = kept;
      throw;
    }
    objective_.correct = kept;
    return raw;
  }

  void correct_by(const FidelityCorrection& correction, const Evaluation& fine) {
    objective_.correct = [&correction, &fine, this](const Objective::Probe& probe, RunRecord& run) {
      if (job_.coarse.closed_form) run.branch = fine.runs[probe.cut].branch;
      correction.apply(probe.point, probe.cut, run);
    };
  }

 private:
  static Job coarse(Job job) {
    job.scene = job.coarse.scene;
    job.budget.tolerance = std::max(job.budget.tolerance, coarse_tolerance);
    return job;
  }

  Job job_;
  ParameterSpace space_;
  Objective objective_;
};

}  // namespace

SearchResult multi_fidelity(Objective& objective, const Evaluation& start) {
  Misfit misfit = objective.misfit();
  CoarseModel coarse(objective, misfit);
  Evaluation best = start;
  std::vector<Evaluation> fine{start};
  std::optional<LocalModel> slopes;
  try {
    FidelityCorrection correction(start, coarse.raw_like(start));
    coarse.correct_by(correction, best);
    int refused = 0;
    for (int i = 0; i < most_corrections && refused < 2; ++i) {
      const Evaluation from = coarse.objective().evaluate(best.point);
      if (coarse.objective().failing_share(from) > objective.budget().failing_share) break;
      if (slopes) slopes->borrow_for(from);
      const SearchResult found =
          slopes ? gauss_newton(coarse.objective(), *slopes) : gauss_newton(coarse.objective(), from);
      if (found.model) slopes = found.model;
      const double promise = misfit.chi2(from, both(from.usable, found.best.usable)) -
                             misfit.chi2(found.best, both(from.usable, found.best.usable));
      const double worthwhile = objective.worthwhile(best);
      if (promise <= worthwhile) break;
      const Evaluation trial = objective.evaluate(found.best.point);
      fine.push_back(trial);
      const CutMask common = both(best.usable, trial.usable);
      const bool enough = static_cast<double>(count(common)) >=
                          (1 - objective.budget().failing_share) * static_cast<double>(objective.cuts());
      const bool better = enough && misfit.chi2(best, common) - misfit.chi2(trial, common) > worthwhile;
      correction.learn(trial, coarse.raw_like(trial), better);
      refused = better ? 0 : refused + 1;
      if (better) best = trial;
      objective.trace(better ? "fine run at the coarse minimum" : "fine run at the coarse minimum refused", trial);
    }
  } catch (const BudgetSpent&) {
    return {.best = best, .converged = false, .reason = "the budget of runs is spent", .model = {}};
  }
  if (!slopes) return gauss_newton(objective, best);
  slopes->borrow_for(best);
  for (const Evaluation& known : fine) slopes->learn(known);
  return gauss_newton(objective, *slopes);
}

}  // namespace kerf::inverse
