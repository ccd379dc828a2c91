#include "inverse/commands/sweep_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "inverse/commands/interrupt.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/reduction_json.hpp"
#include "inverse/scene_kind.hpp"
#include "inverse/sweep_file.hpp"
#include "inverse/sweep_table.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using inverse::RunRecord;
using inverse::SceneFolder;
using inverse::Sweep;
using inverse::SweepAxis;
using inverse::SweepIntercepts;
using inverse::SweepRecords;
using nlohmann::ordered_json;

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

void print_table(const Sweep& sweep, const SweepRecords& records) {
  std::vector<std::vector<std::string>> rows{{"run"}};
  for (const SweepAxis& axis : sweep.axes)
    rows.front().push_back(axis.unit == "1" ? axis.short_name : fmt::format("{}[{}]", axis.short_name, axis.unit));
  for (const char* head : {"F_c[N/m]", "+-", "F_t[N/m]", "+-", "F_t/F_c", "branch", "lead[mm]", "mode I", "chip ratio",
                           "G/G_c", "residue[%]", "core-s", "verdict"})
    rows.front().emplace_back(head);
  for (std::size_t run = 0; run < records.size(); ++run) rows.push_back(cells_of(sweep, run, records[run]));
  print_columns(rows);
}

/// Of bodies: what every run found.
void print_bodies(const Sweep& sweep, const SweepRecords& records) {
  std::vector<std::string> names;
  for (const std::optional<RunRecord>& record : records)
    if (record && record->result.contains("results") && record->result.at("results").is_object())
      for (const auto& [name, value] : record->result.at("results").items())
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  std::vector<std::vector<std::string>> rows{{"run"}};
  for (const SweepAxis& axis : sweep.axes)
    rows.front().push_back(axis.unit == "1" ? axis.short_name : fmt::format("{}[{}]", axis.short_name, axis.unit));
  rows.front().insert(rows.front().end(), names.begin(), names.end());
  rows.front().insert(rows.front().end(), {"core-s", "verdict"});
  for (std::size_t run = 0; run < records.size(); ++run) {
    const std::optional<RunRecord>& record = records[run];
    std::vector<std::string>& row = rows.emplace_back(1, fmt::format("{}", run + 1));
    for (std::size_t a = 0; a < sweep.axes.size(); ++a) row.push_back(sweep.value(sweep.runs[run], a).text);
    for (const std::string& name : names) {
      const double found = record ? inverse::found_in(*record, name) : std::nan("");
      row.push_back(std::isfinite(found) ? fmt::format("{:.5g}", found) : "");
    }
    row.push_back(record ? plain(record->core_seconds(), 2) : "");
    row.emplace_back(!record ? "not run" : record->accepted ? "accepted" : "refused");
  }
  print_columns(rows);
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

}  // namespace

Sweep sweep_in(const SceneFolder& folder) {
  const ordered_json& asked = folder.request().asked;
  return inverse::lay_out_sweep(Document::parse(folder.scene().content, folder.scene().name),
                                asked.at("axes").get<std::vector<std::string>>(), asked.at("zip").get<bool>(),
                                "kerf sweep");
}

ExitCode run_sweep(SceneFolder& folder, const Sweep& sweep, const std::string& code, bool json) {
  const StopOnInterrupt guard;
  const SceneOutcome outcome = simulate_all(folder, inverse::requests_of(sweep), code);
  const std::vector<SweepIntercepts> intercepts = inverse::sweep_intercepts(sweep, outcome.records);
  const std::vector<inverse::Column> columns = inverse::sweep_columns(sweep, outcome.records);
  const ordered_json result = inverse::sweep_json(
      sweep, outcome.records, intercepts, {.wall_seconds = outcome.wall_seconds, .simulated = outcome.simulated},
      manifest_of(folder, code, outcome.wall_seconds));
  std::vector<fs::path> cut_files;
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) cut_files.push_back(folder.cut_file(run));
  write_atomically(folder.path() / "sweep.csv", inverse::csv(columns));
  write_atomically(folder.path() / "sweep.json", result.dump(2) + "\n");
  inverse::write_sweep(folder.path() / "sweep.h5", sweep, columns, cut_files);
  if (!outcome.interrupted) draw(folder.path());

  if (json) {
    fmt::print("{}\n", result.dump(2));
  } else {
    if (inverse::SceneKind::of(sweep.scene).has_bodies)
      print_bodies(sweep, outcome.records);
    else
      print_table(sweep, outcome.records);
    print_refusals(outcome);
    for (const SweepIntercepts& line : intercepts) print_intercepts(line);
  }
  std::fflush(stdout);
  return conclude(folder, outcome, "sweep.csv");
}

}  // namespace kerf::commands
