#include "inverse/study_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "forward/scene/scene.hpp"
#include "inverse/scene_kind.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

constexpr double percent = 100;

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json estimate(const Estimate& e, double factor, const char* unit) {
  return {{"value", finite(e.value * factor)}, {"se", finite(e.standard_error * factor)}, {"unit", unit}};
}

bool has_forces(const std::optional<RunRecord>& record) {
  return record && record->result.is_object();
}

Json convergence_json(const Convergence& found) {
  const double to_newton_per_metre = 1 / consistent_units_in("N/m");
  const auto interval = [](double lower, double upper, double factor) {
    return Json::array({finite(lower * factor), finite(upper * factor)});
  };
  Json json{{"resolved", found.not_resolved.empty()}, {"not_resolved", found.not_resolved}};
  if (found.limit.standard_error > 0) {
    json["limit"] = estimate(found.limit, to_newton_per_metre, "N/m");
    json["limit"]["interval"] = interval(found.limit_lower, found.limit_upper, to_newton_per_metre);
  }
  if (found.order.standard_error > 0) {
    json["order"] = estimate(found.order, 1, "1");
    json["order"]["interval"] = interval(found.order_lower, found.order_upper, 1);
    json["amplitude"] = {{"value", finite(found.amplitude * to_newton_per_metre)}, {"unit", "N/m"}};
  }
  json["scatter"] = finite(found.scatter);
  json["degrees_of_freedom"] = found.freedom;
  return json;
}

Json precision_json(const WorkPrecision& p) {
  return {{"F_c", estimate(p.F_c, percent, "%")},
          {"F_t", estimate(p.F_t, percent, "%")},
          {"larger", estimate(p.error(), percent, "%")},
          {"resolved", p.resolved()},
          {"front", p.front}};
}

}  // namespace

const char* verdict_of(const std::optional<RunRecord>& record) {
  return !record ? "not run" : record->accepted ? "accepted" : "refused";
}

std::string role_of(const Study& study, std::size_t run) {
  if (study.runs[run].knob) return study.knobs[*study.runs[run].knob].short_name;
  return run == Study::reference ? "reference" : "as it is";
}

StudyFindings study_findings(const Study& study, std::vector<std::optional<RunRecord>> records) {
  StudyFindings findings{.records = std::move(records), .precision = {}, .F_c = {}, .F_t = {}, .resolutions = {}};
  findings.precision = work_precision(findings.records, Study::reference);
  std::vector<ForceAtCell> cutting, transverse;
  std::set<forward::Branch> branches;
  for (const std::size_t run : study.resolutions()) {
    const std::optional<RunRecord>& record = findings.records[run];
    if (!record || !record->accepted) continue;
    const double cell = forward::read_scene(study.runs[run].scene).cell();
    findings.resolutions.push_back(run);
    cutting.push_back({cell, record->F_c});
    transverse.push_back({cell, record->F_t});
    branches.insert(record->branch);
  }
  findings.F_c = convergence(cutting);
  findings.F_t = convergence(transverse);
  if (branches.size() > 1)
    for (Convergence* found : {&findings.F_c, &findings.F_t})
      found->not_resolved = "at some cell sizes the tool touches the crack tip, at others the crack runs ahead";
  return findings;
}

std::vector<Column> study_frame_columns(const Study& study, const std::vector<std::optional<RunRecord>>& records,
                                        std::vector<Column> found) {
  std::vector<Column> columns{
      {"run", "1", {}}, {"knob", "1", {}}, {"value", "1", {}}, {"unit", "1", {}}, {"verdict", "1", {}}};
  std::vector<Column> costs{{"core_seconds", "s", {}}, {"particle_steps", "1", {}}, {"refusals", "1", {}}};
  for (std::size_t run = 0; run < study.runs.size(); ++run) {
    const std::optional<RunRecord>& record = records[run];
    const StudyRun& what = study.runs[run];
    const Json cost = record && record->result.contains("cost") ? record->result.at("cost") : Json::object();
    columns[0].cells.push_back(run + 1);
    columns[1].cells.push_back(role_of(study, run));
    columns[2].cells.push_back(what.number          ? Json(*what.number)
                               : what.value.empty() ? Json(nullptr)
                                                    : Json(what.value));
    columns[3].cells.push_back(what.knob && study.knobs[*what.knob].unit != "1" ? Json(study.knobs[*what.knob].unit)
                                                                                : Json(nullptr));
    columns[4].cells.push_back(verdict_of(record));
    costs[0].cells.push_back(cost.value("processor_s", Json(nullptr)));
    costs[1].cells.push_back(cost.value("particle_steps", Json(nullptr)));
    costs[2].cells.push_back(record ? Json(fmt::format("{}", fmt::join(record->refusals, "; "))) : Json(nullptr));
  }
  for (std::vector<Column>* more : {&found, &costs}) std::move(more->begin(), more->end(), std::back_inserter(columns));
  return columns;
}

std::vector<Column> study_columns(const Study& study, const StudyFindings& findings) {
  std::vector<Column> columns{{"F_c", "N/m", {}},     {"F_c_se", "N/m", {}},     {"F_t", "N/m", {}},
                              {"F_t_se", "N/m", {}},  {"error_F_c", "%", {}},    {"error_F_c_se", "%", {}},
                              {"error_F_t", "%", {}}, {"error_F_t_se", "%", {}}, {"error", "%", {}},
                              {"resolved", "1", {}},  {"front", "1", {}}};
  const double one = consistent_units_in("N/m");
  for (std::size_t run = 0; run < study.runs.size(); ++run) {
    const std::optional<RunRecord>& record = findings.records[run];
    const std::optional<WorkPrecision>& p = findings.precision[run];
    const bool told = has_forces(record);
    const auto force = [&](double value) { return told ? finite(value / one) : Json(nullptr); };
    const auto share = [&](double value) { return p ? finite(percent * value) : Json(nullptr); };
    const std::vector<Json> cells{force(record ? record->F_c.value : 0), force(record ? record->F_c.standard_error : 0),
                                  force(record ? record->F_t.value : 0), force(record ? record->F_t.standard_error : 0),
                                  share(p ? p->F_c.value : 0),           share(p ? p->F_c.standard_error : 0),
                                  share(p ? p->F_t.value : 0),           share(p ? p->F_t.standard_error : 0),
                                  share(p ? p->error().value : 0),       p ? Json(p->resolved()) : Json(nullptr),
                                  p ? Json(p->front) : Json(nullptr)};
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].cells.push_back(cells[c]);
  }
  return study_frame_columns(study, findings.records, std::move(columns));
}

Json study_frame_json(const Study& study, const std::vector<std::optional<RunRecord>>& records,
                      const std::function<Json(std::size_t)>& error, double wall_seconds, const Json& manifest) {
  Json knobs = Json::array(), runs = Json::array();
  for (const StudyKnob& knob : study.knobs)
    knobs.push_back({{"paths", knob.paths}, {"name", knob.short_name}, {"unit", knob.unit}});
  std::size_t finished = 0, accepted = 0;
  double core_seconds = 0;
  for (std::size_t run = 0; run < study.runs.size(); ++run) {
    const StudyRun& what = study.runs[run];
    const std::optional<RunRecord>& record = records[run];
    runs.push_back({{"run", run + 1},
                    {"role", what.knob                 ? "knob"
                             : run == Study::reference ? "reference"
                                                       : "as it is"},
                    {"knob", what.knob ? Json(*what.knob) : Json(nullptr)},
                    {"value", what.value},
                    {"number", what.number ? Json(*what.number) : Json(nullptr)},
                    {"label", what.label},
                    {"verdict", verdict_of(record)},
                    {"refusals", record ? Json(record->refusals) : Json::array()},
                    {"error", error(run)},
                    {"result", record ? record->result : Json(nullptr)}});
    if (!record) continue;
    ++finished;
    accepted += record->accepted ? 1 : 0;
    core_seconds += record->core_seconds();
  }
  return {{"kind", "study"},
          {"title", SceneKind::of(study.scene).title(study.scene)},
          {"complete", finished == study.runs.size()},
          {"knobs", std::move(knobs)},
          {"runs", std::move(runs)},
          {"convergence", nullptr},
          {"cost",
           {{"runs", study.runs.size()},
            {"finished", finished},
            {"accepted", accepted},
            {"refused", finished - accepted},
            {"core_s", core_seconds},
            {"wall_s", wall_seconds}}},
          {"manifest", manifest}};
}

Json study_json(const Study& study, const StudyFindings& findings, double wall_seconds, const Json& manifest) {
  const auto error = [&](std::size_t run) {
    const std::optional<WorkPrecision>& p = findings.precision[run];
    return p ? precision_json(*p) : Json(nullptr);
  };
  Json json = study_frame_json(study, findings.records, error, wall_seconds, manifest);
  Json resolutions = Json::array();
  for (const std::size_t run : findings.resolutions)
    resolutions.push_back({{"run", run + 1}, {"cell", forward::read_scene(study.runs[run].scene).cell()}});
  json["convergence"] = {{"resolutions", std::move(resolutions)},
                         {"cell_unit", "mm"},
                         {"F_c", convergence_json(findings.F_c)},
                         {"F_t", convergence_json(findings.F_t)}};
  return json;
}

}  // namespace kerf::inverse
