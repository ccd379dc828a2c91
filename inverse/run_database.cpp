#include "inverse/run_database.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "forward/scene/scene.hpp"
#include "inverse/scene_kind.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {

struct RunDatabase::Task {
  std::string key;
  const RunRequest* request;
};

RunDatabase::RunDatabase(Journal& journal, std::string code, const Simulator& simulate, int parallel, RunEvents events)
    : RunDatabase(
          journal, std::move(code),
          [simulate](const RunRequest& request, const std::string&, std::optional<double>) {
            return summarise(simulate(forward::read_scene(request.scene)));
          },
          parallel, std::move(events)) {}

RunDatabase::RunDatabase(Journal& journal, std::string code, Runner runner, int parallel, RunEvents events)
    : journal_(journal),
      code_(std::move(code)),
      runner_(std::move(runner)),
      parallel_(std::max(1, parallel)),
      events_(std::move(events)) {
  double session = 0;
  for (const Journal::Json& line : journal_.lines()) {
    if (line.contains("session")) {
      earlier_seconds_ += session;
      session = 0;
    }
    if (!line.contains("run")) continue;
    RunRecord record = record_from_json(line.at("run"));
    session = std::max(session, line.at("elapsed_s").get<double>());
    if (!record.lost) seconds_[line.at("cut").get<std::size_t>()].push_back(record.wall_seconds);
    known_.emplace(line.at("key").get<std::string>(), std::move(record));
  }
  earlier_seconds_ += session;
  journal_.append({{"session", code_}});
}

std::string RunDatabase::key(const Document& scene) const {
  return sha256(code_ + '\n' + scene.canonical());
}

std::size_t RunDatabase::runs_with(const std::vector<RunRequest>& requests) const {
  std::set<std::string> all = asked_;
  for (const RunRequest& request : requests) all.insert(key(request.scene));
  return all.size();
}

std::size_t RunDatabase::failed() const {
  return static_cast<std::size_t>(
      std::count_if(asked_.begin(), asked_.end(), [&](const std::string& key) { return !known_.at(key).accepted; }));
}

double RunDatabase::core_seconds() const {
  double sum = 0;
  for (const std::string& key : asked_) sum += known_.at(key).core_seconds();
  return sum;
}

std::optional<RunRecord> RunDatabase::find(const Document& scene) const {
  const auto found = known_.find(key(scene));
  return found == known_.end() ? std::nullopt : std::optional(found->second);
}

double RunDatabase::wall_seconds() const {
  return earlier_seconds_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

double RunDatabase::expected_seconds(std::size_t cut) const {
  if (const auto found = seconds_.find(cut); found != seconds_.end()) return found->second.back();
  return seconds_.empty() ? 0 : seconds_.begin()->second.back();
}

std::optional<double> RunDatabase::median_seconds(std::size_t cut) const {
  std::vector<double> seconds;
  if (const auto found = seconds_.find(cut); found != seconds_.end()) seconds = found->second;
  if (seconds.empty())
    for (const auto& [other, finished] : seconds_) seconds.insert(seconds.end(), finished.begin(), finished.end());
  if (seconds.empty()) return std::nullopt;
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

std::vector<RunRecord> RunDatabase::run(const std::vector<RunRequest>& requests) {
  std::vector<std::string> keys;
  std::vector<Task> tasks;
  std::set<std::string> planned;
  for (const RunRequest& request : requests) {
    keys.push_back(key(request.scene));
    if (known_.contains(keys.back()) || !planned.insert(keys.back()).second) continue;
    try {
      SceneKind::of(request.scene).check(request.scene);
      const Task task{keys.back(), &request};
      if (const std::optional<RunRecord> shared = shared_ ? shared_->find(task.key) : std::nullopt)
        remember(task, *shared);
      else
        tasks.push_back(task);
    } catch (const InputError& error) {
      known_.emplace(keys.back(), refused(error.what()));
    }
  }
  if (!tasks.empty()) simulate_all(tasks);
  std::vector<RunRecord> records;
  for (const std::string& key : keys) {
    asked_.insert(key);
    records.push_back(known_.at(key));
  }
  return records;
}

void RunDatabase::simulate_all(std::vector<Task>& tasks) {
  std::stable_sort(tasks.begin(), tasks.end(), [&](const Task& a, const Task& b) {
    return expected_seconds(a.request->cut) > expected_seconds(b.request->cut);
  });
  if (events_.batch_begins) {
    double total = 0;
    for (const Task& task : tasks) total += expected_seconds(task.request->cut);
    events_.batch_begins(tasks.size(), total / std::min<double>(parallel_, static_cast<double>(tasks.size())));
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
      try {
        const std::optional<double> median = [&] {
          const std::lock_guard lock(finishing_);
          return median_seconds(tasks[i].request->cut);
        }();
        finish(tasks[i], runner_(*tasks[i].request, tasks[i].key, median));
      } catch (...) {
        const std::lock_guard lock(finishing_);
        if (!failure) failure = std::current_exception();
        next = tasks.size();
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (int i = 1; i < parallel_ && static_cast<std::size_t>(i) < tasks.size(); ++i) pool.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

/// In the journal first, then here.
void RunDatabase::remember(const Task& task, const RunRecord& record) {
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  journal_.append({{"key", task.key},
                   {"cut", task.request->cut},
                   {"label", task.request->label},
                   {"elapsed_s", elapsed},
                   {"run", to_json(record)}});
  if (!record.lost) seconds_[task.request->cut].push_back(record.wall_seconds);
  known_.emplace(task.key, record);
}

void RunDatabase::finish(const Task& task, const RunRecord& record) {
  const std::lock_guard lock(finishing_);
  remember(task, record);
  ++simulated_;
  if (shared_) shared_->keep(task.key, record);
  if (events_.run_ends) events_.run_ends(*task.request, record);
}

}  // namespace kerf::inverse
