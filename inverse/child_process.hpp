#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kerf::inverse {

/// A command in a process group of its own: Ctrl-C does not reach it, but it dies with the thread that began it.
class ChildProcess {
 public:
  /// Starts `words` (the first is looked for in the PATH) without input; both outputs are added to `output`. Throws
  /// InputError when `output` cannot be opened, std::system_error when there is no process to be had. A command that
  /// cannot be executed ends with code 127.
  ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& output);
  /// Kills the group if it was not waited for.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  enum class End { exited, killed_by_signal, timed_out, stopped };
  struct Outcome {
    End end;
    int code;  ///< exit code or signal
  };
  /// Waits for the end, no longer than until the command has used the processor for more than `seconds` or not at all
  /// for as long (a busy machine makes no run look hung), or `stop` says so (asked ten times a second); then the whole
  /// group is killed.
  Outcome wait(std::optional<double> seconds, const std::function<bool()>& stop);

 private:
  Outcome reap();
  double processor_seconds() const;
  void kill_group();

  pid_t child_ = -1;
};

}  // namespace kerf::inverse
