#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kerf::inverse {

/// One run as a process: `words` is a command that leaves its result in a file.
struct RunProcess {
  std::vector<std::string> words;
  std::string name;              ///< unique among the runs of the code
  std::filesystem::path errors;  ///< receives standard error
  double time_out = 0;           ///< s, of computing
};

/// Where the processes of a calibration's runs live. A run is known by the files it leaves, so nothing else comes back.
class Backend {
 public:
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;

  /// The command to execute here, which ends when the run has ended, with its exit code.
  virtual std::vector<std::string> command(const RunProcess& run) const = 0;
  /// How long that command may take, s; nothing when it may have to wait in a queue.
  virtual std::optional<double> patience(const RunProcess& run) const = 0;
  /// Called after the command was killed on the user's wish.
  virtual void cancel(const RunProcess& run) const = 0;
};

/// Child processes of this one.
std::unique_ptr<Backend> local_backend();
/// One Slurm job per run, requeued when its node fails. `sbatch` and `scancel` are taken from the PATH.
std::unique_ptr<Backend> slurm_backend();

/// "local" or "slurm".
std::unique_ptr<Backend> find_backend(const std::string& name);
std::vector<std::string> backend_names();

}  // namespace kerf::inverse
