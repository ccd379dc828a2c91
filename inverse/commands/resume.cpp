#include <fmt/format.h>

#include <memory>
#include <string>

#include "inverse/backend.hpp"
#include "inverse/commands/calibration_session.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/job_study_session.hpp"
#include "inverse/commands/stop.hpp"
#include "inverse/commands/study_session.hpp"
#include "inverse/commands/sweep_session.hpp"

namespace kerf::commands {

void add_resume(CLI::App& app, int& exit_code) {
  struct Options {
    std::string folder;
    inverse::JobOverride changes;
    double max_seconds = 0;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("resume", "Go on with a calibration, sweep or study that was stopped or killed");
  command->add_option("folder", options->folder, "folder of the calibration, sweep or study")->required();
  command->add_option("-j,--jobs,--parallel", options->changes.parallel, "simulations at a time")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-runs", options->changes.max_runs, "simulated cuts at most, of a calibration")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--max-time", options->max_seconds,
                   "stop a calibration cleanly after this time, s or with a unit: 2h")
      ->transform(CLI::AsNumberWithUnit(time_units()));
  command->add_option("--runs", options->changes.shared_runs, "folder of runs shared by jobs: none is made twice");
  command->add_option("--backend", options->changes.backend, "where runs of a calibration live: local or slurm")
      ->check(CLI::IsMember(inverse::backend_names()));
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer("No finished run is repeated, and the answer is the one an undisturbed session gives, to the bit.");
  command->callback([options, &exit_code] {
    const std::string code = inverse::code_identity();
    if (const std::string kind = inverse::SceneFolder::kind_of(options->folder); !kind.empty()) {
      if (options->changes.max_runs > 0)
        throw InputError(fmt::format("kerf resume: --max-runs belongs to calibrations; a {} has all its runs", kind),
                         ExitCode::usage);
      inverse::SceneFolder folder = inverse::SceneFolder::open(options->folder, options->changes.parallel, code);
      exit_code = static_cast<int>(kind == "study" ? run_study(folder, study_in(folder), code, options->json)
                                                   : run_sweep(folder, sweep_in(folder), code, options->json));
      return;
    }
    if (holds_job_study(options->folder)) {
      exit_code = static_cast<int>(resume_job_study(options->folder, options->changes, code, options->json));
      return;
    }
    inverse::Folder folder = inverse::Folder::open(options->folder, options->changes, code);
    exit_code =
        static_cast<int>(run_session(folder, code, options->json ? Show::json : Show::table, options->max_seconds));
  });
}

}  // namespace kerf::commands
