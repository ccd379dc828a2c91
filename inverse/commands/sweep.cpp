#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "inverse/commands/commands.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/commands/sweep_session.hpp"
#include "inverse/folder.hpp"
#include "models/base/atomic_file.hpp"

namespace kerf::commands {
namespace {

struct Options {
  std::string scene, output;
  std::vector<std::string> axes;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool zip = false, no_cuts = false, dry_run = false, json = false;
};

ExitCode sweep(const Options& options) {
  const inverse::InputFile scene{.name = options.scene, .content = read_file(options.scene)};
  const inverse::Sweep sweep =
      inverse::lay_out_sweep(Document::parse(scene.content, scene.name), options.axes, options.zip, "kerf sweep");
  if (options.dry_run) {
    print_cost(inverse::requests_of(sweep), options.jobs);
    return ExitCode::success;
  }
  if (options.output.empty())
    throw InputError("kerf sweep: -o DIR is missing: a folder for the journal and the results", ExitCode::usage);
  const std::string code = inverse::code_identity();
  inverse::SceneFolder folder = inverse::SceneFolder::create(options.output, scene,
                                                             {.kind = "sweep",
                                                              .asked = {{"axes", options.axes}, {"zip", options.zip}},
                                                              .jobs = options.jobs,
                                                              .keep_cuts = !options.no_cuts},
                                                             code);
  return run_sweep(folder, sweep, code, options.json);
}

}  // namespace

void add_sweep(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("sweep", "Virtual experiments: simulate a scene for many values of its keys");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "scene file (TOML)")->required();
  command->add_option("axes", options->axes, "PATH=VALUES, see below; several make a grid")->required();
  command->add_option("-o,--output", options->output, "folder for the journal and the results");
  command->add_flag("--zip", options->zip, "pair the values of the paths instead of the full grid");
  command->add_option("-j,--jobs,--parallel", options->jobs, "simulations at a time (default: one per core)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--no-cuts", options->no_cuts, "keep the table only: no cuts/NNN.h5, no histories in sweep.h5");
  command->add_flag("--dry-run", options->dry_run, "say how many runs and what they will cost");
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "PATH=VALUES:  cut.depth=0.25,0.5,1mm       values; the last unit holds for all that have none\n"
      "              cut.depth=0.25:2:8mm         from:to:count, evenly spaced; log:0.25:2:8mm in equal ratios\n"
      "              cohesive.mode_I.strength+cohesive.mode_II.strength=20,40MPa     several keys, one value\n"
      "              friction.coefficient=-,0.2   \"-\" leaves the key out, and its table if it cannot do without\n"
      "The folder keeps every run: a sweep that was stopped or killed goes on with the same command or\n"
      "`kerf resume DIR`. Exit code 0: every run accepted. 4: some were refused, the table says why. 130: Ctrl-C.");
  command->callback([options, &exit_code] { exit_code = static_cast<int>(sweep(*options)); });
}

}  // namespace kerf::commands
