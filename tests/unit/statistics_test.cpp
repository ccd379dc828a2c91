#include "forward/record/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace kerf::forward {
namespace {

/// Autoregressive noise: the standard error of its mean is 1 / (1 - memory) / sqrt(n).
std::vector<double> noise(std::size_t n, double memory, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> values(n);
  double value = 0.0;
  for (std::size_t i = 0; i < n; ++i) values[i] = value = memory * value + normal(engine);
  return values;
}

TEST(BatchMean, KnowsTheStandardErrorOfACorrelatedSeries) {
  double squared = 0.0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    const double error = batch_mean(noise(400, 0.5, static_cast<unsigned>(trial))).standard_error;
    squared += error * error / trials;
  }
  const double truth = 1.0 / 0.5 / std::sqrt(400.0);
  EXPECT_NEAR(std::sqrt(squared), truth, 0.12 * truth);
}

TEST(BatchMean, SaysThatThreeValuesTellNoError) {
  EXPECT_TRUE(std::isinf(batch_mean(std::vector<double>{1, 2, 3}).standard_error));
}

TEST(TruncationPoint, DropsADecayingStart) {
  std::vector<double> series = noise(200, 0.0, 7);
  for (std::size_t i = 0; i < series.size(); ++i) series[i] += 40.0 * std::exp(-static_cast<double>(i) / 12.0);
  const std::size_t from = truncation_point(series, 0);
  EXPECT_GT(from, 20u);
  EXPECT_LT(from, 90u);
}

TEST(TruncationPoint, KeepsASteadySeriesAndNeverStartsBeforeItIsAllowed) {
  std::vector<double> series(60, 5.0);
  EXPECT_EQ(truncation_point(series, 10), 10u);
}

}  // namespace
}  // namespace kerf::forward
