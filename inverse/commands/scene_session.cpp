#include "inverse/commands/scene_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <numeric>
#include <utility>

#include "forward/bodies/state.hpp"
#include "forward/record/cut_file.hpp"
#include "inverse/child_runs.hpp"
#include "inverse/commands/draw_report.hpp"
#include "inverse/commands/expected_cost.hpp"
#include "inverse/commands/interrupt.hpp"
#include "inverse/manifest.hpp"
#include "inverse/scene_kind.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using inverse::RunRecord;
using inverse::RunRequest;
using inverse::SceneFolder;
using nlohmann::ordered_json;

/// Of bodies as many as their longest strokes take with the step that they begin with; a stroke that waits for a
/// condition is taken to go once round the box.
double most_particle_steps(const Document& scene) {
  if (!inverse::SceneKind::of(scene).has_bodies) return expected_cost(forward::read_scene(scene)).most;
  const forward::bodies::Scene bodies = forward::bodies::read_scene(scene);
  const forward::bodies::State state = forward::bodies::lay_out(bodies);
  double time = 0, points = 0;
  for (const forward::bodies::Stroke& stroke : bodies.strokes)
    time += std::min(stroke.longest, bodies.length / std::abs(stroke.speed));
  for (const forward::bodies::Body& body : state.bodies) points += static_cast<double>(body.points.size());
  return points * time / state.step;
}

/// Particle-steps that each run may take at most; 0 for a scene that its reader refuses.
std::vector<double> largest_costs(const std::vector<RunRequest>& runs) {
  std::vector<double> costs;
  for (const RunRequest& run : runs) {
    try {
      costs.push_back(most_particle_steps(run.scene));
    } catch (const InputError&) {
      costs.push_back(0);
    }
  }
  return costs;
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// One plain line on standard error for each run that ends, with the time that is left by the cost of what is done.
class Progress {
 public:
  Progress(const std::vector<RunRequest>& runs, std::vector<double> costs, const inverse::RunDatabase& database)
      : costs_(std::move(costs)) {
    for (std::size_t run = 0; run < runs.size(); ++run)
      if (costs_[run] > 0 && !database.find(runs[run].scene)) {
        cost_left_ += costs_[run];
        ++runs_left_;
      }
    fmt::print(stderr, "{} of {} runs to simulate\n", runs_left_, runs.size());
  }

  void run_ends(std::size_t run, const RunRequest& request, const RunRecord& record) {
    const double one = consistent_units_in("N/m");
    const std::string outcome =
        record.accepted && inverse::SceneKind::of(request.scene).has_bodies ? "accepted"
        : record.accepted
            ? fmt::format("F_c {:.0f}, F_t {:.0f} N/m, {}", record.F_c.value / one, record.F_t.value / one,
                          forward::name(record.branch))
            : "refused: " + (record.refusals.empty() ? std::string("no reason given") : record.refusals.front());
    cost_done_ += costs_[run];
    cost_left_ -= costs_[run];
    --runs_left_;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    const std::string left =
        runs_left_ == 0 ? ""
                        : fmt::format("; {} left, about {}", runs_left_, duration(elapsed * cost_left_ / cost_done_));
    fmt::print(stderr, "run {}: {}: {} ({:.1f} s{})\n", run + 1, request.label, outcome, record.wall_seconds, left);
  }

 private:
  std::vector<double> costs_;
  double cost_done_ = 0, cost_left_ = 0;
  std::size_t runs_left_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Seconds per particle-step of the runs that ended: what another one may be expected to take.
class Pace {
 public:
  void add(double seconds, double cost) {
    const std::lock_guard lock(adding_);
    if (cost > 0) seconds_per_cost_.push_back(seconds / cost);
  }
  std::optional<double> expected(double cost) const {
    const std::lock_guard lock(adding_);
    if (seconds_per_cost_.empty() || cost <= 0) return std::nullopt;
    return cost * *std::max_element(seconds_per_cost_.begin(), seconds_per_cost_.end());
  }

 private:
  mutable std::mutex adding_;
  std::vector<double> seconds_per_cost_;
};

/// Longest first, so that no core waits for a long run that came last.
std::vector<RunRequest> longest_first(const std::vector<RunRequest>& runs, const std::vector<double>& costs) {
  std::vector<std::size_t> order(runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<RunRequest> requests;
  requests.reserve(order.size());
  for (const std::size_t run : order)
    requests.push_back({.scene = runs[run].scene, .label = runs[run].label, .cut = run});
  return requests;
}

}  // namespace

SceneOutcome simulate_all(SceneFolder& folder, const std::vector<RunRequest>& runs, const std::string& code) {
  const std::vector<double> costs = largest_costs(runs);
  const fs::path scratch = folder.path() / "runs";
  inverse::ChildRuns children(inverse::run_command(), scratch, inverse::Budget{},
                              [] { return StopOnInterrupt::asked(); });
  Pace pace;
  std::optional<Progress> progress;
  const inverse::RunDatabase* finished = nullptr;
  const auto run_ends = [&](const RunRequest& request, const RunRecord& record) {
    const std::size_t run = request.cut;
    const std::string key = finished->key(request.scene);
    if (const auto cut = children.cut_file(key); cut && folder.request().keep_cuts)
      forward::rename_cut(*cut, folder.cut_file(run));
    children.journaled(key);
    if (!record.lost) pace.add(record.wall_seconds, costs[run]);
    progress->run_ends(run, request, record);
  };
  inverse::RunDatabase database(folder.journal(), code,
                                [&](const RunRequest& request, const std::string& key, std::optional<double>) {
                                  return children(request, key, pace.expected(costs[request.cut]));
                                },
                                folder.request().jobs, {.batch_begins = {}, .run_ends = run_ends});
  finished = &database;
  progress.emplace(runs, costs, database);
  SceneOutcome outcome;
  try {
    database.run(longest_first(runs, costs));
  } catch (const inverse::Interrupted&) {
    outcome.interrupted = true;
  }
  for (const RunRequest& run : runs) outcome.records.push_back(database.find(run.scene));
  outcome.wall_seconds = database.wall_seconds();
  outcome.simulated = database.simulated();
  if (!outcome.interrupted) fs::remove_all(scratch);
  return outcome;
}

ExitCode conclude(const SceneFolder& folder, const SceneOutcome& outcome, const std::string& table) {
  if (outcome.interrupted) {
    fmt::print(stderr, "interrupted; every finished run is kept, {} tells them. Continue with: kerf resume {}\n",
               (folder.path() / table).string(), folder.path().string());
    return ExitCode::interrupted;
  }
  const bool all_accepted = std::all_of(outcome.records.begin(), outcome.records.end(),
                                        [](const auto& record) { return record && record->accepted; });
  return all_accepted ? ExitCode::success : ExitCode::not_converged;
}

ordered_json manifest_of(const SceneFolder& folder, const std::string& code, double wall_seconds) {
  ordered_json manifest = inverse::code_and_machine(code);
  manifest["inputs"] = ordered_json::array({{{"name", folder.scene().name}, {"sha256", folder.scene().hash()}}});
  manifest.update(folder.request().asked);
  manifest["parallel"] = folder.request().jobs;
  manifest["scene"] = Document::parse(folder.scene().content, folder.scene().name).canonical();
  manifest["wall_s"] = wall_seconds;
  manifest["processor_s_of_last_session"] = inverse::processor_seconds();
  return manifest;
}

std::string in_newton_per_metre(double force) {
  return std::isfinite(force) ? fmt::format("{:.0f}", force / consistent_units_in("N/m")) : "-";
}

std::string plain(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

void print_columns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c + 1 < row.size(); ++c) line += fmt::format("{:>{}}  ", row[c], widths[c]);
    fmt::print("{}{}\n", line, row.back());
  }
}

void print_refusals(const SceneOutcome& outcome) {
  bool first = true;
  for (std::size_t run = 0; run < outcome.records.size(); ++run) {
    const std::optional<RunRecord>& record = outcome.records[run];
    if (!record || record->refusals.empty()) continue;
    if (std::exchange(first, false)) fmt::print("\n");
    for (const std::string& reason : record->refusals) fmt::print("run {}: {}\n", run + 1, reason);
  }
}

void draw(const fs::path& folder) {
  try {
    if (draw_report(folder.string(), "", true) != ExitCode::success)
      fmt::print(stderr, "the report was not drawn; all numbers are there, `kerf report {}` tries again\n",
                 folder.string());
  } catch (const InputError& error) {
    fmt::print(stderr, "no report: {}; all numbers are there, `kerf report {}` draws it\n", error.what(),
               folder.string());
  }
}

void print_cost(const std::vector<RunRequest>& runs, int jobs) {
  if (!runs.empty() && inverse::SceneKind::of(runs.front().scene).has_bodies) {
    const std::vector<double> costs = largest_costs(runs);
    for (std::size_t run = 0; run < runs.size(); ++run)
      fmt::print("{:>5}  {}  {}\n", run + 1,
                 costs[run] > 0 ? fmt::format("about {:<8.2g} particle-steps", costs[run]) : "refused by its reader",
                 runs[run].label);
    fmt::print("{} runs, about {:.2g} particle-steps; `kerf explain` tells their pace\n", runs.size(),
               std::accumulate(costs.begin(), costs.end(), 0.0));
    return;
  }
  double least = 0, most = 0, longest = 0;
  std::optional<forward::Scene> dearest;
  std::size_t refused = 0;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    try {
      const forward::Scene scene = forward::read_scene(runs[run].scene);
      const ExpectedCost cost = expected_cost(scene);
      fmt::print("{:>5}  {:>8.0f} particles  {:>8.2g} to {:<8.2g} particle-steps  {}\n", run + 1, cost.particles,
                 cost.least, cost.most, runs[run].label);
      least += cost.least;
      most += cost.most;
      if (cost.most > longest) {
        longest = cost.most;
        dearest = scene;
      }
    } catch (const InputError& error) {
      ++refused;
      fmt::print("{:>5}  refused: {}\n", run + 1, error.what());
    }
  }
  const double speed = dearest ? seconds_per_particle_step(*dearest) : 0;
  // No sooner than the longest run alone, however many cores there are.
  const double soonest = std::max(least / jobs, longest * least / most), latest = std::max(most / jobs, longest);
  fmt::print("{} runs{}, {:.2g} to {:.2g} particle-steps, {} to {} at the speed measured now with {} at a time\n",
             runs.size(), refused == 0 ? "" : fmt::format(" ({} refused)", refused), least, most,
             duration(soonest * speed), duration(latest * speed), jobs);
}

}  // namespace kerf::commands
