#include "inverse/quadratic_response.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace kerf::inverse {
namespace {

constexpr double rounding = 1e-5;  // roughness of what is called smooth

/// Of a matrix with no eigenvalue below `least`.
double log_determinant(const Eigen::LDLT<Eigen::MatrixXd>& factors, double least) {
  return factors.vectorD().array().max(least).log().sum();
}

/// Covariance of the changes of a rippled quantity of unit variance.
Eigen::MatrixXd ripples(const Eigen::MatrixXd& steps) {
  const auto alike = [](double square) {
    return std::exp(-0.5 * square / std::pow(QuadraticResponse::ripple_length, 2));
  };
  const Eigen::Index runs = steps.rows();
  Eigen::MatrixXd result(runs, runs);
  for (Eigen::Index a = 0; a < runs; ++a)
    for (Eigen::Index b = 0; b < runs; ++b)
      result(a, b) = alike((steps.row(a) - steps.row(b)).squaredNorm()) - alike(steps.row(a).squaredNorm()) -
                     alike(steps.row(b).squaredNorm()) + 1;
  return result;
}

}  // namespace

QuadraticResponse::QuadraticResponse(const Eigen::MatrixXd& steps, const Texture& texture) : parameters_(steps.cols()) {
  const Eigen::Index n = parameters_, runs = steps.rows(), terms = n + n * (n + 1) / 2;
  Eigen::MatrixXd design(runs, terms);
  design.leftCols(n) = steps;
  Eigen::Index term = n;
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b <= a; ++b)
      design.col(term++) = steps.col(a).cwiseProduct(steps.col(b)) * (a == b ? 0.5 : 1.0);
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(terms, std::pow(texture.bend * usual_curvature, 2));
  prior.head(n).setConstant(any_slope * any_slope);

  const double rough = std::pow(std::max(texture.roughness, rounding), 2), third = texture.bend * usual_third_order / 6;
  Eigen::MatrixXd irregular = rough * (Eigen::MatrixXd::Identity(runs, runs) + Eigen::MatrixXd::Ones(runs, runs));
  if (texture.ripple > 0) irregular += std::pow(texture.ripple, 2) * ripples(steps);
  Eigen::MatrixXd errors = irregular;
  errors.array() += third * third * (steps * steps.transpose()).array().cube();

  // Information adds up without the cancellation that a difference of covariances would suffer.
  weights_ = errors;
  if (runs > 0) {
    const Eigen::LDLT<Eigen::MatrixXd> factors(errors);
    weights_ = factors.solve(Eigen::MatrixXd::Identity(runs, runs));
    log_volume_ += log_determinant(factors, rough);
  }
  information_of_priors_ = prior.cwiseInverse();
  Eigen::MatrixXd information = design.transpose() * weights_ * design;
  information.diagonal() += information_of_priors_;
  const Eigen::LDLT<Eigen::MatrixXd> factors(information);
  const Eigen::MatrixXd covariance = factors.solve(Eigen::MatrixXd::Identity(terms, terms));
  log_volume_ += log_determinant(factors, information_of_priors_.minCoeff()) + prior.array().log().sum();
  mean_ = covariance * design.transpose() * weights_;
  slope_errors_ = covariance.diagonal().head(n).cwiseMax(0).cwiseSqrt();
  const Eigen::MatrixXd of_slopes = mean_.topRows(n);
  rough_covariance_ = Eigen::MatrixXd::Zero(n, n);
  if (texture.roughness > 0 || texture.ripple > 0) rough_covariance_ = of_slopes * irregular * of_slopes.transpose();
  design_ = std::move(design);
}

double QuadraticResponse::unlikeliness(const Eigen::VectorXd& changes) const {
  const Eigen::VectorXd terms = mean_ * changes, left = changes - design_ * terms;
  return left.dot(weights_ * left) + terms.cwiseAbs2().dot(information_of_priors_) + log_volume_;
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

namespace {

// How readily textures leave what was said: standard deviations of the logarithms of roughness and bend.
constexpr std::array<double, 2> trust{1.5, 0.7};
constexpr double good_reason = 4;  // by which -2 ln of the density must fall, as a normal error of two does

using Doublings = std::array<int, 2>;  // of roughness and bend

Texture doubled(const Texture& said, const Doublings& more) {
  Texture result = said;
  if (more[0] > 0) result.roughness = std::ldexp(std::max(said.roughness, rounding), more[0]);
  result.bend = std::ldexp(said.bend, more[1]);
  return result;
}

double reluctance(const Doublings& more) {
  double sum = 0;
  for (std::size_t i = 0; i < more.size(); ++i) sum += std::pow(std::log(2.0) * more[i] / trust[i], 2);
  return sum;
}

/// The doublings, the same for all samples, that make them likeliest.
Doublings likeliest_doublings(std::span<const ResponseSample> samples) {
  std::vector<const ResponseSample*> telling;  // more than their slopes explain
  for (const ResponseSample& sample : samples)
    if (sample.steps.rows() > sample.steps.cols()) telling.push_back(&sample);
  if (telling.empty()) return {0, 0};
  const auto unlikeliness = [&](const Doublings& more) {
    double sum = reluctance(more);
    for (const ResponseSample* sample : telling)
      sum += QuadraticResponse(sample->steps, doubled(sample->said, more)).unlikeliness(sample->changes);
    return sum;
  };
  const double as_said = unlikeliness({0, 0});
  Doublings best{0, 0};
  double lowest = as_said - good_reason;
  // Downhill by single doublings, or over a ridge; from what was said, and from much rougher and more bent.
  constexpr std::array<Doublings, 7> moves{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {3, 0}, {1, -1}, {-1, 1}}};
  for (const Doublings start : {Doublings{0, 0}, Doublings{5, 3}}) {
    Doublings here = start;
    double height = unlikeliness(here);
    for (bool falling = true; falling;) {
      falling = false;
      const Doublings from = here;
      for (const Doublings& move : moves) {
        const Doublings to{from[0] + move[0], from[1] + move[1]};
        if (to[0] < 0 || to[1] < 0) continue;
        const double found = unlikeliness(to);
        if (!(found < height - 1e-9)) continue;
        height = found;
        here = to;
        falling = true;
      }
    }
    if (height >= lowest) continue;
    lowest = height;
    best = here;
  }
  return best;
}

}  // namespace

std::vector<Texture> likeliest_textures(const std::vector<ResponseSample>& samples) {
  const Doublings together = likeliest_doublings(samples);
  std::vector<Texture> textures;
  for (ResponseSample sample : samples) {
    sample.said = doubled(sample.said, together);
    textures.push_back(doubled(sample.said, likeliest_doublings({&sample, 1})));
  }
  return textures;
}

}  // namespace kerf::inverse
