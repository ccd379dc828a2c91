// Slopes and curvatures from scattered rough values: against an exact quadratic, and against the errors they claim.

#include "inverse/quadratic_response.hpp"

#include <gtest/gtest.h>

#include <random>

namespace kerf {
namespace {

using inverse::QuadraticResponse;
using inverse::Texture;

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
  const QuadraticResponse response(steps, {.roughness = 0});
  EXPECT_LT((response.slopes(changes(steps)) - slopes).norm(), 1e-3);
  EXPECT_LT((response.curvatures(changes(steps)) - curvatures()).norm(), 0.03);
}

TEST(QuadraticResponse, KnowsByHowMuchCurvatureSpoilsAOneSidedDifference) {
  const Eigen::MatrixXd steps = 0.1 * Eigen::Matrix3d::Identity();
  const QuadraticResponse response(steps, {.roughness = 0});
  const Eigen::Vector3d bias = 0.5 * 0.1 * curvatures().diagonal();
  EXPECT_LT((response.slopes(changes(steps)) - slopes - bias).norm(), 1e-3);
  for (Eigen::Index j = 0; j < 3; ++j)
    EXPECT_NEAR(response.slope_errors()[j], 0.5 * 0.1 * QuadraticResponse::usual_curvature, 1e-3);
  EXPECT_EQ(response.rough_covariance().norm(), 0);
}

TEST(QuadraticResponse, ErrorsAreThoseOfRepeatedExperiments) {
  constexpr double roughness = 0.004;
  const Eigen::MatrixXd steps = scattered(20, 0.3, 2);
  const QuadraticResponse response(steps, {.roughness = roughness});
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

Texture likeliest_texture(const Eigen::MatrixXd& steps, const Eigen::VectorXd& changes, double roughness) {
  return inverse::likeliest_textures({{steps, changes, {.roughness = roughness}}}).front();
}

/// Rough values, that of the base in common.
Eigen::VectorXd roughened(Eigen::VectorXd changes, double roughness, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, roughness);
  const double base = normal(random);
  for (double& change : changes) change += normal(random) - base;
  return changes;
}

TEST(Texture, StaysAsSaidWhereValuesAreSo) {
  std::mt19937_64 random(7);
  int left = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Eigen::MatrixXd steps = scattered(12, 0.3, seed);
    const Texture found = likeliest_texture(steps, roughened(changes(steps), 0.001, random), 0.001);
    left += found.roughness > 0.002 || found.bend > 1 ? 1 : 0;
  }
  EXPECT_LE(left, 5);
}

TEST(Texture, FindsWhatBendsMoreThanUsual) {
  const Eigen::MatrixXd steps = scattered(20, 0.3, 4);
  const Eigen::VectorXd straight = steps * slopes, bent = straight + 20 * (changes(steps) - straight);
  const Texture found = likeliest_texture(steps, bent, 0.001);
  EXPECT_LE(found.roughness, 0.004);
  EXPECT_GE(found.bend, 4);
  EXPECT_LT((QuadraticResponse(steps, found).slopes(bent) - slopes).norm(), 0.02);
}

TEST(Texture, FindsRoughnessThatNobodySaid) {
  // The mean of many draws: twenty runs know their roughness to a fifth.
  const Eigen::MatrixXd steps = scattered(20, 0.3, 4);
  std::mt19937_64 random(5);
  double logarithm = 0, error = 0, claimed = 0;
  constexpr int draws = 200;
  for (int i = 0; i < draws; ++i) {
    const Eigen::VectorXd rough = roughened(changes(steps), 0.02, random);
    const Texture found = likeliest_texture(steps, rough, 0.001);
    const QuadraticResponse response(steps, found);
    logarithm += std::log(found.roughness / 0.02) / draws;
    error += (response.slopes(rough) - slopes).squaredNorm() / draws;
    claimed += response.slope_errors().squaredNorm() / draws;
  }
  EXPECT_NEAR(logarithm, 0, 0.35) << "it goes by doublings, and is held a little at what was said";
  EXPECT_NEAR(std::sqrt(error / claimed), 1, 0.2);
}

TEST(Texture, IsKnownTogetherWhereItIsNotKnownAlone) {
  // Eight cuts of three differences and five runs more, seventy times as rough as said.
  std::mt19937_64 random(9);
  double logarithm = 0, error = 0, claimed = 0;
  constexpr int draws = 20;
  for (int draw = 0; draw < draws; ++draw) {
    std::vector<inverse::ResponseSample> samples;
    for (unsigned cut = 0; cut < 8; ++cut) {
      Eigen::MatrixXd steps(8, 3);
      steps << 0.04 * Eigen::Matrix3d::Identity(), scattered(5, 0.15, 8 * static_cast<unsigned>(draw) + cut);
      samples.push_back({steps, roughened(changes(steps), 0.002, random), {.roughness = 3e-5}});
    }
    const std::vector<Texture> found = inverse::likeliest_textures(samples);
    for (std::size_t cut = 0; cut < samples.size(); ++cut) {
      const QuadraticResponse response(samples[cut].steps, found[cut]);
      logarithm += std::log(found[cut].roughness / 0.002) / (8 * draws);
      error += (response.slopes(samples[cut].changes) - slopes).squaredNorm();
      claimed += response.slope_errors().squaredNorm();
    }
  }
  EXPECT_NEAR(logarithm, 0, 0.5);
  EXPECT_NEAR(std::sqrt(error / claimed), 1, 0.3);
}

TEST(Texture, NeighboursShareARippleAndFarValuesDoNot) {
  const auto error_of_difference = [](double step) {
    const Eigen::MatrixXd one = Eigen::MatrixXd::Constant(1, 1, step);
    return std::sqrt(QuadraticResponse(one, {.ripple = 0.01}).rough_covariance()(0, 0));
  };
  EXPECT_NEAR(error_of_difference(0.01), 0.01 / QuadraticResponse::ripple_length, 1e-3);
  EXPECT_NEAR(error_of_difference(2), 0.01 * std::sqrt(2.0) / 2, 1e-4);
}

TEST(Texture, AsFewRunsAsSlopesTellNothingOfTheRest) {
  const Eigen::MatrixXd steps = scattered(3, 0.3, 6);
  const Texture found = likeliest_texture(steps, 10 * changes(steps), 0.001);
  EXPECT_EQ(found.roughness, 0.001);
  EXPECT_EQ(found.bend, 1);
}

TEST(QuadraticResponse, ClaimsNothingWithoutRuns) {
  const QuadraticResponse response(Eigen::MatrixXd(0, 3), {.roughness = 0.001});
  EXPECT_EQ(response.slopes(Eigen::VectorXd(0)), Eigen::VectorXd::Zero(3));
  EXPECT_EQ(response.slope_errors(), Eigen::VectorXd::Constant(3, QuadraticResponse::any_slope));
}

}  // namespace
}  // namespace kerf
