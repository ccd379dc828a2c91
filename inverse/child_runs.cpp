#include "inverse/child_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "inverse/child_process.hpp"
#include "inverse/scene_kind.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t cuts_kept = 64;  // the runs at the final estimate are among the last of these

void drop(const fs::path& file) {
  std::error_code ignored;
  fs::remove(file, ignored);
}

std::optional<RunRecord> read_record(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  try {
    return record_from_json(nlohmann::ordered_json::parse(read_file(file)));
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

bool went_wrong(const RunRecord& record) {
  const bool broke_down = std::any_of(record.refusals.begin(), record.refusals.end(),
                                      [](const std::string& refusal) { return refusal.starts_with("broke down"); });
  return broke_down || !std::isfinite(record.F_c.value) || !std::isfinite(record.F_t.value);
}

/// A run that says that all is well although its forces are not numbers is not believed.
RunRecord believed(RunRecord record) {
  if (record.accepted && went_wrong(record)) {
    record.accepted = false;
    record.refusals.emplace_back("its forces are not finite");
  }
  return record;
}

}  // namespace

struct ChildRuns::Attempt {
  std::optional<RunRecord> record;
  std::string lost;  ///< why there is none
};

ChildRuns::ChildRuns(std::vector<std::string> command, fs::path scratch, const Budget& budget,
                     std::function<bool()> stop)
    : command_(std::move(command)),
      scratch_(fs::absolute(scratch)),
      budget_(budget),
      backend_(find_backend(budget.backend)),
      stop_(std::move(stop)) {
  std::error_code error;
  fs::create_directories(scratch_, error);
  if (error) throw InputError(fmt::format("{}: cannot create this folder: {}", scratch_.string(), error.message()));
}

std::optional<fs::path> ChildRuns::cut_file(const std::string& key) const {
  const fs::path file = scratch_ / (key + ".h5");
  return fs::exists(file) ? std::optional(file) : std::nullopt;
}

ChildRuns::Attempt ChildRuns::attempt(const Document& scene, const std::string& name, double time_out) const {
  const auto file = [&](const char* extension) { return scratch_ / (name + extension); };
  if (auto ready = read_record(file(".json"))) return {std::move(ready), {}};
  drop(file(".json"));
  drop(file(".err"));
  write_atomically(file(".toml"), scene.canonical());

  RunProcess run{.words = command_, .name = "kerf-" + name, .errors = file(".err"), .time_out = time_out};
  for (const char* extension : {".toml", ".json", ".h5"}) run.words.push_back(file(extension).string());
  const std::optional<double> patience = backend_->patience(run);
  if (stop_ && stop_()) throw Interrupted{};
  const ChildProcess::Outcome outcome = ChildProcess(backend_->command(run), run.errors).wait(patience, stop_);
  using End = ChildProcess::End;
  if (outcome.end == End::stopped) {
    backend_->cancel(run);
    throw Interrupted{};
  }
  Attempt attempt{.record = read_record(file(".json")), .lost = {}};
  if (attempt.record) return attempt;
  const std::string said = fs::exists(run.errors) ? last_line(read_file(run.errors)) : "";
  if (outcome.end == End::exited && outcome.code == static_cast<int>(ExitCode::bad_data)) throw InputError(said);
  if (outcome.end == End::exited && outcome.code == 127)
    throw InputError(fmt::format("{}: cannot be executed", backend_->command(run).front()));
  attempt.lost = outcome.end == End::timed_out ? fmt::format("hung: it was given {:.3g} s of a processor", time_out)
                 : outcome.end == End::killed_by_signal ? fmt::format("crashed: {}", ::strsignal(outcome.code))
                                                        : fmt::format("ended with code {} and without a result{}{}",
                                                                      outcome.code, said.empty() ? "" : ": ", said);
  return attempt;
}

RunRecord ChildRuns::operator()(const RunRequest& request, const std::string& key,
                                std::optional<double> median_seconds) {
  const double time_out =
      median_seconds ? std::max(budget_.shortest_time_out, budget_.time_out * *median_seconds) : budget_.first_time_out;
  Attempt first = attempt(request.scene, key, time_out);
  if (first.record && !went_wrong(*first.record)) {
    keep_cut(key, key);
    return *first.record;
  }
  if (first.record)
    first.lost = first.record->refusals.empty() ? "its forces are not finite" : first.record->refusals.front();

  Document safer = request.scene;
  const SceneKind kind = SceneKind::of(request.scene);
  const std::string courant_path = kind.courant_path();
  safer.add_table(courant_path.substr(0, courant_path.find('.')), kind.blocks());
  const double courant = std::max(0.01, 0.5 * kind.courant_number(request.scene));
  safer.set_number(courant_path, courant, kind.blocks());
  const std::string name = key + "-safer";
  Attempt second = attempt(safer, name, 2 * time_out);
  RunRecord record = second.record ? believed(std::move(*second.record)) : refused(second.lost);
  record.lost = !second.record;
  record.retried = fmt::format("{}; again with {} = {:g}", first.lost, courant_path, courant);
  keep_cut(key, name);
  return record;
}

/// The cut belongs to the run whatever attempt made it; all else in the folder has served.
void ChildRuns::keep_cut(const std::string& key, const std::string& name) {
  if (name != key) {
    std::error_code none;
    fs::rename(scratch_ / (name + ".h5"), scratch_ / (key + ".h5"), none);
    fs::rename(scratch_ / (name + ".xdmf"), scratch_ / (key + ".xdmf"), none);
  }
  const std::lock_guard lock(keeping_);
  kept_.push_back(key);
  if (kept_.size() <= cuts_kept) return;
  for (const char* extension : {".h5", ".xdmf"}) drop(scratch_ / (kept_.front() + extension));
  kept_.pop_front();
}

void ChildRuns::journaled(const std::string& key) const {
  for (const char* suffix : {"", "-safer"})
    for (const char* extension : {".toml", ".json", ".err"}) drop(scratch_ / (key + suffix + extension));
}

std::vector<std::string> run_command() {
  // A test puts a simulator in kerf's place that fails as it is told.
  if (const char* other = std::getenv("KERF_TEST_RUN_COMMAND")) return {other};  // NOLINT(concurrency-mt-unsafe)
  return {fs::read_symlink("/proc/self/exe").string(), "run"};
}

}  // namespace kerf::inverse
