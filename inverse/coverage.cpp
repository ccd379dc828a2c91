#include "inverse/coverage.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <map>
#include <random>

namespace kerf::inverse {

Interval binomial_interval(int held, int trials) {
  using Binomial = boost::math::binomial_distribution<double>;
  return {Binomial::find_lower_bound_on_p(trials, held, 0.025), Binomial::find_upper_bound_on_p(trials, held, 0.025)};
}

Job synthetic_experiment(const Job& job, const LocalModel& model, double edge_force, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const ParameterSpace space(job);
  const Misfit misfit(job, space);
  const double friction = space.friction(model.base().point);
  std::map<std::pair<std::string, std::size_t>, double> shared;  // by specimen and kind of measurement, as in Misfit
  Job twin = job;
  for (std::size_t i = 0; i < twin.cuts.size(); ++i)
    for (std::size_t k = 0; k < observable_count; ++k) {
      std::optional<Estimate>& measured = twin.cuts[i].measured[k];
      if (!measured) continue;
      const double error = std::hypot(measured->standard_error, job.discrepancy * measured->value);
      const double truth = model.base().simulated(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) +
                           edge_force * misfit.edge_share(static_cast<Observable>(k), friction);
      const double own = normal(random);
      const auto [place, fresh] = shared.emplace(std::pair(twin.cuts[i].specimen, std::max<std::size_t>(k, 1)), 0);
      if (fresh) place->second = normal(random);
      measured->value = truth + error * own + twin.cuts[i].specimen_error * truth * place->second;
    }
  return twin;
}

std::vector<CoverageRow> coverage(const Job& job, const LocalModel& model, double edge_force, int trials,
                                  std::uint64_t seed) {
  const ParameterSpace space(job);
  const Eigen::VectorXd values = space.values(model.base().point);
  std::vector<CoverageRow> rows;
  const auto add = [&](const std::string& name, const std::string& unit, double truth) {
    rows.push_back({.name = name, .unit = unit, .truth = truth, .share = {}});
  };
  for (Eigen::Index j = 0; j < space.dimension(); ++j)
    add(job.free[static_cast<std::size_t>(j)].name, job.free[static_cast<std::size_t>(j)].unit, values[j]);
  if (job.edge_force) add("edge_force", "N/mm", edge_force);
  for (const DerivedQuantity& q : job.derived)
    add(q.name, q.unit, q.of(std::vector<double>(values.begin(), values.end())));

  for (int trial = 0; trial < trials; ++trial) {
    const Job twin = synthetic_experiment(job, model, edge_force, seed + static_cast<std::uint64_t>(trial));
    Misfit misfit(twin, space);
    misfit.include_simulation_errors(model.base());
    const ModelMinimum found = minimise(model, misfit, space, model.base().point, space.lower(), space.upper());
    const Identifiability known = identify(model, misfit, space, twin.derived, found.point);
    for (CoverageRow& row : rows) {
      const Interval& interval = known.find(row.name)->interval;
      ++row.trials;
      row.held += interval.lower <= row.truth && row.truth <= interval.upper ? 1 : 0;
    }
  }
  for (CoverageRow& row : rows) row.share = binomial_interval(row.held, row.trials);
  return rows;
}

}  // namespace kerf::inverse
