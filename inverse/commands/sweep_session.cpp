#include "inverse/commands/sweep_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <utility>

#include "forward/record/cut_file.hpp"
#include "inverse/commands/draw_report.hpp"
#include "inverse/commands/expected_cost.hpp"
#include "inverse/commands/interrupt.hpp"
#include "inverse/commands/interruptible_run.hpp"
#include "inverse/manifest.hpp"
#include "inverse/reduction_json.hpp"
#include "inverse/run_database.hpp"
#include "inverse/sweep_file.hpp"
#include "inverse/sweep_table.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using inverse::RunRecord;
using inverse::RunRequest;
using inverse::Sweep;
using inverse::SweepAxis;
using inverse::SweepFolder;
using inverse::SweepIntercepts;
using inverse::SweepRecords;
using nlohmann::ordered_json;

/// Particle-steps that each run may take at most; 0 for a scene that its reader refuses.
std::vector<double> largest_costs(const Sweep& sweep) {
  std::vector<double> costs;
  for (const inverse::SweepRun& run : sweep.runs) {
    try {
      costs.push_back(expected_cost(forward::read_scene(run.scene)).most);
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
class SweepProgress {
 public:
  SweepProgress(const Sweep& sweep, std::vector<double> costs, const inverse::RunDatabase& database)
      : costs_(std::move(costs)) {
    for (std::size_t run = 0; run < sweep.runs.size(); ++run)
      if (costs_[run] > 0 && !database.find(sweep.runs[run].scene)) {
        cost_left_ += costs_[run];
        ++runs_left_;
      }
    fmt::print(stderr, "{} of {} runs to simulate\n", runs_left_, sweep.runs.size());
  }

  void run_ends(std::size_t run, const RunRequest& request, const RunRecord& record) {
    const double one = consistent_units_in("N/m");
    const std::string outcome =
        record.accepted
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

/// Longest first, so that no core waits for a long run that came last.
std::vector<RunRequest> requests_of(const Sweep& sweep, const std::vector<double>& costs) {
  std::vector<std::size_t> order(sweep.runs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  std::vector<RunRequest> requests;
  requests.reserve(order.size());
  for (const std::size_t run : order)
    requests.push_back({.scene = sweep.runs[run].scene, .label = sweep.runs[run].label, .cut = run});
  return requests;
}

struct Outcome {
  SweepRecords records;
  inverse::SweepCost cost;
  bool interrupted = false;
};

Outcome simulate_all(SweepFolder& folder, const std::string& code) {
  const Sweep& sweep = folder.sweep();
  const std::vector<double> costs = largest_costs(sweep);
  std::optional<SweepProgress> progress;
  const inverse::RunDatabase* finished = nullptr;
  const auto run_ends = [&](const RunRequest& request, const RunRecord& record) {
    const std::size_t run = request.cut;
    if (folder.request().keep_cuts)
      if (const auto cut = finished->recent(request.scene))
        forward::write_cut(folder.cut_file(run), request.scene, *cut);
    progress->run_ends(run, request, record);
  };
  inverse::RunDatabase database(folder.journal(), code, run_unless_interrupted, folder.request().jobs,
                                {.batch_begins = {}, .run_ends = run_ends});
  finished = &database;
  progress.emplace(sweep, costs, database);
  Outcome outcome;
  try {
    database.run(requests_of(sweep, costs));
  } catch (const inverse::Interrupted&) {
    outcome.interrupted = true;
  }
  for (const inverse::SweepRun& run : sweep.runs) outcome.records.push_back(database.find(run.scene));
  outcome.cost = {.wall_seconds = database.wall_seconds(), .simulated = database.simulated()};
  return outcome;
}

ordered_json manifest_of(const SweepFolder& folder, const std::string& code, double wall_seconds) {
  ordered_json manifest = inverse::code_and_machine(code);
  manifest["inputs"] = ordered_json::array({{{"name", folder.scene_name()}, {"sha256", folder.scene_hash()}}});
  manifest["axes"] = folder.request().axes;
  manifest["zip"] = folder.request().zip;
  manifest["parallel"] = folder.request().jobs;
  manifest["scene"] = folder.sweep().scene.canonical();
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

std::vector<std::string> cells_of(const Sweep& sweep, std::size_t run, const std::optional<RunRecord>& record) {
  std::vector<std::string> cells{fmt::format("{}", run + 1)};
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) cells.push_back(sweep.value(sweep.runs[run], a).text);
  if (!record || !record->result.is_object()) {
    cells.resize(cells.size() + 12, "");
    cells.emplace_back(record ? "refused" : "not run");
    return cells;
  }
  const RunRecord& r = *record;
  for (const Estimate& force : {r.F_c, r.F_t}) {
    cells.push_back(in_newton_per_metre(force.value));
    cells.push_back(in_newton_per_metre(force.standard_error));
  }
  cells.push_back(plain(r.F_t.value / r.F_c.value, 3));
  cells.emplace_back(forward::name(r.branch));
  cells.push_back(plain(r.crack_lead.value, 3));
  cells.push_back(plain(r.mode_I_fraction, 2));
  cells.push_back(plain(r.chip_ratio.value, 2));
  cells.push_back(plain(r.fracture_energy_ratio, 3));
  cells.push_back(plain(100 * r.ledger.residue() / r.ledger.tool_work, 2));
  cells.push_back(plain(r.wall_seconds, 1));
  cells.emplace_back(r.accepted ? (r.steady ? "accepted" : "accepted, not steady") : "refused");
  return cells;
}

/// Right-aligned columns under their heads, as wide as they need.
void print_table(const Sweep& sweep, const SweepRecords& records) {
  std::vector<std::vector<std::string>> rows{{"run"}};
  for (const SweepAxis& axis : sweep.axes)
    rows.front().push_back(axis.unit == "1" ? axis.short_name : fmt::format("{}[{}]", axis.short_name, axis.unit));
  for (const char* head : {"F_c[N/m]", "+-", "F_t[N/m]", "+-", "F_t/F_c", "branch", "lead[mm]", "mode I", "chip ratio",
                           "G/G_c", "residue[%]", "core-s", "verdict"})
    rows.front().emplace_back(head);
  for (std::size_t run = 0; run < records.size(); ++run) rows.push_back(cells_of(sweep, run, records[run]));
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c + 1 < row.size(); ++c) line += fmt::format("{:>{}}  ", row[c], widths[c]);
    fmt::print("{}{}\n", line, row.back());
  }
  bool first = true;
  for (std::size_t run = 0; run < records.size(); ++run) {
    if (!records[run] || records[run]->refusals.empty()) continue;
    if (std::exchange(first, false)) fmt::print("\n");
    for (const std::string& reason : records[run]->refusals) fmt::print("run {}: {}\n", run + 1, reason);
  }
}

void print_intercepts(const SweepIntercepts& line) {
  const double one = consistent_units_in("J/m^2");
  fmt::print("\nF_c extrapolated to zero depth{}{}\n", line.held.empty() ? "" : ", ", line.held);
  if (!line.not_applied.empty()) {
    fmt::print("  not applied: {}\n", line.not_applied);
    return;
  }
  const bool equal = line.toughness_I == line.toughness_II;
  fmt::print("  {:<24}{:>9.0f} J/m^2{}\n", "put into the scene", line.toughness_I / one,
             equal ? "" : fmt::format(" in mode I, {:.0f} J/m^2 in mode II", line.toughness_II / one));
  for (const chip::MethodResult& method : line.reduction.methods) {
    const chip::FittedParameter* toughness = method.fit.find("toughness");
    if (!method.not_applied.empty() || !method.fit.converged || toughness == nullptr) {
      fmt::print("  {:<24}{:>9}       {}\n", method.method, "-",
                 method.not_applied.empty() ? inverse::verdict_of(method) : method.not_applied);
      continue;
    }
    const std::string interval =
        std::isfinite(toughness->standard_error)
            ? fmt::format("+- {:<7.0f} 95 %: {:.0f} ... {:.0f}", toughness->standard_error / one,
                          toughness->lower / one, toughness->upper / one)
            : "as many forces as parameters: no interval";
    fmt::print("  {:<24}{:>9.0f} J/m^2 ({:+.0f} %)  {}\n", method.method, toughness->value / one,
               100 * (toughness->value / line.toughness_I - 1), interval);
  }
  for (const std::string& warning : line.warnings) fmt::print("  warning: {}\n", warning);
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

}  // namespace

ExitCode run_sweep(SweepFolder& folder, const std::string& code, bool json) {
  const StopOnInterrupt guard;
  const Sweep& sweep = folder.sweep();
  const Outcome outcome = simulate_all(folder, code);
  const std::vector<SweepIntercepts> intercepts = inverse::sweep_intercepts(sweep, outcome.records);
  const std::vector<inverse::SweepColumn> columns = inverse::sweep_columns(sweep, outcome.records);
  const ordered_json result = inverse::sweep_json(sweep, outcome.records, intercepts, outcome.cost,
                                                  manifest_of(folder, code, outcome.cost.wall_seconds));
  std::vector<fs::path> cut_files;
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) cut_files.push_back(folder.cut_file(run));
  write_atomically(folder.path() / "sweep.csv", inverse::sweep_csv(columns));
  write_atomically(folder.path() / "sweep.json", result.dump(2) + "\n");
  inverse::write_sweep(folder.path() / "sweep.h5", sweep, columns, cut_files);
  if (!outcome.interrupted) draw(folder.path());

  if (json) {
    fmt::print("{}\n", result.dump(2));
  } else {
    print_table(sweep, outcome.records);
    for (const SweepIntercepts& line : intercepts) print_intercepts(line);
  }
  std::fflush(stdout);
  if (outcome.interrupted) {
    fmt::print(stderr, "interrupted; every finished run is kept, {} tells them. Continue with: kerf resume {}\n",
               (folder.path() / "sweep.csv").string(), folder.path().string());
    return ExitCode::interrupted;
  }
  const bool all_accepted = std::all_of(outcome.records.begin(), outcome.records.end(),
                                        [](const auto& record) { return record && record->accepted; });
  return all_accepted ? ExitCode::success : ExitCode::not_converged;
}

void print_sweep_cost(const Sweep& sweep, int jobs) {
  double least = 0, most = 0, longest = 0;
  std::optional<forward::Scene> dearest;
  std::size_t refused = 0;
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) {
    try {
      const forward::Scene scene = forward::read_scene(sweep.runs[run].scene);
      const ExpectedCost cost = expected_cost(scene);
      fmt::print("{:>5}  {:>8.0f} particles  {:>8.2g} to {:<8.2g} particle-steps  {}\n", run + 1, cost.particles,
                 cost.least, cost.most, sweep.runs[run].label);
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
             sweep.runs.size(), refused == 0 ? "" : fmt::format(" ({} refused)", refused), least, most,
             duration(soonest * speed), duration(latest * speed), jobs);
}

}  // namespace kerf::commands
