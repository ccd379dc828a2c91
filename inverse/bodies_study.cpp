#include "inverse/bodies_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "inverse/scene_kind.hpp"
#include "inverse/study_table.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

constexpr double percent = 100;

/// Names of the numbers that a run found.
std::vector<std::string> names_in(const std::optional<RunRecord>& record) {
  std::vector<std::string> names;
  if (record && record->result.contains("results") && record->result.at("results").is_object())
    for (const auto& [name, value] : record->result.at("results").items())
      if (value.is_number()) names.push_back(name);
  return names;
}

std::string result_of(const Study& study, const std::vector<std::optional<RunRecord>>& records) {
  std::vector<std::string> names = names_in(records[Study::as_it_is]);
  for (std::size_t run = 0; names.empty() && run < records.size(); ++run) names = names_in(records[run]);
  if (study.result.empty()) {
    const auto error = std::find_if(names.begin(), names.end(), is_off_closed_form);
    return error != names.end() ? *error : names.empty() ? "" : names.front();
  }
  if (!names.empty() && std::find(names.begin(), names.end(), study.result) == names.end())
    throw InputError(fmt::format("kerf study: --result {}: the scene finds no such thing (it finds: {})", study.result,
                                 fmt::join(names, ", ")),
                     ExitCode::usage);
  return study.result;
}

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json order_json(const ObservedOrder& order) {
  Json points = Json::array();
  for (const ObservedOrder::Point& point : order.points)
    points.push_back({{"run", point.run + 1}, {"cell", point.cell}, {"error", percent * point.error}});
  return {{"resolutions", std::move(points)},
          {"cell_unit", "mm"},
          {"error_unit", "%"},
          {"orders_between", order.between},
          {"order", order.all ? Json(*order.all) : Json(nullptr)}};
}

}  // namespace

ObservedOrder observed_order(std::vector<ObservedOrder::Point> points) {
  std::erase_if(points, [](const ObservedOrder::Point& p) { return !(p.cell > 0.0 && p.error > 0.0); });
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.cell > b.cell; });
  ObservedOrder order{.points = std::move(points), .between = {}, .all = {}};
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(order.points.size());
  for (std::size_t i = 0; i < order.points.size(); ++i) {
    const ObservedOrder::Point& at = order.points[i];
    const double h = std::log(at.cell), e = std::log(at.error);
    x += h;
    y += e;
    xx += h * h;
    xy += h * e;
    if (i == 0) continue;
    const ObservedOrder::Point& coarser = order.points[i - 1];
    order.between.push_back(std::log(coarser.error / at.error) / std::log(coarser.cell / at.cell));
  }
  if (order.points.size() > 1) order.all = (n * xy - x * y) / (n * xx - x * x);
  return order;
}

BodiesFindings bodies_findings(const Study& study, std::vector<std::optional<RunRecord>> records) {
  BodiesFindings findings{
      .result = result_of(study, records), .closed_form = false, .records = {}, .precision = {}, .order = {}};
  findings.records = std::move(records);
  findings.closed_form = is_off_closed_form(findings.result);
  findings.precision = work_precision(findings.records, Study::reference, findings.result);
  std::vector<ObservedOrder::Point> points;
  for (const std::size_t run : study.resolutions())
    if (const auto& precision = findings.precision[run])
      points.push_back({run, SceneKind{.has_bodies = true}.cell(study.runs[run].scene), precision->error().value});
  findings.order = observed_order(std::move(points));
  return findings;
}

std::vector<Column> bodies_study_columns(const Study& study, const BodiesFindings& findings) {
  std::vector<Column> columns{
      {findings.result.empty() ? "result" : findings.result, "1", {}}, {"error", "%", {}}, {"front", "1", {}}};
  for (std::size_t run = 0; run < study.runs.size(); ++run) {
    const std::optional<RunRecord>& record = findings.records[run];
    const std::optional<WorkPrecision>& p = findings.precision[run];
    columns[0].cells.push_back(record ? finite(found_in(*record, findings.result)) : Json(nullptr));
    columns[1].cells.push_back(p ? finite(percent * p->result->value) : Json(nullptr));
    columns[2].cells.push_back(p ? Json(p->front) : Json(nullptr));
  }
  return study_frame_columns(study, findings.records, std::move(columns));
}

Json bodies_study_json(const Study& study, const BodiesFindings& findings, double wall_seconds, const Json& manifest) {
  const auto error = [&](std::size_t run) -> Json {
    const std::optional<WorkPrecision>& p = findings.precision[run];
    if (!p) return nullptr;
    return {{"larger", {{"value", percent * p->error().value}, {"se", 0.0}, {"unit", "%"}}},
            {"signed", {{"value", percent * p->result->value}, {"unit", "%"}}},
            {"resolved", true},
            {"front", p->front}};
  };
  Json json = study_frame_json(study, findings.records, error, wall_seconds, manifest);
  json["bodies"] = {{"result", findings.result}, {"closed_form", findings.closed_form}};
  json["convergence"] = order_json(findings.order);
  return json;
}

}  // namespace kerf::inverse
