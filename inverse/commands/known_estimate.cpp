#include "inverse/commands/known_estimate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "inverse/calibration.hpp"
#include "inverse/child_runs.hpp"
#include "inverse/closed_form_cut.hpp"
#include "inverse/folder.hpp"
#include "inverse/optimiser.hpp"
#include "inverse/seen_slopes.hpp"
#include "inverse/start.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using namespace inverse;

constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// A journal that only this process wants.
class ScratchFile {
 public:
  ScratchFile() : path_(fs::temp_directory_path() / fmt::format("kerf_{}.jsonl", ::getpid())) {}
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void use_slopes(const Job& job, RunDatabase& database, const Eigen::VectorXd& point,
                const std::optional<LocalModel>& known, const std::string& where,
                const std::function<void(const KnownEstimate&)>& use) {
  const ParameterSpace space(job);
  Misfit misfit(job, space);
  Objective objective(job, space, misfit, database, no_limit);
  const Evaluation at = objective.evaluate(point);
  misfit.include_simulation_errors(at);
  const LocalModel model = known ? *known : seen_slopes(LocalModel::by_differences(objective, at), misfit);
  if (count(model.known()) == 0) throw InputError(where + ": no cut has slopes at the estimate");
  use({.job = job, .model = model, .misfit = misfit, .slopes_of = [&](const Job& other) {
         const ParameterSpace other_space(other);
         Misfit other_misfit(other, other_space);
         Objective other_objective(other, other_space, other_misfit, database, no_limit);
         return LocalModel::by_differences(other_objective, other_objective.evaluate(point));
       }});
}

/// Where the closed form in the place of the simulation fits the job's cuts best. Throws InputError where it does not
/// describe them at all.
Eigen::VectorXd closed_form_fit(const Job& job, RunDatabase& database, const std::string& where) {
  constexpr double most = 25;  // chi^2 per degree of freedom: residuals of five standard errors
  const std::string way_out = "; give the folder of a finished calibration, whose simulations take its place";
  if (std::any_of(job.cuts.begin(), job.cuts.end(), [](const MeasuredCut& cut) { return cut.extension.has_value(); }))
    throw InputError(where + ": the closed form knows no R-curve" + way_out);
  const ParameterSpace space(job);
  Misfit misfit(job, space);
  Objective objective(job, space, misfit, database, no_limit);
  const Evaluation start = objective.evaluate(find_start(job, space).point);
  if (count(start.usable) == 0)
    throw InputError(fmt::format("{}: {}{}", where,
                                 start.runs.front().refusals.empty() ? "the closed form has no forces here"
                                                                     : start.runs.front().refusals.front(),
                                 way_out));
  const SearchResult found = gauss_newton(objective, start);
  const Residuals left = misfit.residuals(found.best);
  const int freedom = left.compared - static_cast<int>(space.dimension()) - (job.edge_force ? 1 : 0);
  if (left.chi2 > most * std::max(1, freedom))
    throw InputError(
        fmt::format("{}: the closed form does not describe these cuts (chi2 = {:.3g} on {} degrees of "
                    "freedom){}",
                    where, left.chi2, freedom, way_out));
  return found.best.point;
}

}  // namespace

void with_known_estimate(const fs::path& job_or_folder, const std::string& code,
                         const std::function<void(const KnownEstimate&)>& use) {
  if (fs::is_directory(job_or_folder)) {
    if (!Folder::holds_one(job_or_folder))
      throw InputError(
          fmt::format("{}: holds no calibration; give a job, or the directory that `kerf calibrate -o` wrote",
                      job_or_folder.string()));
    if (!fs::exists(job_or_folder / "result.json"))
      throw InputError(fmt::format("{}: holds no finished calibration; `kerf resume {}` goes on with it",
                                   job_or_folder.string(), job_or_folder.string()));
    Folder folder = Folder::open(job_or_folder, {}, code);
    ChildRuns runs(run_command(), folder.path() / "runs", folder.job().budget, [] { return false; });
    const auto tell = [](const RunRequest& request, const RunRecord& record) {
      fmt::print(stderr, "  {}: {} ({:.1f} s)\n", request.label, record.accepted ? "simulated" : "refused",
                 record.wall_seconds);
    };
    RunDatabase database(folder.journal(), code, std::ref(runs), folder.job().budget.parallel,
                         {.batch_begins = {}, .run_ends = tell});
    const Calibration calibration = calibrate(folder.job(), database);
    Job job = folder.job();
    job.optimiser = calibration.choice;  // whose steps the journal has
    return use_slopes(job, database, calibration.fit.at.point, calibration.fit.model, job_or_folder.string(), use);
  }
  Job job = read_job(job_or_folder);
  job.optimiser.roughness = 0;
  const ScratchFile scratch;
  Journal journal(scratch.path());
  RunDatabase database(journal, code, closed_form_cut, 1);
  use_slopes(job, database, closed_form_fit(job, database, job_or_folder.string()), {}, job_or_folder.string(), use);
}

}  // namespace kerf::commands
