#include "inverse/error_propagation.hpp"

#include <cmath>

namespace kerf::inverse {

std::vector<std::optional<VarianceShares>> error_budget(const Identifiability& known, const Misfit& misfit,
                                                        const CutMask& mask) {
  const double scale2 = known.error_scale * known.error_scale;
  const Eigen::MatrixXd response = known.covariance / scale2 * known.jacobian.transpose();  // G by ln(parameter)
  std::array<Eigen::MatrixXd, error_source_count> errors;
  for (std::size_t s = 0; s < error_source_count; ++s)
    errors[s] = response * misfit.whitened_errors(static_cast<ErrorSource>(s), mask);
  std::vector<std::optional<VarianceShares>> budget;
  for (const std::vector<ParameterEstimate>* all : {&known.parameters, &known.derived})
    for (const ParameterEstimate& estimate : *all) {
      const double variance = estimate.standard_error * estimate.standard_error;
      if (!std::isfinite(variance) || variance == 0) {
        budget.emplace_back();
        continue;
      }
      VarianceShares shares;
      for (std::size_t s = 0; s < error_source_count; ++s)
        shares.source[s] = (estimate.slope.transpose() * errors[s]).squaredNorm() / variance;
      shares.unexplained = 1 - 1 / scale2;
      budget.emplace_back(shares);
    }
  return budget;
}

Observations fitted_errors(const Identifiability& known, const LocalModel& model, const Misfit& misfit,
                           const ParameterSpace& space) {
  constexpr double tiny = 1e-5;
  const Eigen::VectorXd& point = model.base().point;
  const double edge_force = misfit.residuals(model.base().simulated, point, model.known()).edge_force;
  std::vector<Observations> columns;  // d fitted / d ln(parameter)
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    Eigen::VectorXd above = point, below = point;
    above[j] += tiny;
    below[j] -= tiny;
    const double unit = known.parameters[static_cast<std::size_t>(j)].slope[j] / space.slope(j, point[j]);
    columns.emplace_back((misfit.fitted(model.predict(above), above, edge_force) -
                          misfit.fitted(model.predict(below), below, edge_force)) *
                         (unit / (2 * tiny)));
  }
  if (misfit.edge_force()) {
    const Observations& simulated = model.base().simulated;
    columns.emplace_back(
        (misfit.fitted(simulated, point, edge_force + 1) - misfit.fitted(simulated, point, edge_force)) *
        known.parameters.back().slope[point.size()]);
  }
  Observations variance = Observations::Zero(model.base().simulated.rows(), model.base().simulated.cols());
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = 0; b < columns.size(); ++b)
      variance += known.covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) *
                  columns[a].cwiseProduct(columns[b]);
  return variance.cwiseMax(0).cwiseSqrt();
}

}  // namespace kerf::inverse
