#include "inverse/commands/calibration_session.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "forward/record/cut_file.hpp"
#include "forward/record/result_json.hpp"
#include "inverse/calibration.hpp"
#include "inverse/calibration_json.hpp"
#include "inverse/child_runs.hpp"
#include "inverse/closed_form_reduction.hpp"
#include "inverse/commands/interrupt.hpp"
#include "inverse/commands/stop.hpp"
#include "inverse/manifest.hpp"
#include "inverse/reduction_json.hpp"
#include "inverse/statement.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/units.hpp"
#include "models/chip/reduction.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Plain lines on standard error: one per run and per step of the search, with what is left of a batch.
class ProgressLines {
 public:
  explicit ProgressLines(std::size_t max_runs) : max_runs_(max_runs) {}

  void batch_begins(std::size_t runs, double expected_seconds) {
    left_ = runs;
    if (expected_seconds > 0)
      fmt::print(stderr, "{} new run{}, about {:.0f} s\n", runs, runs == 1 ? "" : "s", expected_seconds);
    else
      fmt::print(stderr, "{} new run{}\n", runs, runs == 1 ? "" : "s");
  }

  void run_ends(const inverse::RunRequest& request, const inverse::RunRecord& record) {
    ++done_;
    --left_;
    std::string outcome;
    if (record.accepted && record.result.contains("r_curve")) {
      outcome = fmt::format("cracked {:.1f} mm", record.result["r_curve"]["extension"].back().get<double>());
    } else if (record.accepted) {
      const double one = consistent_units_in("N/m");
      outcome = fmt::format("F_c {:.0f}, F_t {:.0f} N/m, chip ratio {:.2f}", record.F_c.value / one,
                            record.F_t.value / one, record.chip_ratio.value);
    } else {
      outcome = "refused: " + (record.refusals.empty() ? std::string("no reason given") : record.refusals.front());
    }
    if (!record.retried.empty()) outcome += fmt::format(" [{}]", record.retried);
    fmt::print(stderr, "  run {} ({} left in this batch): {}: {} ({:.1f} s)\n", done_, left_, request.label, outcome,
               record.wall_seconds);
  }

  void step(const inverse::TraceEntry& entry) const {
    fmt::print(stderr, "{}: chi2 {:.3f} after {} of at most {} runs{}\n", entry.what, entry.chi2, entry.runs, max_runs_,
               entry.failed_cuts > 0
                   ? fmt::format(", {} cut{} failed", entry.failed_cuts, entry.failed_cuts == 1 ? "" : "s")
                   : "");
  }

 private:
  std::size_t max_runs_, done_ = 0, left_ = 0;
};

/// The cuts at the estimate in full. Those whose files are gone are simulated once more.
std::size_t keep_cuts(const inverse::Folder& folder, const inverse::Calibration& calibration,
                      const inverse::RunDatabase& database, inverse::ChildRuns& runs) {
  const inverse::Job& job = folder.job();
  const inverse::ParameterSpace space(job);
  std::size_t simulated = 0;
  for (std::size_t index = 0; index < job.cuts.size(); ++index) {
    if (index > 0 && job.cuts[index].extension && job.cuts[index - 1].curve == job.cuts[index].curve)
      continue;  // one pull shows the whole R-curve
    const Document scene = space.scene(calibration.fit.at.point, job.cuts[index]);
    const fs::path file = folder.path() / "cuts" / fmt::format("{:03}.json", index + 1);
    const std::string key = database.key(scene);
    if (fs::exists(file)) {
      const ordered_json kept = ordered_json::parse(read_file(file), nullptr, false);
      if (!kept.is_discarded() && kept.value("run", "") == key) continue;
    }
    inverse::RunRecord record = calibration.fit.at.runs[index];
    if (!runs.cut_file(key) && !record.lost) {
      fmt::print(stderr, "simulating the cut at depth {:.4g} mm once more to keep it in full\n", job.cuts[index].depth);
      record = runs({.scene = scene, .label = {}, .cut = index}, key, std::nullopt);
      runs.journaled(key);
      ++simulated;
    }
    const std::optional<fs::path> cut = runs.cut_file(key);
    if (!cut) continue;
    forward::rename_cut(*cut, fs::path(file).replace_extension(".h5"));
    ordered_json json = record.result;
    json["run"] = key;
    write_atomically(file, json.dump(2) + "\n");
  }
  return simulated;
}

/// Every planing curve of the job by closed forms and intercepts; several curves count as one.
void write_reduction(const inverse::Folder& folder) {
  data::Curve all;
  std::vector<std::string> notes;
  for (const inverse::MeasuredCurve& measured : folder.job().curves) {
    if (measured.specimen) continue;
    const data::Curve curve = data::parse_curve(measured.file.content, measured.file.name);
    all.points.insert(all.points.end(), curve.points.begin(), curve.points.end());
    notes.insert(notes.end(), curve.notes.begin(), curve.notes.end());
  }
  if (all.points.empty()) return;
  const forward::Scene scene = forward::read_scene(folder.job().scene);
  chip::FitOptions options;
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { law.elastic_modulus; }) {
          options.elastic_modulus = law.elastic_modulus;
          options.poisson_ratio = law.poisson_ratio;
        } else {
          options.elastic_modulus = law.constants().modulus_x;
          options.poisson_ratio = law.constants().poisson_xz;
        }
      },
      scene.material);
  const chip::Measurements measurements = inverse::measurements_of(all);
  chip::Reduction reduction = chip::reduce(measurements, {}, options);
  reduction.warnings.insert(reduction.warnings.begin(), notes.begin(), notes.end());
  write_atomically(folder.path() / "reduction.json", inverse::to_json(reduction, measurements).dump(2) + "\n");
}

void print_table(const inverse::Calibration& calibration, const inverse::CalibrationCost& cost) {
  const inverse::Identifiability& known = calibration.fit.identifiability;
  if (!known.parameters.empty())
    fmt::print("{:<16}{:>14}{:>14}{:>28}   {}\n", "parameter", "value", "std. error", "95 % interval", "verdict");
  for (const std::vector<inverse::ParameterEstimate>* all : {&known.parameters, &known.derived})
    for (const inverse::ParameterEstimate& p : *all) {
      const auto shown = [&](double value) { return inverse::show(value, p.unit, p.standard_error); };
      fmt::print("{:<16}{:>14}{:>14}{:>28}   {}\n", p.name, shown(p.value), shown(p.standard_error),
                 shown(p.interval.lower) + " ... " + shown(p.interval.upper), inverse::name(p.verdict));
    }
  if (known.singular_values.size() > 0) fmt::print("\nsingular values:");
  for (const double value : known.singular_values) fmt::print(" {:.3g}", value);
  fmt::print("{}{}\n\n{} simulated cuts ({} failed), {:.0f} s\n", known.parameters.empty() ? "" : "\n\n",
             calibration.statement, cost.runs, cost.failed_runs, cost.wall_seconds);
}

ExitCode finish(inverse::Folder& folder, const std::string& code, Show show, const Stop& stop) {
  const inverse::Job& job = folder.job();
  ProgressLines lines(job.budget.max_runs);
  const fs::path scratch = folder.path() / "runs";
  inverse::ChildRuns runs(inverse::run_command(), scratch, job.budget, [&] { return stop.reason() != nullptr; });
  const inverse::RunDatabase* running = nullptr;
  inverse::RunDatabase database(
      folder.journal(), code, std::ref(runs), job.budget.parallel,
      {.batch_begins = [&](std::size_t count, double seconds) { lines.batch_begins(count, seconds); },
       .run_ends =
           [&](const inverse::RunRequest& request, const inverse::RunRecord& record) {
             runs.journaled(running->key(request.scene));
             lines.run_ends(request, record);
           }});
  running = &database;
  if (!job.budget.shared_runs.empty()) database.share(job.budget.shared_runs);
  const inverse::Calibration calibration =
      inverse::calibrate(job, database, [&](const inverse::TraceEntry& entry) { lines.step(entry); });
  inverse::CalibrationCost cost{
      .runs = database.runs(), .failed_runs = database.failed(), .core_seconds = database.core_seconds()};
  if (!calibration.partial) {
    cost.record_runs = keep_cuts(folder, calibration, database, runs);
    fs::remove_all(scratch);
  }
  write_reduction(folder);
  cost.wall_seconds = database.wall_seconds();
  write_atomically(folder.path() / "manifest.json", inverse::manifest(job, code, cost.wall_seconds).dump(2) + "\n");
  const ordered_json result = inverse::calibration_json(job, calibration, cost);
  write_atomically(folder.path() / "result.json", result.dump(2) + "\n");
  if (show == Show::json)
    fmt::print("{}\n", result.dump(2));
  else if (show == Show::table)
    print_table(calibration, cost);
  return calibration.exit_code;
}

}  // namespace

ExitCode run_session(inverse::Folder& folder, const std::string& code, Show show, double max_seconds) {
  const StopOnInterrupt guard;
  const Stop stop(folder.path(), max_seconds);
  ExitCode ended = ExitCode::interrupted;
  std::string report = "; no point was simulated yet";
  try {
    ended = finish(folder, code, show, stop);
    report = "; what is known so far is in result.json";
  } catch (const inverse::Interrupted&) {
  }
  if (ended == ExitCode::interrupted) {
    const char* why = stop.reason();
    std::fflush(stdout);
    fmt::print(stderr, "{}{}. Every finished run is kept. Continue with: kerf resume {}\n", why ? why : "interrupted",
               report, folder.path().string());
  }
  return ended;
}

}  // namespace kerf::commands
