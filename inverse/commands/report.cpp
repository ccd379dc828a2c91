#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "inverse/commands/commands.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;

std::string environment_or(const char* variable, const char* fallback) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : fallback;
}

/// What the drawing script says with its exit code 3 is about the user's files; everything else is about Python.
ExitCode draw(const std::string& target, const std::string& output) {
  // Debian's Python, where the packages that install-deps.sh brings can be found.
  std::string python = environment_or("KERF_PYTHON", "/usr/bin/python3");
  std::string script = environment_or("KERF_REPORT_SCRIPT", KERF_REPORT_SCRIPT);
  if (!fs::exists(script))
    throw InputError(fmt::format("{}: the report's script is not there; set KERF_REPORT_SCRIPT to scripts/report.py of "
                                 "the source tree",
                                 script),
                     ExitCode::internal_error);
  std::string no_bytecode = "-B", input = target, option = "--output", place = output;
  std::array<char*, 7> arguments{python.data(),
                                 no_bytecode.data(),
                                 script.data(),
                                 input.data(),
                                 output.empty() ? nullptr : option.data(),
                                 place.data(),
                                 nullptr};
  pid_t child = 0;
  if (const int error = ::posix_spawnp(&child, python.c_str(), nullptr, nullptr, arguments.data(), environ); error != 0)
    throw InputError(fmt::format("{}: cannot be run ({}); `apt-get install python3`, or set KERF_PYTHON to a Python 3",
                                 python, std::generic_category().message(error)),
                     ExitCode::internal_error);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGINT ? ExitCode::interrupted : ExitCode::internal_error;
  return static_cast<ExitCode>(WEXITSTATUS(status));
}

struct Options {
  std::string target, output;
};

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("report", "Write one self-contained HTML page about a calibration or a cut");
  const auto options = std::make_shared<Options>();
  command->add_option("target", options->target, "directory of a calibration, or the .h5 file of one cut")->required();
  command->add_option("-o,--output", options->output, "the page (default: DIR/report.html, or OUT.html beside OUT.h5)");
  command->callback([options, &exit_code] {
    if (!fs::exists(options->target))
      throw InputError(
          fmt::format("{}: no such file or directory; give the directory that `kerf calibrate -o` wrote or "
                      "the file that `kerf simulate -o` wrote",
                      options->target));
    exit_code = static_cast<int>(draw(options->target, options->output));
  });
}

}  // namespace kerf::commands
