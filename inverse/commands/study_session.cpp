#include "inverse/commands/study_session.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "inverse/bodies_study.hpp"
#include "inverse/commands/interrupt.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/scene_kind.hpp"
#include "inverse/study_table.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

using inverse::Convergence;
using inverse::SceneFolder;
using inverse::Study;
using inverse::StudyFindings;
using nlohmann::ordered_json;

/// "-1.23 +- 0.10" per cent.
std::vector<std::string> in_percent(const Estimate& share) {
  return {plain(100 * share.value, 2), plain(100 * share.standard_error, 2)};
}

std::vector<std::string> cells_of(const Study& study, const StudyFindings& findings, std::size_t run) {
  std::vector<std::string> cells{fmt::format("{}", run + 1), study.runs[run].label};
  const auto& record = findings.records[run];
  const auto& precision = findings.precision[run];
  const std::size_t columns = 13;
  if (record && record->result.is_object()) {
    for (const Estimate& force : {record->F_c, record->F_t}) {
      cells.push_back(in_newton_per_metre(force.value));
      cells.push_back(in_newton_per_metre(force.standard_error));
    }
    if (precision)
      for (const Estimate& share : {precision->F_c, precision->F_t})
        for (std::string& cell : in_percent(share)) cells.push_back(std::move(cell));
    else
      cells.resize(10, "");
    const ordered_json& cost = record->result.at("cost");
    cells.push_back(cost.at("processor_s").is_number() ? plain(cost.at("processor_s").get<double>(), 1) : "-");
    cells.push_back(fmt::format("{:.3g}", cost.at("particle_steps").get<double>()));
  }
  cells.resize(columns - 1, "");
  cells.emplace_back(!record                   ? "not run"
                     : !record->accepted       ? "refused"
                     : run == Study::reference ? "reference"
                     : !precision              ? "accepted"
                     : precision->front        ? "on the front"
                     : precision->resolved()   ? ""
                                               : "not told from the reference");
  return cells;
}

void print_table(const Study& study, const StudyFindings& findings) {
  std::vector<std::vector<std::string>> rows{{"run", "what is turned", "F_c[N/m]", "+-", "F_t[N/m]", "+-",
                                              "error F_c[%]", "+-", "F_t[% F_c]", "+-", "core-s", "particle-steps",
                                              ""}};
  for (std::size_t run = 0; run < study.runs.size(); ++run) rows.push_back(cells_of(study, findings, run));
  print_columns(rows);
}

void print_convergence(const char* force, const Convergence& found) {
  const double one = consistent_units_in("N/m");
  fmt::print("  {}: ", force);
  if (found.limit.standard_error > 0)
    fmt::print("limit {:.0f} +- {:.0f} N/m", found.limit.value / one, found.limit.standard_error / one);
  if (found.not_resolved.empty())
    fmt::print(" (95 %: {:.0f} ... {:.0f}), order {:.2f} (95 %: {:.2f} ... {:.2f}), scatter {:.1f} standard errors\n",
               found.limit_lower / one, found.limit_upper / one, found.order.value, found.order_lower,
               found.order_upper, found.scatter);
  else
    fmt::print("{}order not resolvable: {}\n", found.limit.standard_error > 0 ? "; " : "", found.not_resolved);
}

std::vector<std::string> cells_of_bodies(const Study& study, const inverse::BodiesFindings& findings, std::size_t run) {
  std::vector<std::string> cells{fmt::format("{}", run + 1), study.runs[run].label};
  const auto& record = findings.records[run];
  const auto& precision = findings.precision[run];
  if (record && record->result.is_object()) {
    cells.push_back(fmt::format("{:.6g}", inverse::found_in(*record, findings.result)));
    cells.push_back(precision ? fmt::format("{:+.3g}", 100 * precision->result->value) : "");
    cells.push_back(plain(record->core_seconds(), 2));
    cells.push_back(fmt::format("{:.3g}", record->result.at("cost").at("particle_steps").get<double>()));
  }
  cells.resize(6, "");
  cells.emplace_back(!record                         ? "not run"
                     : !record->accepted             ? "refused"
                     : precision && precision->front ? "on the front"
                     : run == Study::reference       ? "reference"
                                                     : "");
  return cells;
}

void print_bodies(const Study& study, const inverse::BodiesFindings& findings) {
  std::vector<std::vector<std::string>> rows{
      {"run", "what is turned", findings.result, "off[%]", "core-s", "particle-steps", ""}};
  for (std::size_t run = 0; run < study.runs.size(); ++run) rows.push_back(cells_of_bodies(study, findings, run));
  print_columns(rows);
  fmt::print("\n{} is {}\n", findings.result,
             findings.closed_form ? "a share off a closed form" : "compared with that of the reference");
}

void print_order(const inverse::ObservedOrder& order) {
  fmt::print("order in the cell size: {}", order.all ? fmt::format("{:.2f}", *order.all) : "needs two accepted sizes");
  for (std::size_t i = 0; i < order.between.size(); ++i)
    fmt::print("{}{:.2f} from {:.4g} to {:.4g} mm", i == 0 ? "; " : ", ", order.between[i], order.points[i].cell,
               order.points[i + 1].cell);
  fmt::print("\n");
}

}  // namespace

Study study_in(const SceneFolder& folder) {
  const ordered_json& asked = folder.request().asked;
  Study study = inverse::lay_out_study(Document::parse(folder.scene().content, folder.scene().name),
                                       asked.at("knobs").get<std::vector<std::string>>(),
                                       asked.at("reference").get<std::vector<std::string>>(), "kerf study");
  study.result = asked.value("result", "");
  return study;
}

ExitCode run_study(SceneFolder& folder, const Study& study, const std::string& code, bool json) {
  const StopOnInterrupt guard;
  SceneOutcome outcome = simulate_all(folder, inverse::requests_of(study), code);
  const ordered_json manifest = manifest_of(folder, code, outcome.wall_seconds);
  std::optional<StudyFindings> cuts;
  std::optional<inverse::BodiesFindings> bodies;
  ordered_json result;
  std::vector<inverse::Column> columns;
  if (inverse::SceneKind::of(study.scene).has_bodies) {
    bodies = inverse::bodies_findings(study, outcome.records);
    result = inverse::bodies_study_json(study, *bodies, outcome.wall_seconds, manifest);
    columns = inverse::bodies_study_columns(study, *bodies);
  } else {
    cuts = inverse::study_findings(study, outcome.records);
    result = inverse::study_json(study, *cuts, outcome.wall_seconds, manifest);
    columns = inverse::study_columns(study, *cuts);
  }
  write_atomically(folder.path() / "study.csv", inverse::csv(columns));
  write_atomically(folder.path() / "study.json", result.dump(2) + "\n");
  if (!outcome.interrupted) draw(folder.path());

  if (json) {
    fmt::print("{}\n", result.dump(2));
  } else if (bodies) {
    print_bodies(study, *bodies);
    print_refusals(outcome);
    print_order(bodies->order);
  } else {
    print_table(study, *cuts);
    print_refusals(outcome);
    fmt::print("\nconvergence in the cell size, F = F_0 + C h^p\n");
    print_convergence("F_c", cuts->F_c);
    print_convergence("F_t", cuts->F_t);
  }
  std::fflush(stdout);
  return conclude(folder, outcome, "study.csv");
}

}  // namespace kerf::commands
