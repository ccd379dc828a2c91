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
  return {{"wall_s", finite_or_null(cost.wall_seconds)},
          {"steps", cost.steps},
          {"particle_steps", cost.particle_steps},
          {"particle_steps_per_s", finite_or_null(static_cast<double>(cost.particle_steps) / cost.wall_seconds)}};
}

}  // namespace

Json result_json(const CutResult& result) {
  Json json = Json::object();
  json["F_c"] = in_unit(result.F_c, "N/m");
  json["F_t"] = in_unit(result.F_t, "N/m");
  json["steady"] = result.steady;
  json["steady_from"] = finite_or_null(result.steady_from);
  json["accepted"] = result.accepted;
  json["refusals"] = result.refusals;
  json["branch"] = name(result.branch);
  json["crack_lead"] = finite_or_null(result.crack_lead.value);
  json["crack_lead_se"] = finite_or_null(result.crack_lead.standard_error);
  json["process_zone"] = finite_or_null(result.process_zone);
  json["mode_I_fraction"] = finite_or_null(result.mode_I_fraction);
  json["fracture_energy_ratio"] = finite_or_null(result.fracture_energy_ratio);
  json["chip_ratio"] = in_unit(result.chip_ratio, "1");
  json["curl_radius"] = curl_radius(result.chip_curvature);
  json["faces"] = {{"rake_normal", in_unit(result.rake_normal, "N/m")},
                   {"rake_tangential", in_unit(result.rake_tangential, "N/m")},
                   {"bottom_normal", in_unit(result.bottom_normal, "N/m")},
                   {"bottom_tangential", in_unit(result.bottom_tangential, "N/m")}};
  json["ledger"] = energies(result.ledger);
  json["deepest_penetration"] = finite_or_null(result.deepest_penetration);
  json["cost"] = cost_of(result.cost);
  json["units"] = {{"steady_from", "mm"},
                   {"crack_lead", "mm"},
                   {"crack_lead_se", "mm"},
                   {"process_zone", "mm"},
                   {"deepest_penetration", "cells"}};
  return json;
}

}  // namespace kerf::forward
