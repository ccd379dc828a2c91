#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "inverse/journal.hpp"
#include "inverse/run_record.hpp"
#include "inverse/shared_runs.hpp"
#include "models/base/document.hpp"

namespace kerf::inverse {

/// How a cut is simulated: forward::run in earnest, anything quick in a test. Called by several threads at once.
using Simulator = std::function<forward::CutResult(const forward::Scene&)>;

/// One cut to simulate; `label` is for the eyes of the user, `cut` groups runs of about equal cost.
struct RunRequest {
  Document scene;
  std::string label;
  std::size_t cut = 0;
};

/// A run made elsewhere, of which only the record comes back. `median_seconds` is that of the finished runs of the same
/// cut (of any cut, if none has finished). Called by several threads at once.
using Runner =
    std::function<RunRecord(const RunRequest&, const std::string& key, std::optional<double> median_seconds)>;

/// Thrown by a simulator that was told to stop: the run is abandoned, not remembered.
struct Interrupted {};

/// Told about every run as it ends, and about batches as they begin.
struct RunEvents {
  std::function<void(std::size_t new_runs, double expected_seconds)> batch_begins;
  std::function<void(const RunRequest&, const RunRecord&)> run_ends;
};

/// Every simulated cut, keyed by what was simulated: SHA-256 of the resolved scene and of the code that simulates. A
/// scene is never simulated twice; what the journal holds is taken from there, so a resumed calibration replays.
class RunDatabase {
 public:
  /// `journal` outlives the database. `code` names the code, `parallel` >= 1 is the number of runs at a time.
  RunDatabase(Journal& journal, std::string code, const Simulator& simulate, int parallel, RunEvents events = {});
  RunDatabase(Journal& journal, std::string code, Runner runner, int parallel, RunEvents events = {});

  /// The records of all requests, in their order. Missing ones are simulated, longest first; the order in which they
  /// finish influences nothing. Rethrows what a simulator throws, after the other runs under way have ended.
  std::vector<RunRecord> run(const std::vector<RunRequest>& requests);

  /// From now on runs come from `folder` if they are there, and go there. They are journaled all the same, so that a
  /// resumed calibration does not depend on it.
  void share(const std::filesystem::path& folder) { shared_.emplace(folder); }

  /// Distinct runs asked for so far, and what that number would become with `requests`: the count a budget limits.
  /// It does not depend on how many came from the journal.
  std::size_t runs() const { return asked_.size(); }
  std::size_t runs_with(const std::vector<RunRequest>& requests) const;

  /// Simulated by this process, and failed among all asked for.
  std::size_t simulated() const { return simulated_; }
  std::size_t failed() const;

  /// Processor time of all that was asked for, whenever and wherever it was simulated, s.
  double core_seconds() const;

  /// The record of a run that has ended, now or before; nothing is simulated.
  std::optional<RunRecord> find(const Document& scene) const;

  std::string key(const Document& scene) const;

  /// Wall time of this and of all earlier sessions on the journal, s.
  double wall_seconds() const;

 private:
  struct Task;
  void simulate_all(std::vector<Task>& tasks);
  void finish(const Task& task, const RunRecord& record);
  void remember(const Task& task, const RunRecord& record);
  std::optional<double> median_seconds(std::size_t cut) const;
  double expected_seconds(std::size_t cut) const;

  Journal& journal_;
  std::string code_;
  Runner runner_;
  std::optional<SharedRuns> shared_;
  int parallel_;
  RunEvents events_;
  std::map<std::string, RunRecord> known_;
  std::set<std::string> asked_;
  std::map<std::size_t, std::vector<double>> seconds_;  ///< wall times of each cut's runs
  std::size_t simulated_ = 0;
  double earlier_seconds_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex finishing_;
};

}  // namespace kerf::inverse
