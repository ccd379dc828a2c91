#include "forward/record/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
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

/// A chip that swings: 630 with a period of 44 crossings, of which a third is left after each, and rougher than a
/// cosine.
std::vector<double> swinging(std::size_t n, double amplitude, unsigned seed) {
  std::vector<double> series = noise(n, 0.5, seed);
  for (std::size_t i = 0; i < n; ++i) {
    const double at = static_cast<double>(i), phase = 2.0 * std::numbers::pi * at / 44.0 + 0.7 * seed;
    const double swing = amplitude * std::exp(-at / 70.0);
    series[i] += 630.0 + swing * std::cos(phase) + 0.1 * swing * swing / amplitude * std::cos(2.0 * phase);
  }
  return series;
}

TEST(Swing, TellsTheLevelThatThePlainMeanHides) {
  double squared = 0.0, claimed = 0.0, plain = 0.0;
  constexpr int trials = 50;
  for (int trial = 0; trial < trials; ++trial) {
    const std::vector<double> series = swinging(80, 100.0, static_cast<unsigned>(trial));
    const auto swing = find_swing(series);
    ASSERT_TRUE(swing);
    EXPECT_NEAR(swing->wave, 2.0 * std::numbers::pi / 44.0, 0.05 * 2.0 * std::numbers::pi / 44.0);
    const Estimate found = level(series, swing);
    squared += std::pow(found.value - 630.0, 2) / trials;
    claimed += std::pow(found.standard_error, 2) / trials;
    plain += std::pow(batch_mean(series).value - 630.0, 2) / trials;
  }
  EXPECT_LT(std::sqrt(squared), 2.5);
  EXPECT_GT(std::sqrt(plain), 5.0);
  EXPECT_GT(std::sqrt(claimed), 0.6 * std::sqrt(squared));
}

TEST(Swing, IsNotSeenInNoiseNorInARunIn) {
  int seen = 0;
  for (unsigned seed = 0; seed < 100; ++seed) seen += find_swing(noise(100, 0.5, seed)) ? 1 : 0;
  EXPECT_EQ(seen, 0);
  std::vector<double> run_in = noise(120, 0.5, 3);
  for (std::size_t i = 0; i < run_in.size(); ++i) run_in[i] += 100.0 * std::exp(-static_cast<double>(i) / 40.0);
  EXPECT_FALSE(find_swing(run_in));
  EXPECT_FALSE(find_swing(std::vector<double>(10, 1.0)));
}

TEST(Swing, CalmedSeriesKeepsTheLevelAsItsMean) {
  const std::vector<double> series = swinging(120, 60.0, 4);
  const auto swing = find_swing(series);
  ASSERT_TRUE(swing);
  EXPECT_NEAR(batch_mean(calmed(series, *swing)).value, level(series, swing).value, 1e-9);
}

}  // namespace
}  // namespace kerf::forward
