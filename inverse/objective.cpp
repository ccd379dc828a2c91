#include "inverse/objective.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "forward/scene/scene.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {

Objective::Objective(const Job& job, const ParameterSpace& space, Misfit& misfit, RunDatabase& database,
                     std::size_t max_runs)
    : job_(job), space_(space), misfit_(misfit), database_(database), max_runs_(max_runs), choice_(job.optimiser) {}

RunRequest Objective::request(const Probe& probe) const {
  const auto& [point, cut, jitter] = probe;
  const bool specimen = job_.cuts[cut].extension.has_value();
  std::string label = fidelity + (specimen ? "specimen" : fmt::format("depth {:.4g} mm", job_.cuts[cut].depth));
  for (Eigen::Index j = 0; j < space_.dimension(); ++j) {
    const FreeParameter& parameter = space_.parameters()[static_cast<std::size_t>(j)];
    label +=
        fmt::format(", {} {:.4g}{}{}", parameter.name, space_.value(j, point[j]) / consistent_units_in(parameter.unit),
                    parameter.unit == "1" ? "" : " ", parameter.unit == "1" ? "" : parameter.unit);
  }
  Document scene = space_.scene(point, job_.cuts[cut]);
  if (jitter != 0) {
    const double notch = scene.read(forward::scene_blocks()).at("cut").number("notch");
    scene.set_number("cut.notch", notch + jitter, forward::scene_blocks());
    label += fmt::format(", begun {:.3f} depths farther on", jitter);
  }
  return {.scene = std::move(scene), .label = std::move(label), .cut = cut};
}

std::vector<RunRecord> Objective::simulate(const std::vector<Probe>& probes) {
  std::vector<RunRequest> requests;
  requests.reserve(probes.size());
  for (const Probe& probe : probes) requests.push_back(request(probe));
  std::vector<RunRecord> records;
  if (closed_form) {
    for (const RunRequest& request : requests) records.push_back(closed_form(request.scene));
  } else {
    if (database_.runs_with(requests) > max_runs_) throw BudgetSpent{};
    records = database_.run(requests);
  }
  if (correct)
    for (std::size_t p = 0; p < probes.size(); ++p) correct(probes[p], records[p]);
  return records;
}

std::vector<Evaluation> Objective::evaluate(const std::vector<Eigen::VectorXd>& points) {
  std::vector<Probe> probes;
  for (const Eigen::VectorXd& point : points)
    for (std::size_t cut = 0; cut < cuts(); ++cut) probes.push_back({point, cut});
  const std::vector<RunRecord> records = simulate(probes);
  std::vector<Evaluation> evaluations;
  for (std::size_t p = 0; p < points.size(); ++p) {
    Evaluation evaluation;
    evaluation.point = points[p];
    evaluation.simulated.resize(static_cast<Eigen::Index>(cuts()), Eigen::NoChange);
    for (std::size_t cut = 0; cut < cuts(); ++cut) {
      evaluation.runs.push_back(records[p * cuts() + cut]);
      evaluation.usable.push_back(misfit_.is_usable(cut, evaluation.runs.back()));
      evaluation.simulated.row(static_cast<Eigen::Index>(cut)) = misfit_.observations(cut, evaluation.runs.back());
    }
    evaluations.push_back(std::move(evaluation));
  }
  return evaluations;
}

double Objective::worthwhile(const Evaluation& evaluation) const {
  return std::max(job_.budget.tolerance, misfit_.chi2_noise(evaluation, choice_.noise, choice_.noise_measured));
}

void Objective::trace(std::string what, const Evaluation& at) {
  const Residuals residuals = misfit_.residuals(at);
  const auto better = [&](const Evaluation& before) {
    const std::size_t then = count(before.usable), now = count(at.usable);
    return now > then || (now == then && residuals.chi2 < misfit_.residuals(before).chi2);
  };
  if (!best_ || better(*best_)) best_ = at;
  trace_.push_back({.what = std::move(what),
                    .runs = database_.runs(),
                    .core_seconds = database_.core_seconds(),
                    .chi2 = residuals.chi2,
                    .point = at.point,
                    .edge_force = residuals.edge_force,
                    .failed_cuts = cuts() - count(at.usable)});
  if (on_trace) on_trace(trace_.back());
}

void Objective::pass_on(const std::string& prefix, TraceEntry entry) {
  entry.what = prefix + entry.what;
  trace_.push_back(std::move(entry));
  if (on_trace) on_trace(trace_.back());
}

double Objective::failing_share(const Evaluation& evaluation) const {
  return 1.0 - static_cast<double>(count(evaluation.usable)) / static_cast<double>(cuts());
}

}  // namespace kerf::inverse
