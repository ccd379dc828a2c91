// Slopes and curvatures from scattered rough values: against an exact quadratic, and against the errors they claim.

#include "inverse/quadratic_response.hpp"

#include <gtest/gtest.h>

#include <random>

namespace kerf {
namespace {

using inverse::QuadraticResponse;

const Eigen::Vector3d slopes(0.8, -0.2, 0.3);

Eigen::Matrix3d curvatures() {
  Eigen::Matrix3d h;
  h << 0.2, -0.1, 0.3, -0.1, 0.4, 0.0, 0.3, 0.0, -0.3;
  return h;
}

double change(const Eigen::Vector3d& step) {
  return slopes.dot(step) + 0.5 * step.dot(curvatures() * step);
}

Eigen::MatrixXd scattered(Eigen::Index runs, double reach, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  return Eigen::MatrixXd::NullaryExpr(runs, 3, [&] { return uniform(random); });
}

Eigen::VectorXd changes(const Eigen::MatrixXd& steps) {
  Eigen::VectorXd result(steps.rows());
  for (Eigen::Index i = 0; i < steps.rows(); ++i) result[i] = change(steps.row(i).transpose());
  return result;
}

TEST(QuadraticResponse, FindsAQuadraticOnceItHasAsManyRunsAsTerms) {
  const Eigen::MatrixXd steps = scattered(14, 0.1, 1);
  const QuadraticResponse response(steps, 0);
  EXPECT_LT((response.slopes(changes(steps)) - slopes).norm(), 1e-3);
  EXPECT_LT((response.curvatures(changes(steps)) - curvatures()).norm(), 0.03);
}

TEST(QuadraticResponse, KnowsByHowMuchCurvatureSpoilsAOneSidedDifference) {
  const Eigen::MatrixXd steps = 0.1 * Eigen::Matrix3d::Identity();
  const QuadraticResponse response(steps, 0);
  const Eigen::Vector3d bias = 0.5 * 0.1 * curvatures().diagonal();
  EXPECT_LT((response.slopes(changes(steps)) - slopes - bias).norm(), 1e-3);
  for (Eigen::Index j = 0; j < 3; ++j)
    EXPECT_NEAR(response.slope_errors()[j], 0.5 * 0.1 * QuadraticResponse::usual_curvature, 1e-3);
  EXPECT_EQ(response.rough_covariance().norm(), 0);
}

TEST(QuadraticResponse, ErrorsAreThoseOfRepeatedExperiments) {
  constexpr double roughness = 0.004;
  const Eigen::MatrixXd steps = scattered(20, 0.3, 2);
  const QuadraticResponse response(steps, roughness);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  Eigen::Vector3d all = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rough = Eigen::Matrix3d::Zero();
  constexpr int trials = 4000;
  for (int t = 0; t < trials; ++t) {
    // A response drawn from what the regression calls usual, then roughness, that of the base in common.
    Eigen::Matrix3d bend;
    for (Eigen::Index a = 0; a < 3; ++a)
      for (Eigen::Index b = 0; b <= a; ++b)
        bend(a, b) = bend(b, a) = QuadraticResponse::usual_curvature * normal(random);
    const Eigen::VectorXd third =
        QuadraticResponse::usual_third_order / 6 * Eigen::VectorXd::NullaryExpr(27, [&] { return normal(random); });
    const double base = roughness * normal(random);
    Eigen::VectorXd noise(steps.rows()), bent(steps.rows());
    for (Eigen::Index i = 0; i < steps.rows(); ++i) {
      const Eigen::Vector3d step = steps.row(i);
      noise[i] = roughness * normal(random) - base;
      bent[i] = slopes.dot(step) + 0.5 * step.dot(bend * step);
      for (Eigen::Index abc = 0; abc < 27; ++abc)
        bent[i] += third[abc] * step[abc / 9] * step[abc / 3 % 3] * step[abc % 3];
    }
    const Eigen::Vector3d error = response.slopes(bent + noise) - slopes;
    all += error.cwiseAbs2() / trials;
    rough += response.slopes(noise) * response.slopes(noise).transpose() / trials;
  }
  EXPECT_LT((rough - response.rough_covariance()).norm(), 0.06 * rough.norm());
  for (Eigen::Index j = 0; j < 3; ++j) EXPECT_NEAR(std::sqrt(all[j]) / response.slope_errors()[j], 1, 0.05);
}

TEST(QuadraticResponse, IsSurprisedByMoreCurvatureThanUsual) {
  const Eigen::MatrixXd steps = scattered(14, 0.3, 4);
  const QuadraticResponse response(steps, 0);
  EXPECT_LT(response.surprise(changes(steps)), 1.2);
  EXPECT_NEAR(response.surprise(10 * changes(steps)) / response.surprise(20 * changes(steps)), 0.5, 1e-9);
  EXPECT_GT(response.surprise(10 * changes(steps)), 3);
  EXPECT_EQ(QuadraticResponse(steps.topRows(3), 0).surprise(10 * changes(steps.topRows(3))), 1);
}

TEST(QuadraticResponse, ClaimsNothingWithoutRuns) {
  const QuadraticResponse response(Eigen::MatrixXd(0, 3), 0.001);
  EXPECT_EQ(response.slopes(Eigen::VectorXd(0)), Eigen::VectorXd::Zero(3));
  EXPECT_EQ(response.slope_errors(), Eigen::VectorXd::Constant(3, QuadraticResponse::any_slope));
}

}  // namespace
}  // namespace kerf
