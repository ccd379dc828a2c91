#include "forward/record/result_json.hpp"

#include <cmath>

#include "models/base/units.hpp"

namespace kerf::forward {
namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json in_unit(const Estimate& estimate, const char* unit) {
  const double one = consistent_units_in(unit);
  return {{"value", finite_or_null(estimate.value / one)},
          {"se", finite_or_null(estimate.standard_error / one)},
          {"unit", unit}};
}

/// The chip as a circle: the standard error follows the curvature's to first order; a straight chip has no radius.
Json curl_radius(const Estimate& curvature) {
  const double radius = 1 / curvature.value;
  return in_unit({radius, std::abs(radius * curvature.standard_error / curvature.value)}, "mm");
}

Json energies(const Ledger& ledger) {
  const double one = consistent_units_in("J/m");
  Json json = Json::object();
  const auto book = [&](const char* name, double energy) { json[name] = finite_or_null(energy / one); };
  book("tool_work", ledger.tool_work);
  book("fracture", ledger.fracture);
  book("plastic", ledger.plastic);
  book("elastic", ledger.elastic);
  book("kinetic", ledger.kinetic);
  book("friction", ledger.friction);
  book("damping", ledger.damping);
  book("residue", ledger.residue());
  json["unit"] = "J/m";
  return json;
}

Json cost_of(const Cost& cost) {
  Json stages = Json::array();
  for (const StageTime& time : cost.stages)
    stages.push_back({{"stage", time.stage}, {"cpu_s", finite_or_null(time.seconds)}});
  return {{"wall_s", finite_or_null(cost.wall_seconds)},
          {"processor_s", finite_or_null(cost.processor_seconds)},
          {"steps", cost.steps},
          {"particle_steps", cost.particle_steps},
          {"particle_steps_per_s", finite_or_null(static_cast<double>(cost.particle_steps) / cost.wall_seconds)},
          {"stages", stages}};
}

/// Resistance against crack extension, and the same read at the notch, split by mode.
Json r_curve(const std::vector<ForceSample>& history) {
  const double one = consistent_units_in("J/m^2");
  Json opening = Json::array(), extension = Json::array(), resistance = Json::array(), pull = Json::array(),
       notch_I = Json::array(), notch_II = Json::array();
  for (const ForceSample& sample : history) {
    const Extension& e = sample.extension;
    opening.push_back(e.opening);
    pull.push_back(finite_or_null(sample.F_c / consistent_units_in("N/m")));
    extension.push_back(e.crack);
    resistance.push_back(finite_or_null(e.release / one));
    notch_I.push_back(finite_or_null(e.at_notch_I / one));
    notch_II.push_back(finite_or_null(e.at_notch_II / one));
  }
  return {{"opening", opening},
          {"pull", pull},
          {"extension", extension},
          {"G_R", resistance},
          {"notch_I", notch_I},
          {"notch_II", notch_II},
          {"units",
           {{"opening", "mm"},
            {"pull", "N/m"},
            {"extension", "mm"},
            {"G_R", "J/m^2"},
            {"notch_I", "J/m^2"},
            {"notch_II", "J/m^2"}}}};
}

}  // namespace

Json result_json(const CutResult& result) {
  Json json = Json::object();
  json["F_c"] = in_unit(result.F_c, "N/m");
  json["F_t"] = in_unit(result.F_t, "N/m");
  if (result.chained) json["chained"] = true;
  json["steady"] = result.steady;
  json["steady_from"] = finite_or_null(result.steady_from);
  json["accepted"] = result.accepted;
  json["refusals"] = result.refusals;
  json["branch"] = name(result.branch);
  json["crack_lead"] = finite_or_null(result.crack_lead.value);
  json["crack_lead_se"] = finite_or_null(result.crack_lead.standard_error);
  json["softening_lead"] = finite_or_null(result.softening_lead.value);
  json["process_zone"] = finite_or_null(result.process_zone);
  json["mode_I_fraction"] = finite_or_null(result.mode_I_fraction);
  json["fracture_energy"] = {{"value", finite_or_null(result.fracture_energy / consistent_units_in("J/m^2"))},
                             {"unit", "J/m^2"}};
  json["fracture_energy_ratio"] = finite_or_null(result.fracture_energy_ratio);
  json["chip_ratio"] = in_unit(result.chip_ratio, "1");
  json["curl_radius"] = curl_radius(result.chip_curvature);
  json["faces"] = Json::object();
  for (const FaceResult& face : result.faces) {
    const std::string face_name = name(face.face);
    json["faces"][face_name + "_normal"] = in_unit(face.normal, "N/m");
    json["faces"][face_name + "_tangential"] = in_unit(face.tangential, "N/m");
    json["faces"][face_name + "_contact_length"] = in_unit(face.contact_length, "mm");
  }
  if (result.is_specimen) json["r_curve"] = r_curve(result.history);
  if (result.heat)
    json["temperature"] = {
        {"chip", finite_or_null(result.heat->chip)}, {"highest", finite_or_null(result.heat->highest)}, {"unit", "K"}};
  if (result.heat && result.heat->friction)
    json["friction_heat"] = {{"value", finite_or_null(*result.heat->friction / consistent_units_in("J/m"))},
                             {"unit", "J/m"}};
  json["ledger"] = energies(result.ledger);
  json["deepest_penetration"] = finite_or_null(result.deepest_penetration);
  json["inertia_share"] = finite_or_null(result.inertia_share);
  json["cost"] = cost_of(result.cost);
  json["units"] = {{"steady_from", "mm"},    {"crack_lead", "mm"},   {"crack_lead_se", "mm"},
                   {"softening_lead", "mm"}, {"process_zone", "mm"}, {"deepest_penetration", "cells"}};
  return json;
}

}  // namespace kerf::forward
