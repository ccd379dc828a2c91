#include "inverse/next_cut.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

/// Median relative error of an observable in the job; F_t, which may vanish, over F_c. What was never measured is
/// taken to be as good as a force gauge (2 %) or a chip under a microscope (5 %).
double typical_error(const Job& job, std::size_t k) {
  const bool transverse = k == static_cast<std::size_t>(Observable::F_t);
  std::vector<double> relative;
  for (const MeasuredCut& cut : job.cuts) {
    const auto& base = transverse && cut.measured[0] ? cut.measured[0] : cut.measured[k];
    if (cut.measured[k] && base && base->value != 0)
      relative.push_back(std::hypot(cut.measured[k]->standard_error, job.discrepancy * cut.measured[k]->value) /
                         std::abs(base->value));
  }
  if (relative.empty()) return k <= static_cast<std::size_t>(Observable::F_t) ? 0.02 : 0.05;
  std::nth_element(relative.begin(), relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2),
                   relative.end());
  return relative[relative.size() / 2];
}

}  // namespace

std::vector<MeasuredCut> candidate_cuts(const Job& job) {
  constexpr int depths = 7;
  const double step = 10 * consistent_units_in("deg");
  double shallowest = std::numeric_limits<double>::infinity(), deepest = 0;
  std::set<double> rakes;
  for (const MeasuredCut& cut : job.cuts) {
    if (cut.extension) continue;
    shallowest = std::min(shallowest, cut.depth);
    deepest = std::max(deepest, cut.depth);
    rakes.insert(cut.rake);
  }
  if (rakes.empty())
    throw InputError(job.title + ": this job has no cuts, only R-curves; there is no next cut to them");
  rakes.insert({*rakes.begin() - step, *rakes.rbegin() + step});
  std::vector<MeasuredCut> cuts;
  for (const double rake : rakes)
    for (int i = 0; i < depths; ++i) {
      const double factor = std::pow(4 * deepest / shallowest, i / (depths - 1.0));
      cuts.push_back({.depth = 0.5 * shallowest * factor, .rake = rake, .specimen = "next", .measured = {}});
    }
  return cuts;
}

Job with_cuts(const Job& job, std::vector<MeasuredCut> cuts) {
  Job other = job;
  other.cuts = std::move(cuts);
  for (MeasuredCut& cut : other.cuts)
    for (std::size_t k = 0; k < observable_count; ++k)  // weighed once they are predicted
      if (static_cast<Observable>(k) != Observable::resistance) cut.measured[k] = Estimate{1, 1};
  return other;
}

std::vector<NextCut> next_cuts(const Job& job, const LocalModel& model, const Misfit& misfit, const Job& candidate_job,
                               const LocalModel& candidates, const std::string& name) {
  const ParameterSpace space(job);
  const Eigen::VectorXd& point = model.base().point;
  const double edge = misfit.residuals(model.base().simulated, point, model.known()).edge_force;
  const Eigen::Index n = space.dimension(), all = n + (job.edge_force ? 1 : 0);
  std::vector<std::string> names;
  for (const FreeParameter& p : job.free) names.push_back(p.name);
  if (job.edge_force) names.emplace_back("edge_force");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw InputError(fmt::format("\"{}\" is no parameter of this job; there are {}", name, fmt::join(names, ", ")),
                     ExitCode::usage);
  const auto chosen = static_cast<Eigen::Index>(found - names.begin());

  // Coordinates, then F_b: what the data say, and the bounds as uniform distributions.
  Eigen::MatrixXd before = Eigen::MatrixXd::Zero(all, all);
  for (Eigen::Index j = 0; j < n; ++j) before(j, j) = 12 / std::pow(space.upper()[j] - space.lower()[j], 2);
  if (all > n && std::isfinite(job.edge_force->upper - job.edge_force->lower))
    before(n, n) = 12 / std::pow(job.edge_force->upper - job.edge_force->lower, 2);
  const Eigen::MatrixXd measured = residual_slopes(model, misfit, point, edge);
  before += measured.transpose() * measured;
  const double error_before = std::sqrt(before.inverse()(chosen, chosen));

  Job weighed = candidate_job;
  for (std::size_t i = 0; i < weighed.cuts.size(); ++i)
    for (std::size_t k = 0; k < observable_count; ++k) {
      const Observations& simulated = candidates.base().simulated;
      const auto row = static_cast<Eigen::Index>(i);
      const double value = simulated(row, static_cast<Eigen::Index>(k));
      const double base = k == static_cast<std::size_t>(Observable::F_t) ? simulated(row, 0) : value;
      const double error = typical_error(job, k) * std::abs(base);
      if (std::isfinite(value) && error > 0)
        weighed.cuts[i].measured[k] = Estimate{value, error};
      else
        weighed.cuts[i].measured[k].reset();
      weighed.cuts[i].specimen_error = 0;
    }
  weighed.discrepancy = 0;  // it is part of the typical error
  const Misfit expected(weighed, space);
  const Eigen::MatrixXd slopes = residual_slopes(candidates, expected, point, edge);
  std::vector<NextCut> cuts;
  const CutMask known = candidates.known();
  for (std::size_t i = 0; i < weighed.cuts.size(); ++i)
    for (std::size_t k = 0; k < observable_count && known[i]; ++k) {
      const auto& value = weighed.cuts[i].measured[k];
      if (!value) continue;
      const Eigen::VectorXd row = slopes.row(static_cast<Eigen::Index>(i * observable_count + k));
      const Eigen::MatrixXd after = before + row * row.transpose();
      cuts.push_back({.depth = weighed.cuts[i].depth,
                      .rake = weighed.cuts[i].rake,
                      .observable = static_cast<Observable>(k),
                      .expected = value->value,
                      .measurement_error = value->standard_error,
                      .standard_error_ratio = std::sqrt(after.inverse()(chosen, chosen)) / error_before});
    }
  std::stable_sort(cuts.begin(), cuts.end(),
                   [](const NextCut& a, const NextCut& b) { return a.standard_error_ratio < b.standard_error_ratio; });
  return cuts;
}

}  // namespace kerf::inverse
