#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace kerf {

inline std::string content_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct ProcessOutput {
  int exit_code;
  std::string out, err;
};

/// Runs the executable under test through the shell, keeping its streams in `folder` while it runs. `environment` is
/// put before the command ("NAME=value").
inline ProcessOutput run_kerf(const std::string& arguments, const std::filesystem::path& folder,
                              const std::string& environment = "") {
  // Tests that share a folder run side by side, each in a process of its own.
  const std::string own = std::to_string(::getpid());
  const std::filesystem::path out = folder / ("stdout-" + own), err = folder / ("stderr-" + own);
  const std::string command =
      environment + " '" + KERF_EXECUTABLE + "' " + arguments + " >'" + out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());
  ProcessOutput output{WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return output;
}

}  // namespace kerf
