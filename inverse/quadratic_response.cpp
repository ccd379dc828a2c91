#include "inverse/quadratic_response.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace kerf::inverse {
namespace {

constexpr double rounding = 1e-6;  // roughness of what is called smooth

}  // namespace

QuadraticResponse::QuadraticResponse(const Eigen::MatrixXd& steps, double roughness) : parameters_(steps.cols()) {
  const Eigen::Index n = parameters_, runs = steps.rows(), terms = n + n * (n + 1) / 2;
  Eigen::MatrixXd design(runs, terms);
  design.leftCols(n) = steps;
  Eigen::Index term = n;
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b <= a; ++b)
      design.col(term++) = steps.col(a).cwiseProduct(steps.col(b)) * (a == b ? 0.5 : 1.0);
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(terms, usual_curvature * usual_curvature);
  prior.head(n).setConstant(any_slope * any_slope);

  const double rough = std::pow(std::max(roughness, rounding), 2);
  const Eigen::MatrixXd roughnesses =
      rough * (Eigen::MatrixXd::Identity(runs, runs) + Eigen::MatrixXd::Ones(runs, runs));
  Eigen::MatrixXd covariance = design * prior.asDiagonal() * design.transpose() + roughnesses;
  const double third = usual_third_order / 6;
  covariance.array() += third * third * (steps * steps.transpose()).array().cube();
  precision_ = covariance;
  if (runs > 0) precision_ = covariance.ldlt().solve(Eigen::MatrixXd::Identity(runs, runs));
  mean_ = prior.asDiagonal() * design.transpose() * precision_;

  const Eigen::MatrixXd of_slopes = mean_.topRows(n);
  const Eigen::VectorXd explained = (of_slopes * steps).diagonal().cwiseProduct(prior.head(n));
  slope_errors_ = (prior.head(n) - explained).cwiseMax(0).cwiseSqrt();
  rough_covariance_ = Eigen::MatrixXd::Zero(n, n);
  if (roughness > 0) rough_covariance_ = of_slopes * roughnesses * of_slopes.transpose();
}

double QuadraticResponse::surprise(const Eigen::VectorXd& changes) const {
  const auto beyond_slopes = static_cast<double>(changes.size() - parameters_);
  if (beyond_slopes <= 0) return 1;
  return std::sqrt(std::max(1.0, changes.dot(precision_ * changes) / beyond_slopes));
}

Eigen::VectorXd QuadraticResponse::slopes(const Eigen::VectorXd& changes) const {
  return mean_.topRows(parameters_) * changes;
}

Eigen::MatrixXd QuadraticResponse::curvatures(const Eigen::VectorXd& changes) const {
  const Eigen::VectorXd terms = mean_.bottomRows(mean_.rows() - parameters_) * changes;
  Eigen::MatrixXd result(parameters_, parameters_);
  Eigen::Index term = 0;
  for (Eigen::Index a = 0; a < parameters_; ++a)
    for (Eigen::Index b = 0; b <= a; ++b) result(a, b) = result(b, a) = terms[term++];
  return result;
}

}  // namespace kerf::inverse
