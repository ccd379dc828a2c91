#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "inverse/backend.hpp"
#include "inverse/job.hpp"
#include "inverse/run_database.hpp"

namespace kerf::inverse {

/// Simulates every run in a process of its own, so that a crash or a hang costs that run and nothing else. A run that
/// crashed, hung or left no finite forces gets a second chance with half the Courant number; what became of it is in
/// its record (`retried`, `lost`).
///
/// Files in `scratch`, by the key of the run: KEY.toml, KEY.json (its record: a process that was ready before its
/// calibration was killed has not worked in vain), KEY.err, and KEY.h5, the whole cut, of the last runs.
class ChildRuns {
 public:
  /// `command` is followed by SCENE RECORD CUT. `stop` is asked ten times a second and by several threads.
  ChildRuns(std::vector<std::string> command, std::filesystem::path scratch, const Budget& budget,
            std::function<bool()> stop);

  /// A Runner. Throws Interrupted, and InputError when the process could not read or write its files, as on a full
  /// disk: that is not the fault of the run.
  RunRecord operator()(const RunRequest& request, const std::string& key, std::optional<double> median_seconds);

  /// To be called once the record is safe elsewhere: takes its files away, but not the cut.
  void journaled(const std::string& key) const;

  /// The whole cut of a run, or nothing if its file is gone.
  std::optional<std::filesystem::path> cut_file(const std::string& key) const;

 private:
  struct Attempt;
  Attempt attempt(const Document& scene, const std::string& name, double time_out) const;
  void keep_cut(const std::string& key, const std::string& name);

  std::vector<std::string> command_;
  std::filesystem::path scratch_;
  Budget budget_;
  std::unique_ptr<Backend> backend_;
  std::function<bool()> stop_;
  std::mutex keeping_;
  std::deque<std::string> kept_;
};

/// How kerf simulates one run: this executable, `kerf run`.
std::vector<std::string> run_command();

}  // namespace kerf::inverse
