#include "inverse/calibration_json.hpp"

#include <cmath>

#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
Json in_unit(double value, const std::string& unit) {
  return number(value / consistent_units_in(unit));
}

Json interval(const Interval& limits, const std::string& unit) {
  return Json::array({in_unit(limits.lower, unit), in_unit(limits.upper, unit)});
}

Json end(const std::optional<ProfileEnd>& at) {
  if (!at) return nullptr;
  return {{"chi2_predicted", number(at->predicted)},
          {"chi2_simulated", at->simulated ? number(*at->simulated) : Json()}};
}

Json profile(const ParameterEstimate& p) {
  Json values = Json::array(), chi2 = Json::array();
  for (const auto& [value, least] : p.profile) {
    values.push_back(in_unit(value, p.unit));
    chi2.push_back(number(least));
  }
  return {{"value", std::move(values)}, {"chi2", std::move(chi2)}};
}

Json parameter(const ParameterEstimate& p) {
  Json json{{"value", in_unit(p.value, p.unit)},
            {"se", in_unit(p.standard_error, p.unit)},
            {"interval", interval(p.interval, p.unit)},
            {"unit", p.unit},
            {"verdict", name(p.verdict)},
            {"path", p.path},
            {"bounds", interval(p.bounds, p.unit)},
            {"ends", Json::array({end(p.lower_end), end(p.upper_end)})},
            {"profile", profile(p)}};
  if (p.trade_off)
    json["trade_off"] = {{"with", p.trade_off->partner},
                         {"exponent", number(p.trade_off->exponent)},
                         {"relative_error", number(p.trade_off->relative_error)}};
  return json;
}

Json parameters(const std::vector<ParameterEstimate>& estimates) {
  Json all = Json::object();
  for (const ParameterEstimate& p : estimates) all[p.name] = parameter(p);
  return all;
}

/// Every refit's estimates by name, in the units of the estimates themselves.
Json resampling(const Fit& fit) {
  std::vector<const ParameterEstimate*> order;
  for (const ParameterEstimate& p : fit.identifiability.parameters) order.push_back(&p);
  for (const ParameterEstimate& p : fit.identifiability.derived) order.push_back(&p);
  const auto named = [&](const std::vector<double>& values) {
    Json json = Json::object();
    for (std::size_t j = 0; j < values.size(); ++j) json[order[j]->name] = in_unit(values[j], order[j]->unit);
    return json;
  };
  const auto all = [&](const std::vector<LeftOut>& refits) {
    Json json = Json::array();
    for (const LeftOut& refit : refits) json.push_back({{"without", refit.what}, {"parameters", named(refit.values)}});
    return json;
  };
  const Resampling& r = fit.resampling;
  Json json{{"without_cut", all(r.without_cut)}, {"without_specimen", all(r.without_specimen)}};
  if (r.bootstrap)
    json["bootstrap"] = {{"specimens", r.bootstrap->specimens},
                         {"draws", r.bootstrap->draws},
                         {"sd", named(r.bootstrap->standard_deviations)}};
  return json;
}

Json rows(const Eigen::MatrixXd& matrix) {
  Json all = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(number(matrix(i, j)));
    all.push_back(row);
  }
  return all;
}

/// One observable of one cut. The fitted value is the simulated one and what the edge force adds to it.
Json observable(const Job& job, const Fit& fit, const Misfit& misfit, std::size_t index, std::size_t k) {
  const RunRecord& run = fit.at.runs[index];
  const auto row = static_cast<Eigen::Index>(index), column = static_cast<Eigen::Index>(k);
  const std::array<Estimate, observable_count> all{run.F_c, run.F_t, run.chip_ratio, run.chip_curvature,
                                                   Estimate{fit.at.simulated(row, column), 0.0}};
  const Observations fitted = misfit.fitted(fit.at.simulated, fit.at.point, fit.residuals.edge_force);
  const std::string unit = observable_units[k];
  Json entry{{"unit", unit},
             {"simulated", in_unit(all[k].value, unit)},
             {"simulated_se", in_unit(all[k].standard_error, unit)},
             {"fitted", in_unit(fitted(row, column), unit)}};
  if (fit.model && fit.at.usable[index]) entry["fitted_se"] = in_unit(fit.fitted_errors(row, column), unit);
  const std::optional<Estimate>& measured = job.cuts[index].measured[k];
  if (!measured) return entry;
  entry["measured"] = in_unit(measured->value, unit);
  entry["se"] = in_unit(measured->standard_error, unit);
  entry["residual_sd"] = in_unit(fit.residual_errors(row, column), unit);
  const Eigen::Index place = row * static_cast<Eigen::Index>(observable_count) + column;
  entry["weighted_residual"] = fit.at.usable[index] ? number(-fit.residuals.standardised[place]) : Json(nullptr);
  return entry;
}

Json cut(const Job& job, const Fit& fit, const Misfit& misfit, std::size_t index) {
  const MeasuredCut& measured = job.cuts[index];
  const RunRecord& run = fit.at.runs[index];
  Json json{{"curve", job.curves[measured.curve].file.name},
            {"line", measured.row},
            {"specimen", measured.specimen},
            {"depth_mm", measured.depth},
            {"rake_deg", in_unit(measured.rake, "deg")}};
  if (measured.extension) json["extension_mm"] = *measured.extension;
  for (std::size_t k = 0; k < observable_count; ++k) json[observable_names[k]] = observable(job, fit, misfit, index, k);
  json["accepted"] = run.accepted;
  json["usable"] = bool(fit.at.usable[index]);
  json["refusals"] = run.refusals;
  json["branch"] = forward::name(run.branch);
  json["at_branch_jump"] = index < fit.at_jump.size() && fit.at_jump[index];
  json["mode_I_fraction"] = number(run.mode_I_fraction);
  json["fracture_energy_ratio"] = number(run.fracture_energy_ratio);
  json["crack_lead_mm"] = number(run.crack_lead.value);
  json["wall_s"] = number(run.wall_seconds);
  return json;
}

Json trace(const Job& job, const std::vector<TraceEntry>& entries) {
  const ParameterSpace space(job);
  Json all = Json::array();
  for (const TraceEntry& entry : entries) {
    Json point = Json::object();
    for (Eigen::Index j = 0; j < space.dimension(); ++j) {
      const FreeParameter& p = space.parameters()[static_cast<std::size_t>(j)];
      point[p.name] = in_unit(space.value(j, entry.point[j]), p.unit);
    }
    if (job.edge_force) point["edge_force"] = in_unit(entry.edge_force, "N/mm");
    all.push_back({{"step", entry.what},
                   {"runs", entry.runs},
                   {"core_s", entry.core_seconds},
                   {"chi2", number(entry.chi2)},
                   {"failed_cuts", entry.failed_cuts},
                   {"parameters", std::move(point)}});
  }
  return all;
}

/// What holds under one assumption about the edge: the fit itself and every alternative to it say the same things.
void add_fit(Json& json, const Fit& fit) {
  const Identifiability& known = fit.identifiability;
  json["assumption"] = fit.assumption;
  if (fit.share) json["cutting_share"] = name(*fit.share);
  json["converged"] = fit.converged;
  json["reason"] = fit.reason;
  json["chi2"] = number(fit.residuals.chi2);
  json["degrees_of_freedom"] = known.degrees_of_freedom;
  json["error_scale"] = number(known.error_scale);
  json["parameters"] = parameters(known.parameters);
  json["derived"] = parameters(known.derived);
}

Json noise_audit(const NoiseAudit& audit, const OptimiserChoice& choice) {
  Json rows = Json::array();
  const auto or_null = [](const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); };
  for (const ObservableNoise& entry : audit.observables) {
    Json row{{"cut", entry.cut},
             {"observable", observable_names[static_cast<std::size_t>(entry.observable)]},
             {"difference_table", nullptr},
             {"difference_order", nullptr},
             {"jitter", or_null(entry.jitter)},
             {"curvature", or_null(entry.curvature)},
             {"noise", number(entry.noise)},
             {"step", or_null(entry.step)}};
    if (entry.table && entry.table->outcome == DifferenceTable::Outcome::found) {
      row["difference_table"] = number(entry.table->noise);
      row["difference_order"] = entry.table->order;
    }
    rows.push_back(std::move(row));
  }
  return {{"noise", number(audit.noise)},
          {"roughness", or_null(audit.roughness)},
          {"step", number(audit.step)},
          {"used_noise", number(choice.noise_given ? choice.noise : audit.noise)},
          {"used_step", number(choice.step_given ? choice.step : audit.step)},
          {"runs", audit.runs},
          {"note", audit.note},
          {"observables", std::move(rows)}};
}

Json identifiability(const Identifiability& known) {
  Json names = Json::array(), values = Json::array();
  for (const ParameterEstimate& p : known.parameters) names.push_back(p.name);
  for (const double value : known.singular_values) values.push_back(number(value));
  return {{"names", std::move(names)},
          {"singular_values", std::move(values)},
          {"condition", number(known.condition)},
          {"singular_vectors", rows(known.singular_vectors.transpose())},
          {"correlation", rows(known.correlation)},
          {"interval_half_width_in_se", number(known.quantile)}};
}

/// The free parameters of a search without slopes, which judges none of them.
Json where_it_stopped(const Job& job, const Fit& fit) {
  const ParameterSpace space(job);
  Json point = Json::object();
  for (Eigen::Index j = 0; j < space.dimension(); ++j) {
    const FreeParameter& p = space.parameters()[static_cast<std::size_t>(j)];
    point[p.name] = {{"value", in_unit(space.value(j, fit.at.point[j]), p.unit)}, {"unit", p.unit}, {"path", p.path}};
  }
  return point;
}

/// Shares of the variance by source, of every parameter and derived quantity that the data see.
Json error_budget(const Fit& fit) {
  Json all = Json::object();
  auto shares = fit.error_budget.begin();
  for (const std::vector<ParameterEstimate>* estimates :
       {&fit.identifiability.parameters, &fit.identifiability.derived})
    for (const ParameterEstimate& p : *estimates) {
      const std::optional<VarianceShares>& found = *shares++;
      Json row = nullptr;
      if (found) {
        for (std::size_t s = 0; s < error_source_count; ++s) row[error_source_names[s]] = number(found->source[s]);
        row["unexplained"] = number(found->unexplained);
      }
      all[p.name] = std::move(row);
    }
  return all;
}

/// Every estimate's interval and some four hundred draws, evenly spread over all.
Json posterior(const Fit& fit) {
  constexpr Eigen::Index shown = 400;
  const Posterior& p = *fit.posterior;
  Json intervals = Json::object(), draws = Json::object();
  Eigen::Index column = 0;
  for (const std::vector<ParameterEstimate>* all : {&fit.identifiability.parameters, &fit.identifiability.derived})
    for (const ParameterEstimate& estimate : *all) {
      intervals[estimate.name] = interval(p.intervals[static_cast<std::size_t>(column)], estimate.unit);
      Json& some = draws[estimate.name] = Json::array();
      for (Eigen::Index i = 0; i < std::min(shown, p.draws.rows()); ++i)
        some.push_back(in_unit(p.draws(i * p.draws.rows() / std::min(shown, p.draws.rows()), column), estimate.unit));
      ++column;
    }
  return {{"draws", p.draws.rows()},
          {"independent", p.independent()},
          {"acceptance", number(p.acceptance)},
          {"autocorrelation_time", number(p.autocorrelation_time)},
          {"intervals", std::move(intervals)},
          {"sample", std::move(draws)}};
}

/// Shifts of the estimates by name, in their own units and in standard errors.
Json numerics(const Calibration& calibration) {
  Json all = Json::array();
  for (const NumericsShift& check : calibration.numerics) {
    Json shifts = Json::object();
    auto shift = check.shifts.begin();
    for (const std::vector<ParameterEstimate>* estimates :
         {&calibration.fit.identifiability.parameters, &calibration.fit.identifiability.derived})
      for (const ParameterEstimate& p : *estimates) {
        if (shift == check.shifts.end()) break;
        shifts[p.name] = {{"shift", in_unit(*shift, p.unit)},
                          {"unit", p.unit},
                          {"standard_errors", number(*shift / p.standard_error)}};
        ++shift;
      }
    all.push_back({{"name", check.name},
                   {"cuts", check.cuts},
                   {"runs", check.runs},
                   {"chi2", number(check.chi2)},
                   {"shifts", std::move(shifts)}});
  }
  return all;
}

Json free_start(const Job& job, const Calibration& calibration) {
  const ParameterSpace space(job);
  Json start = Json::object();
  for (Eigen::Index j = 0; j < space.dimension(); ++j) {
    const FreeParameter& p = job.free[static_cast<std::size_t>(j)];
    start[p.name] = in_unit(space.value(j, calibration.start[j]), p.unit);
  }
  return start;
}

}  // namespace

Json calibration_json(const Job& job, const Calibration& calibration, const CalibrationCost& cost) {
  const Fit& fit = calibration.fit;
  const ParameterSpace space(job);
  Misfit misfit(job, space);
  Json result{{"title", job.title}, {"statement", calibration.statement}};
  add_fit(result, fit);
  if (!calibration.alternatives.empty())
    for (const char* kind : {"parameters", "derived"})
      for (auto& [name, json] : result[kind].items())
        json["interval_over_assumptions"] =
            interval(over_all_assumptions(calibration, name), json["unit"].get<std::string>());
  if (calibration.partial) result["partial"] = true;
  result["exit_code"] = static_cast<int>(calibration.exit_code);
  result["method"] = job.optimiser.method;
  result["runs"] = cost.runs;
  result["failed_runs"] = cost.failed_runs;
  result["record_runs"] = cost.record_runs;
  result["core_s"] = cost.core_seconds;
  result["wall_s"] = cost.wall_seconds;
  result["noise_audit"] = calibration.audit ? noise_audit(*calibration.audit, job.optimiser) : Json(nullptr);
  result["identifiability"] = identifiability(fit.identifiability);
  if (fit.model)
    result["error_budget"] = error_budget(fit);
  else
    result["stopped_at"] = where_it_stopped(job, fit);
  if (fit.posterior) result["posterior"] = posterior(fit);
  result["numerics"] = numerics(calibration);
  result["resampling"] = resampling(fit);
  result["alternatives"] = Json::array();
  for (const Fit& other : calibration.alternatives) add_fit(result["alternatives"].emplace_back(Json::object()), other);
  result["cuts"] = Json::array();
  for (std::size_t index = 0; index < job.cuts.size(); ++index) result["cuts"].push_back(cut(job, fit, misfit, index));
  result["start"] = free_start(job, calibration);
  result["start_origin"] = calibration.start_origin;
  result["trace"] = trace(job, calibration.trace);
  return result;
}

}  // namespace kerf::inverse
