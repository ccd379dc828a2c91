#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "inverse/commands/commands.hpp"
#include "inverse/commands/job_study_session.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/commands/study_session.hpp"
#include "inverse/folder.hpp"
#include "inverse/scene_kind.hpp"
#include "models/base/atomic_file.hpp"

namespace kerf::commands {
namespace {

struct Options {
  std::string scene, output;
  std::vector<std::string> knobs, reference;
  std::string result;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool keep_cuts = false, dry_run = false, json = false;
};

void require_output(const Options& options) {
  if (options.output.empty())
    throw InputError("kerf study: -o DIR is missing: a folder for the journal and the results", ExitCode::usage);
}

ExitCode study_of_job(const Options& options) {
  if (!options.knobs.empty() || !options.reference.empty() || !options.result.empty() || options.dry_run ||
      options.keep_cuts)
    throw InputError("kerf study: of a job it takes -o, --jobs and --json alone; it runs the job at every preset",
                     ExitCode::usage);
  require_output(options);
  return begin_job_study(options.scene, options.output, {.max_runs = 0, .parallel = options.jobs, .preset = {}},
                         inverse::code_identity(), options.json);
}

ExitCode study(const Options& options) {
  const inverse::InputFile scene{.name = options.scene, .content = read_file(options.scene)};
  if (is_job(Document::parse(scene.content, scene.name))) return study_of_job(options);
  inverse::Study study = inverse::lay_out_study(Document::parse(scene.content, scene.name), options.knobs,
                                                options.reference, "kerf study");
  if (!options.result.empty() && !inverse::SceneKind::of(study.scene).has_bodies)
    throw InputError("kerf study: --result is about bodies; of a cut both forces are looked at", ExitCode::usage);
  study.result = options.result;
  if (options.dry_run) {
    print_cost(inverse::requests_of(study), options.jobs);
    return ExitCode::success;
  }
  require_output(options);
  const std::string code = inverse::code_identity();
  inverse::SceneFolder folder = inverse::SceneFolder::create(
      options.output, scene,
      {.kind = "study",
       .asked = {{"knobs", options.knobs}, {"reference", options.reference}, {"result", options.result}},
       .jobs = options.jobs,
       .keep_cuts = options.keep_cuts},
      code);
  return run_study(folder, study, code, options.json);
}

std::string listed(const std::vector<std::string>& texts) {
  std::string lines;
  for (const std::string& text : texts) lines += "  " + text + "\n";
  return lines;
}

}  // namespace

void add_study(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand(
      "study", "What accuracy costs: turn one knob of a scene at a time, or run a job at every preset");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "scene or job file (TOML)")->required();
  command->add_option("knobs", options->knobs,
                      "PATH=VALUES as for a sweep, or factors of the scene's own: PATH=x0.5,x2");
  command->add_option("--reference", options->reference, "PATH=VALUE of the run that counts as exact")
      ->allow_extra_args(false);
  command->add_option(
      "--result", options->result,
      "of bodies: the number that is looked at; one that ends in _error is off a closed form, any other is\n"
      "compared with the reference's (default: the first of the former)");
  command->add_option("-o,--output", options->output, "folder for the journal and the results");
  command->add_option("-j,--jobs,--parallel", options->jobs, "simulations at a time (default: one per core)")
      ->check(CLI::PositiveNumber);
  command->add_flag("--cuts", options->keep_cuts, "keep every cut in full, in cuts/NNN.h5");
  command->add_flag("--dry-run", options->dry_run, "say how many runs and what they will cost");
  command->add_flag("--json", options->json, "print the result as JSON");
  const Document cut = Document::parse("", ""), bodies = Document::parse("[box]\n", "");
  command->footer("Without knobs:\n" + listed(inverse::default_knobs(cut)) + "of bodies:\n" +
                  listed(inverse::default_knobs(bodies)) + "Without a reference:\n" +
                  listed(inverse::default_reference(cut)) + "of bodies:\n" +
                  listed(inverse::default_reference(bodies)) +
                  "A study that was stopped or killed goes on with the same command or `kerf resume DIR`.\n"
                  "Exit code 0: every run accepted. 4: some were refused, the table says why. 130: Ctrl-C.");
  command->callback([options, &exit_code] { exit_code = static_cast<int>(study(*options)); });
}

}  // namespace kerf::commands
