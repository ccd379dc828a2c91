#include "inverse/commands/known_estimate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <limits>

#include "inverse/calibration.hpp"
#include "inverse/child_runs.hpp"
#include "inverse/closed_form_cut.hpp"
#include "inverse/folder.hpp"
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
  use_slopes(job, database, find_start(job, ParameterSpace(job)).point, {}, job_or_folder.string(), use);
}

}  // namespace kerf::commands
