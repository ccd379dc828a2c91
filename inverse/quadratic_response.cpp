#include "inverse/quadratic_response.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace kerf::inverse {
namespace {

constexpr double usual_third_order = 0.4;  // of a logarithm, per cube of a search coordinate
constexpr double rounding = 1e-6;          // roughness of what is called smooth

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
  for (Eigen::Index i = 0; i < runs; ++i)
    covariance(i, i) += std::pow(usual_third_order * std::pow(steps.row(i).norm(), 3) / 6, 2);
  mean_ = Eigen::MatrixXd::Zero(terms, runs);
  if (runs > 0) mean_ = covariance.ldlt().solve(design * prior.asDiagonal()).transpose();

  const Eigen::MatrixXd of_slopes = mean_.topRows(n);
  const Eigen::VectorXd explained = (of_slopes * steps).diagonal().cwiseProduct(prior.head(n));
  slope_errors_ = (prior.head(n) - explained).cwiseMax(0).cwiseSqrt();
  rough_errors_ = roughness > 0
                      ? Eigen::VectorXd((of_slopes * roughnesses * of_slopes.transpose()).diagonal().cwiseSqrt())
                      : Eigen::VectorXd::Zero(n);
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
