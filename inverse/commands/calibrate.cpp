#include <memory>
#include <string>

#include "inverse/backend.hpp"
#include "inverse/commands/calibration_session.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/stop.hpp"

namespace kerf::commands {

void add_calibrate(CLI::App& app, int& exit_code) {
  struct Options {
    std::string job, output;
    inverse::JobOverride changes;
    double max_seconds = 0;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("calibrate", "Find parameters of a scene from measured curves by simulation");
  command->add_option("job", options->job, "job file (TOML)")->required();
  command->add_option("-o,--output", options->output, "folder for the journal and the results")->required();
  command->add_option("-j,--jobs,--parallel", options->changes.parallel, "simulations at a time")
      ->check(CLI::PositiveNumber);
  command->add_option("--max-runs", options->changes.max_runs, "simulated cuts at most")->check(CLI::PositiveNumber);
  command->add_option("--max-time", options->max_seconds, "stop cleanly after this time, s or with a unit: 2h")
      ->transform(CLI::AsNumberWithUnit(time_units()));
  command->add_option("--runs", options->changes.shared_runs, "folder of runs shared by jobs: none is made twice");
  command->add_option("--backend", options->changes.backend, "where runs live: local or slurm")
      ->check(CLI::IsMember(inverse::backend_names()));
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "The folder keeps every simulated cut: a calibration that was stopped or killed goes on with `kerf resume DIR`.\n"
      "Exit code 4: not converged. 5: too many cuts failed. 6: a key parameter is not measured. 130: Ctrl-C,\n"
      "--max-time or a file DIR/stop: result.json is then partial.");
  command->callback([options, &exit_code] {
    const std::string code = inverse::code_identity();
    inverse::Folder folder = inverse::Folder::create(options->output, options->job, options->changes, code);
    exit_code =
        static_cast<int>(run_session(folder, code, options->json ? Show::json : Show::table, options->max_seconds));
  });
}

}  // namespace kerf::commands
