#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace kerf::commands {

/// What `--max-time` understands, in seconds.
std::map<std::string, double> time_units();

/// The ways to end a calibration early and cleanly: Ctrl-C (see StopOnInterrupt), a file named `stop` in its folder, a
/// limit on the time of this session.
class Stop {
 public:
  /// Takes away a stop file that is there already: it was meant for an earlier session. `max_seconds` 0: no limit.
  Stop(const std::filesystem::path& folder, double max_seconds);

  /// Why to stop, in words; null to go on. May be asked by several threads.
  const char* reason() const;

 private:
  std::filesystem::path file_;
  std::optional<std::chrono::steady_clock::time_point> end_;
};

}  // namespace kerf::commands
