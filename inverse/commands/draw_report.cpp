#include "inverse/commands/draw_report.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;

std::string environment_or(const char* variable, const char* fallback) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0' ? value : fallback;
}

}  // namespace

// What the drawing script says with its exit code 3 is about the user's files; everything else is about Python.
ExitCode draw_report(const std::string& target, const std::string& output, bool quiet) {
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
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  if (quiet) ::posix_spawn_file_actions_adddup2(&streams, STDERR_FILENO, STDOUT_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, python.c_str(), &streams, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&streams);
  if (error != 0)
    throw InputError(fmt::format("{}: cannot be run ({}); `apt-get install python3`, or set KERF_PYTHON to a Python 3",
                                 python, std::generic_category().message(error)),
                     ExitCode::internal_error);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return WTERMSIG(status) == SIGINT ? ExitCode::interrupted : ExitCode::internal_error;
  return static_cast<ExitCode>(WEXITSTATUS(status));
}

}  // namespace kerf::commands
