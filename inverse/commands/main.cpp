#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "inverse/commands/commands.hpp"
#include "models/base/error.hpp"
#include "models/base/parameter.hpp"

namespace {

constexpr const char* exit_codes =
    "Exit codes: 0 converged or ok, 1 internal error, 2 usage, 3 bad data, 4 not converged,\n"
    "5 too many failed runs, 6 converged but a key parameter is not identifiable, 130 interrupted.";

/// A word in the place of a command that is none, with the nearest that is.
std::string misspelt_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return "";
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  for (const std::string& name : names)
    if (name == argv[1]) return "";
  const auto near = kerf::nearest(argv[1], names);
  return fmt::format("kerf: there is no command \"{}\"; {}", argv[1],
                     near ? fmt::format("did you mean \"{}\"?", *near) : "`kerf --help` lists the commands");
}

int run(int argc, char** argv) {
  CLI::App app("Fracture toughness from orthogonal cutting: closed forms, intercepts, inverse simulation", "kerf");
  app.set_version_flag("--version", "kerf " KERF_VERSION);
  app.footer(exit_codes);
  app.require_subcommand(1);

  int exit_code = 0;
  kerf::commands::add_check(app, exit_code);
  kerf::commands::add_list(app, exit_code);
  kerf::commands::add_explain(app, exit_code);
  kerf::commands::add_simulate(app, exit_code);
  kerf::commands::add_predict(app, exit_code);
  kerf::commands::add_reduce(app, exit_code);
  kerf::commands::add_r_curve(app, exit_code);
  kerf::commands::add_sweep(app, exit_code);
  kerf::commands::add_study(app, exit_code);
  kerf::commands::add_calibrate(app, exit_code);
  kerf::commands::add_coverage(app, exit_code);
  kerf::commands::add_next_cut(app, exit_code);
  kerf::commands::add_resume(app, exit_code);
  kerf::commands::add_run(app, exit_code);
  kerf::commands::add_evaluate(app, exit_code);
  kerf::commands::add_report(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    if (const std::string message = misspelt_command(app, argc, argv); !message.empty())
      fmt::print(stderr, "{}\n", message);
    else
      app.exit(error);
    return static_cast<int>(kerf::ExitCode::usage);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is then an error like a full disk, with a name and a reason
  try {
    return run(argc, argv);
  } catch (const kerf::InputError& error) {
    std::fputs(fmt::format("{}\n", error.what()).c_str(), stderr);  // fmt::print throws when a log's disk is full, too
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fputs(fmt::format("kerf: internal error: {}\n", error.what()).c_str(), stderr);
    return static_cast<int>(kerf::ExitCode::internal_error);
  }
}
