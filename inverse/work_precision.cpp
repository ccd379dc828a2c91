#include "inverse/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace kerf::inverse {
namespace {

double cost_of(const RunRecord& record, const char* key) {
  const nlohmann::ordered_json::json_pointer place(std::string("/cost/") + key);
  return record.result.contains(place) && record.result.at(place).is_number() ? record.result.at(place).get<double>()
                                                                              : 0.0;
}

Estimate difference(const Estimate& force, const Estimate& reference, double unit) {
  return {(force.value - reference.value) / unit, std::hypot(force.standard_error, reference.standard_error) / unit};
}

void mark_front(const std::vector<std::size_t>& judged, const std::vector<CostAndError>& points,
                std::vector<std::optional<WorkPrecision>>& all) {
  const std::vector<bool> front = pareto_front(points);
  for (std::size_t i = 0; i < judged.size(); ++i) all[judged[i]]->front = front[i];
}

}  // namespace

Estimate WorkPrecision::error() const {
  const auto size = [](const Estimate& e) {
    return Estimate{std::max(std::abs(e.value), e.standard_error), e.standard_error};
  };
  if (result) return size(*result);
  const Estimate c = size(F_c), t = size(F_t);
  return c.value >= t.value ? c : t;
}

std::vector<std::optional<WorkPrecision>> work_precision(const std::vector<std::optional<RunRecord>>& records,
                                                         std::size_t reference) {
  std::vector<std::optional<WorkPrecision>> all(records.size());
  const std::optional<RunRecord>& best = records.at(reference);
  if (!best || !best->accepted) return all;
  std::vector<std::size_t> judged;
  std::vector<CostAndError> points;
  for (std::size_t run = 0; run < records.size(); ++run) {
    if (run == reference || !records[run] || !records[run]->accepted) continue;
    const RunRecord& record = *records[run];
    const double unit = std::abs(best->F_c.value);
    const WorkPrecision precision{.F_c = difference(record.F_c, best->F_c, unit),
                                  .F_t = difference(record.F_t, best->F_t, unit),
                                  .result = {},
                                  .core_seconds = cost_of(record, "processor_s"),
                                  .particle_steps = cost_of(record, "particle_steps")};
    if (!std::isfinite(precision.error().value)) continue;
    all[run] = precision;
    judged.push_back(run);
    points.push_back({precision.core_seconds, precision.error().value});
  }
  mark_front(judged, points, all);
  return all;
}

bool is_off_closed_form(const std::string& name) {
  return name.ends_with("_error");
}

std::vector<std::optional<WorkPrecision>> work_precision(const std::vector<std::optional<RunRecord>>& records,
                                                         std::size_t reference, const std::string& name) {
  std::vector<std::optional<WorkPrecision>> all(records.size());
  const std::optional<RunRecord>& best = records.at(reference);
  const bool closed_form = is_off_closed_form(name);
  if (!closed_form && !(best && best->accepted)) return all;
  std::vector<std::size_t> judged;
  std::vector<CostAndError> points;
  for (std::size_t run = 0; run < records.size(); ++run) {
    if (!records[run] || !records[run]->accepted || (run == reference && !closed_form)) continue;
    const double found = found_in(*records[run], name), exact = closed_form ? 0.0 : found_in(*best, name);
    const WorkPrecision precision{.F_c = {},
                                  .F_t = {},
                                  .result = Estimate{(found - exact) / (closed_form ? 1.0 : std::abs(exact)), 0.0},
                                  .core_seconds = cost_of(*records[run], "processor_s"),
                                  .particle_steps = cost_of(*records[run], "particle_steps")};
    if (!std::isfinite(precision.error().value)) continue;
    all[run] = precision;
    judged.push_back(run);
    points.push_back({precision.core_seconds, precision.error().value});
  }
  mark_front(judged, points, all);
  return all;
}

std::vector<bool> pareto_front(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].cost, points[a].error) < std::pair(points[b].cost, points[b].error);
  });
  // From the cheapest on: a point stands on the front if it is nearer than all cheaper ones; equals stand together.
  std::vector<bool> front(points.size(), false);
  CostAndError last{-1, std::numeric_limits<double>::infinity()};
  for (const std::size_t i : order) {
    const bool equal = points[i].cost == last.cost && points[i].error == last.error;
    if (!equal && !(points[i].error < last.error)) continue;
    front[i] = true;
    last = points[i];
  }
  return front;
}

}  // namespace kerf::inverse
