#include "inverse/sweep_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "forward/scene/scene.hpp"
#include "inverse/reduction_json.hpp"
#include "inverse/scene_kind.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* depth_path = "cut.depth";

/// A number of a result, on its way into a column.
struct Leaf {
  std::string name, unit;
  Json value;
};

std::string text_of(const Json& object, const char* key, const std::string& otherwise) {
  return object.contains(key) && object.at(key).is_string() ? object.at(key).get<std::string>() : otherwise;
}

/// Walks a result. {"value", "se", "unit"} is a number with its error; elsewhere "unit" holds for the numbers beside it
/// and "units" names those of single keys. Lists are no columns.
void collect(const Json& object, const std::string& prefix, std::vector<Leaf>& leaves) {
  const std::string common = text_of(object, "unit", "1");
  const Json units = object.contains("units") ? object.at("units") : Json::object();
  for (const auto& [key, value] : object.items()) {
    if (key == "unit" || key == "units" || value.is_array()) continue;
    const std::string name = prefix + key;
    if (value.is_object() && value.contains("value")) {
      const std::string unit = text_of(value, "unit", "1");
      leaves.push_back({name, unit, value.at("value")});
      if (value.contains("se")) leaves.push_back({name + "_se", unit, value.at("se")});
    } else if (value.is_object()) {
      collect(value, name + ".", leaves);
    } else {
      leaves.push_back(
          {name, value.is_string() || value.is_boolean() ? "1" : text_of(units, key.c_str(), common), value});
    }
  }
}

double number_at(const Json& json, const char* pointer) {
  const Json::json_pointer place(pointer);
  return json.contains(place) && json.at(place).is_number() ? json.at(place).get<double>() : std::nan("");
}

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string joined(const std::vector<std::string>& lines) {
  return fmt::format("{}", fmt::join(lines, "; "));
}

const char* verdict_of(const std::optional<RunRecord>& record) {
  return !record ? "not run" : record->accepted ? "accepted" : "refused";
}

std::vector<Leaf> leaves_of(const std::optional<RunRecord>& record) {
  std::vector<Leaf> leaves;
  if (!record) return leaves;
  if (record->result.is_object()) {
    collect(record->result, "", leaves);
    constexpr std::string_view of_bodies = "results.";
    for (Leaf& leaf : leaves)
      if (leaf.name.starts_with(of_bodies)) leaf.name.erase(0, of_bodies.size());
    if (record->result.contains("F_c")) {
      leaves.push_back({"F_t_over_F_c", "1",
                        finite(number_at(record->result, "/F_t/value") / number_at(record->result, "/F_c/value"))});
      leaves.push_back(
          {"residue_share", "1",
           finite(number_at(record->result, "/ledger/residue") / number_at(record->result, "/ledger/tool_work"))});
    }
    // One simulation keeps one core busy.
    leaves.push_back({"core_seconds", "s", finite(number_at(record->result, "/cost/processor_s"))});
  }
  std::erase_if(leaves, [](const Leaf& leaf) { return leaf.name == "accepted"; });
  leaves.push_back({"accepted", "1", record->accepted});
  leaves.push_back({"refusals", "1", joined(record->refusals)});
  return leaves;
}

/// What one looks at first, in this order.
constexpr std::array<const char*, 17> leading{"F_c",           "F_c_se",        "F_t",
                                              "F_t_se",        "F_t_over_F_c",  "branch",
                                              "crack_lead",    "crack_lead_se", "mode_I_fraction",
                                              "chip_ratio",    "chip_ratio_se", "fracture_energy_ratio",
                                              "residue_share", "steady",        "accepted",
                                              "refusals",      "core_seconds"};

Json value_json(const SweepAxis& axis, const SweepValue& value) {
  if (value.absent) return nullptr;
  return axis.numeric ? Json(*value.shown) : Json(value.text);
}

/// What all runs of a line have in common.
std::string held_in(const Sweep& sweep, std::size_t run, std::size_t axis) {
  std::string held;
  if (sweep.zip) return held;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a)
    if (a != axis && sweep.axes[a].values.size() > 1)
      held += (held.empty() ? "" : ", ") + sweep.axes[a].label(sweep.value(sweep.runs[run], a));
  return held;
}

chip::MeasuredCut measured(const forward::Scene& scene, const RunRecord& record, std::size_t run) {
  chip::MeasuredCut cut;
  cut.depth = scene.cut.depth;
  cut.rake = scene.tool.rake;
  cut.F_c = record.F_c.value;
  cut.F_t = record.F_t.value;
  cut.line = static_cast<int>(run) + 1;
  return cut;
}

SweepIntercepts extrapolate(const Sweep& sweep, const SweepRecords& records, const std::vector<std::size_t>& line,
                            std::size_t axis) {
  SweepIntercepts result;
  result.line = line;
  result.held = held_in(sweep, line.front(), axis);
  std::vector<chip::MeasuredCut> cuts;
  std::set<forward::Branch> branches;
  std::set<std::pair<double, double>> toughnesses;
  for (const std::size_t run : line) {
    if (!records[run] || !records[run]->accepted) continue;
    const forward::Scene scene = forward::read_scene(sweep.runs[run].scene);
    cuts.push_back(measured(scene, *records[run], run));
    result.runs.push_back(run);
    branches.insert(records[run]->branch);
    result.toughness_I = scene.cohesive.mode_I->toughness();
    result.toughness_II = scene.cohesive.mode_II->toughness();
    toughnesses.emplace(result.toughness_I, result.toughness_II);
  }
  if (cuts.size() < 2) {
    result.not_applied =
        fmt::format("{} accepted run{}: at least two depths are needed", cuts.size(), cuts.size() == 1 ? "" : "s");
    return result;
  }
  if (toughnesses.size() > 1) {
    result.not_applied = "the toughness of the scene changes along with the depth";
    return result;
  }
  result.cuts.emplace(std::move(cuts));
  result.reduction = chip::reduce(
      *result.cuts, {"intercept_linear", "intercept_quadratic", "intercept_exponential", "intercept_model"}, {});
  if (branches.size() > 1)
    result.warnings.emplace_back(
        "some of these cuts touch the crack tip and some bend clear of it: no single law holds");
  if (sweep.zip && sweep.axes.size() > 1) result.warnings.emplace_back("other values change along with the depth");
  return result;
}

Json intercepts_json(const SweepIntercepts& intercepts) {
  const double one = consistent_units_in("J/m^2");
  const auto numbers = [](const std::vector<std::size_t>& runs) {
    Json all = Json::array();
    for (const std::size_t run : runs) all.push_back(run + 1);
    return all;
  };
  Json json{{"held", intercepts.held}, {"line", numbers(intercepts.line)}, {"runs", numbers(intercepts.runs)}};
  if (!intercepts.not_applied.empty()) {
    json["not_applied"] = intercepts.not_applied;
    return json;
  }
  json["toughness"] = {
      {"mode_I", intercepts.toughness_I / one}, {"mode_II", intercepts.toughness_II / one}, {"unit", "J/m^2"}};
  json["errors"] = "from the scatter about each fit";
  json["reduction"] = to_json(intercepts.reduction, *intercepts.cuts);
  json["warnings"] = intercepts.warnings;
  return json;
}

}  // namespace

std::vector<Column> sweep_columns(const Sweep& sweep, const SweepRecords& records) {
  const std::size_t count = sweep.runs.size();
  std::vector<Column> fixed{{.name = "run", .unit = "1", .cells = {}}}, found;
  for (std::size_t run = 0; run < count; ++run) fixed.front().cells.push_back(run + 1);
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    fixed.push_back({.name = sweep.axes[a].name(), .unit = sweep.axes[a].unit, .cells = {}});
    for (const SweepRun& run : sweep.runs) fixed.back().cells.push_back(value_json(sweep.axes[a], sweep.value(run, a)));
  }
  fixed.push_back({.name = "verdict", .unit = "1", .cells = {}});
  for (const auto& record : records) fixed.back().cells.emplace_back(verdict_of(record));

  const bool has_bodies = SceneKind::of(sweep.scene).has_bodies;
  for (const char* name : leading)
    if (!has_bodies) found.push_back({.name = name, .unit = "1", .cells = std::vector<Json>(count)});
  for (std::size_t run = 0; run < count; ++run)
    for (Leaf& leaf : leaves_of(records[run])) {
      auto column = std::find_if(found.begin(), found.end(), [&](const auto& c) { return c.name == leaf.name; });
      if (column == found.end())
        column = found.insert(found.end(), {.name = leaf.name, .unit = leaf.unit, .cells = std::vector<Json>(count)});
      column->unit = leaf.unit;
      column->cells[run] = std::move(leaf.value);
    }
  fixed.insert(fixed.end(), std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
  return fixed;
}

std::vector<SweepIntercepts> sweep_intercepts(const Sweep& sweep, const SweepRecords& records) {
  std::vector<SweepIntercepts> all;
  for (std::size_t axis = 0; axis < sweep.axes.size(); ++axis)
    if (sweep.axes[axis].varies(depth_path) && sweep.axes[axis].values.size() > 1)
      for (const auto& line : lines_along(sweep, axis)) all.push_back(extrapolate(sweep, records, line, axis));
  return all;
}

Json sweep_json(const Sweep& sweep, const SweepRecords& records, const std::vector<SweepIntercepts>& intercepts,
                const SweepCost& cost, const Json& manifest) {
  Json axes = Json::array(), runs = Json::array(), lines = Json::array();
  for (const SweepAxis& axis : sweep.axes) {
    Json values = Json::array();
    for (const SweepValue& value : axis.values) values.push_back(value_json(axis, value));
    axes.push_back({{"paths", axis.paths},
                    {"name", axis.short_name},
                    {"unit", axis.unit},
                    {"numeric", axis.numeric},
                    {"values", std::move(values)}});
  }
  std::size_t finished = 0, accepted = 0;
  double core_seconds = 0;
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) {
    const std::optional<RunRecord>& record = records[run];
    Json values = Json::array();
    for (std::size_t a = 0; a < sweep.axes.size(); ++a)
      values.push_back(value_json(sweep.axes[a], sweep.value(sweep.runs[run], a)));
    runs.push_back({{"run", run + 1},
                    {"label", sweep.runs[run].label},
                    {"choice", sweep.runs[run].choice},
                    {"values", std::move(values)},
                    {"verdict", verdict_of(record)},
                    {"refusals", record ? Json(record->refusals) : Json::array()},
                    {"result", record ? record->result : Json(nullptr)}});
    if (!record) continue;
    ++finished;
    accepted += record->accepted ? 1 : 0;
    core_seconds += record->wall_seconds;
  }
  for (const SweepIntercepts& line : intercepts) lines.push_back(intercepts_json(line));
  return {{"kind", "sweep"},
          {"title", SceneKind::of(sweep.scene).title(sweep.scene)},
          {"bodies", SceneKind::of(sweep.scene).has_bodies},
          {"complete", finished == sweep.runs.size()},
          {"axes", std::move(axes)},
          {"zip", sweep.zip},
          {"runs", std::move(runs)},
          {"intercepts", std::move(lines)},
          {"cost",
           {{"runs", sweep.runs.size()},
            {"finished", finished},
            {"accepted", accepted},
            {"refused", finished - accepted},
            {"core_s", core_seconds},
            {"wall_s", cost.wall_seconds},
            {"simulated_by_last_session", cost.simulated}}},
          {"manifest", manifest}};
}

}  // namespace kerf::inverse
