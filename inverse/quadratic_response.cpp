#include "inverse/quadratic_response.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace kerf::inverse {
namespace {

constexpr double rounding = 1e-5;  // roughness of what is called smooth

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

  const double rough = std::pow(std::max(roughness, rounding), 2), third = usual_third_order / 6;
  const Eigen::MatrixXd roughnesses =
      rough * (Eigen::MatrixXd::Identity(runs, runs) + Eigen::MatrixXd::Ones(runs, runs));
  Eigen::MatrixXd errors = roughnesses;
  errors.array() += third * third * (steps * steps.transpose()).array().cube();

  // Information adds up without the cancellation that a difference of covariances would suffer.
  weights_ = errors;
  if (runs > 0) weights_ = errors.ldlt().solve(Eigen::MatrixXd::Identity(runs, runs));
  information_of_priors_ = prior.cwiseInverse();
  Eigen::MatrixXd information = design.transpose() * weights_ * design;
  information.diagonal() += information_of_priors_;
  const Eigen::MatrixXd covariance = information.ldlt().solve(Eigen::MatrixXd::Identity(terms, terms));
  mean_ = covariance * design.transpose() * weights_;
  slope_errors_ = covariance.diagonal().head(n).cwiseMax(0).cwiseSqrt();
  const Eigen::MatrixXd of_slopes = mean_.topRows(n);
  rough_covariance_ = Eigen::MatrixXd::Zero(n, n);
  if (roughness > 0) rough_covariance_ = of_slopes * roughnesses * of_slopes.transpose();
  design_ = std::move(design);
}

double QuadraticResponse::surprise(const Eigen::VectorXd& changes) const {
  const auto beyond_slopes = static_cast<double>(changes.size() - parameters_);
  if (beyond_slopes <= 0) return 1;
  const Eigen::VectorXd terms = mean_ * changes, left = changes - design_ * terms;
  const double unlikely = left.dot(weights_ * left) + terms.cwiseAbs2().dot(information_of_priors_);
  return std::sqrt(std::max(1.0, unlikely / beyond_slopes));
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
