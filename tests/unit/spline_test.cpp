#include <gtest/gtest.h>

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {
namespace {

TEST(Spline, SumsToOneReproducesPositionAndItsSlopesAreDerivatives) {
  for (double at = 3.0; at < 6.0; at += 0.0371) {
    const Spline spline(at);
    double sum = 0, position = 0, slopes = 0, gradient = 0;
    for (int i = 0; i < 3; ++i) {
      sum += spline.weight(i);
      position += spline.weight(i) * (spline.base + i);
      slopes += spline.slope(i);
      gradient += spline.slope(i) * (spline.base + i);
      EXPECT_NEAR(
          (Spline(spline.base, spline.f + 1e-6).weight(i) - Spline(spline.base, spline.f - 1e-6).weight(i)) / 2e-6,
          spline.slope(i), 1e-9);
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_NEAR(position, at, 1e-13);
    EXPECT_NEAR(slopes, 0.0, 1e-14);
    EXPECT_NEAR(gradient, 1.0, 1e-13);
  }
}

TEST(Spline, LanesHoldTheSameWeightsAsTheScalars) {
  const Spline spline(4.83);
  const Lanes weights = spline.row_weights();
  for (int i = 0; i < 3; ++i)
    for (int component = 0; component < 2; ++component)
      EXPECT_NEAR(weights[2 * i + component], spline.weight(i), 1e-15);
  EXPECT_EQ(weights[6], 0.0);
  EXPECT_EQ(weights[7], 0.0);
}

}  // namespace
}  // namespace kerf::forward
