#include "inverse/run_record.hpp"

#include <cmath>
#include <limits>

#include "forward/record/result_json.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity and no NaN; nlohmann would write null and forget which it was.
Json number(double value) {
  if (std::isfinite(value)) return value;
  if (std::isnan(value)) return "nan";
  return value > 0 ? "inf" : "-inf";
}

double number_from(const Json& json) {
  if (json.is_number()) return json.get<double>();
  const std::string text = json.get<std::string>();
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::quiet_NaN();
}

Json estimate(const Estimate& e) {
  return Json::array({number(e.value), number(e.standard_error)});
}
Estimate estimate_from(const Json& json) {
  return {number_from(json.at(0)), number_from(json.at(1))};
}

}  // namespace

RunRecord summarise(const forward::CutResult& result) {
  return {.F_c = result.F_c,
          .F_t = result.F_t,
          .chip_ratio = result.chip_ratio,
          .chip_curvature = result.chip_curvature,
          .crack_lead = result.crack_lead,
          .branch = result.branch,
          .mode_I_fraction = result.mode_I_fraction,
          .fracture_energy_ratio = result.fracture_energy_ratio,
          .deepest_penetration = result.deepest_penetration,
          .steady = result.steady,
          .accepted = result.accepted,
          .refusals = result.refusals,
          .ledger = result.ledger,
          .wall_seconds = result.cost.wall_seconds,
          .result = forward::result_json(result),
          .retried = {}};
}

RunRecord summarise(const forward::bodies::BodiesResult& result) {
  RunRecord record;
  record.accepted = result.accepted;
  record.refusals = result.refusals;
  record.wall_seconds = result.wall_seconds;
  record.result = {{"results", result.measures}, {"cost", forward::bodies::cost_json(result)}};
  return record;
}

double found_in(const RunRecord& record, const std::string& name) {
  const Json::json_pointer place("/results/" + name);
  return record.result.contains(place) && record.result.at(place).is_number()
             ? record.result.at(place).get<double>()
             : std::numeric_limits<double>::quiet_NaN();
}

double RunRecord::core_seconds() const {
  const Json::json_pointer place("/cost/processor_s");
  return result.contains(place) && result.at(place).is_number() ? result.at(place).get<double>() : 0;
}

double resistance(const RunRecord& record, double extension) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto found = record.result.find("r_curve");
  if (!record.result.is_object() || found == record.result.end()) return none;
  const Json& extensions = found->at("extension");
  const Json& resistances = found->at("G_R");
  double before = 0, at_before = none;  // the last level that had not grown farther
  for (std::size_t i = 0; i < extensions.size(); ++i) {
    if (!extensions[i].is_number() || !resistances[i].is_number()) continue;
    const double here = extensions[i].get<double>();
    const bool grows_next = i + 1 < extensions.size() && extensions[i + 1] != extensions[i];
    if (!grows_next) continue;
    const double at_here = resistances[i].get<double>();
    if (here <= extension) {
      before = here;
      at_before = at_here;
      continue;
    }
    const double share = (extension - before) / (here - before);
    return (at_before + share * (at_here - at_before)) * consistent_units_in("J/m^2");
  }
  return none;
}

RunRecord refused(std::string cause) {
  RunRecord record;
  record.refusals.push_back(std::move(cause));
  return record;
}

Json to_json(const RunRecord& r) {
  const forward::Ledger& l = r.ledger;
  Json json{{"F_c", estimate(r.F_c)},
            {"F_t", estimate(r.F_t)},
            {"chip_ratio", estimate(r.chip_ratio)},
            {"chip_curvature", estimate(r.chip_curvature)},
            {"crack_lead", estimate(r.crack_lead)},
            {"branch", r.branch == forward::Branch::bending ? "bending" : "touching"},
            {"mode_I_fraction", number(r.mode_I_fraction)},
            {"fracture_energy_ratio", number(r.fracture_energy_ratio)},
            {"deepest_penetration", number(r.deepest_penetration)},
            {"steady", r.steady},
            {"accepted", r.accepted},
            {"refusals", r.refusals},
            {"ledger", Json::array({number(l.tool_work), number(l.fracture), number(l.plastic), number(l.elastic),
                                    number(l.kinetic), number(l.friction), number(l.damping)})},
            {"wall_s", number(r.wall_seconds)},
            {"result", r.result}};
  if (!r.retried.empty()) json["retried"] = r.retried;
  if (r.lost) json["lost"] = true;
  return json;
}

RunRecord record_from_json(const Json& json) {
  const Json& l = json.at("ledger");
  return {.F_c = estimate_from(json.at("F_c")),
          .F_t = estimate_from(json.at("F_t")),
          .chip_ratio = estimate_from(json.at("chip_ratio")),
          .chip_curvature = estimate_from(json.at("chip_curvature")),
          .crack_lead = estimate_from(json.at("crack_lead")),
          .branch = json.at("branch") == "bending" ? forward::Branch::bending : forward::Branch::touching,
          .mode_I_fraction = number_from(json.at("mode_I_fraction")),
          .fracture_energy_ratio = number_from(json.at("fracture_energy_ratio")),
          .deepest_penetration = number_from(json.at("deepest_penetration")),
          .steady = json.at("steady").get<bool>(),
          .accepted = json.at("accepted").get<bool>(),
          .refusals = json.at("refusals").get<std::vector<std::string>>(),
          .ledger = {.tool_work = number_from(l.at(0)),
                     .fracture = number_from(l.at(1)),
                     .plastic = number_from(l.at(2)),
                     .elastic = number_from(l.at(3)),
                     .kinetic = number_from(l.at(4)),
                     .friction = number_from(l.at(5)),
                     .damping = number_from(l.at(6))},
          .wall_seconds = number_from(json.at("wall_s")),
          .result = json.at("result"),
          .retried = json.value("retried", ""),
          .lost = json.value("lost", false)};
}

}  // namespace kerf::inverse
