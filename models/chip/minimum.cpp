#include "models/chip/minimum.hpp"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace kerf::chip {

double chi2_at(const LeastSquares& problem, const std::vector<double>& values) {
  Eigen::VectorXd residuals(problem.residuals->num_residuals());
  const double* block = values.data();
  if (!problem.residuals->Evaluate(&block, residuals.data(), nullptr) || !residuals.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  return residuals.squaredNorm();
}

Linearised linearise(const LeastSquares& problem, const std::vector<double>& values) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Linearised result{Eigen::VectorXd(problem.residuals->num_residuals()), {}};
  RowMajor jacobian(result.residuals.size(), static_cast<Eigen::Index>(values.size()));
  const double* block = values.data();
  double* rows = jacobian.data();
  if (!problem.residuals->Evaluate(&block, result.residuals.data(), &rows)) {
    jacobian.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  result.jacobian = jacobian;
  return result;
}

Minimum minimise(const LeastSquares& problem, std::vector<double> start, std::optional<int> held) {
  const int size = static_cast<int>(start.size());
  for (int i = 0; i < size; ++i) {
    const auto& unknown = problem.unknowns[static_cast<std::size_t>(i)];
    auto& value = start[static_cast<std::size_t>(i)];
    value = std::clamp(value, unknown.lower, unknown.upper);
  }
  Minimum minimum{start, chi2_at(problem, start), true};
  if (!std::isfinite(minimum.chi2) || (held && size == 1)) return minimum;

  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem ceres_problem(ownership);
  // Ceres asks for a mutable pointer, but only evaluates.
  ceres_problem.AddResidualBlock(const_cast<ceres::CostFunction*>(problem.residuals.get()), nullptr,
                                 minimum.values.data());
  if (held) ceres_problem.SetManifold(minimum.values.data(), new ceres::SubsetManifold(size, {*held}));
  for (int i = 0; i < size; ++i) {
    const auto& unknown = problem.unknowns[static_cast<std::size_t>(i)];
    if (std::isfinite(unknown.lower)) ceres_problem.SetParameterLowerBound(minimum.values.data(), i, unknown.lower);
    if (std::isfinite(unknown.upper)) ceres_problem.SetParameterUpperBound(minimum.values.data(), i, unknown.upper);
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.max_num_consecutive_invalid_steps = 60;  // a search may have to back out of where Eq. (4) has no root
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-15;
  options.parameter_tolerance = 1e-13;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  minimum.chi2 = chi2_at(problem, minimum.values);
  minimum.converged = summary.IsSolutionUsable();
  return minimum;
}

Minimum polish(const LeastSquares& problem, const Minimum& minimum) {
  const auto [residuals, jacobian] = linearise(problem, minimum.values);
  const Eigen::VectorXd step = -covariance(jacobian).matrix * (jacobian.transpose() * residuals);
  if (!step.allFinite()) return minimum;
  Minimum polished = minimum;
  for (std::size_t i = 0; i < polished.values.size(); ++i) {
    polished.values[i] += step[static_cast<Eigen::Index>(i)];
    if (polished.values[i] < problem.unknowns[i].lower || polished.values[i] > problem.unknowns[i].upper) {
      return minimum;
    }
  }
  polished.chi2 = chi2_at(problem, polished.values);
  constexpr double rounding = 1e-13;
  return polished.chi2 <= minimum.chi2 * (1.0 + rounding) ? polished : minimum;
}

Covariance covariance(const Eigen::MatrixXd& jacobian) {
  constexpr double unseen = 1e-9;
  const auto size = jacobian.cols();
  Covariance result{Eigen::MatrixXd::Constant(size, size, std::numeric_limits<double>::quiet_NaN()), {}};
  if (!jacobian.allFinite()) return result;

  Eigen::VectorXd scale = jacobian.colwise().norm();
  for (auto& length : scale) length = length > 0.0 ? length : 1.0;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian * scale.cwiseInverse().asDiagonal(), Eigen::ComputeFullV);
  Eigen::VectorXd singular = Eigen::VectorXd::Zero(size);  // fewer rows than columns leave the rest at zero
  singular.head(svd.singularValues().size()) = svd.singularValues();
  result.singular_values.assign(singular.begin(), singular.end());

  result.matrix.setZero();
  std::vector<bool> undetermined(static_cast<std::size_t>(size), false);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::VectorXd direction = svd.matrixV().col(i);
    if (singular[i] > unseen) {
      result.matrix += direction * direction.transpose() / (singular[i] * singular[i]);
      continue;
    }
    for (Eigen::Index j = 0; j < size; ++j) {
      if (std::abs(direction[j]) > 1e-6) undetermined[static_cast<std::size_t>(j)] = true;
    }
  }
  result.matrix = scale.cwiseInverse().asDiagonal() * result.matrix * scale.cwiseInverse().asDiagonal();
  for (Eigen::Index j = 0; j < size; ++j) {
    if (!undetermined[static_cast<std::size_t>(j)]) continue;
    result.matrix.row(j).setConstant(std::numeric_limits<double>::quiet_NaN());
    result.matrix.col(j).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

}  // namespace kerf::chip
