// Elastodynamics of bodies against closed forms, with orders of convergence.
#include <gtest/gtest.h>

#include "tests/verification/bodies_trial.hpp"

namespace kerf::forward::bodies {
namespace {

double order(double coarse, double fine) {
  return std::log2(std::abs(coarse / fine));
}

// Quadratic splines with lumped masses see a wave exp(i(k x - w t)) with w = c k (1 - (k h)^2/8), to the second order
// in the cell h, and FLIP, which strains with what the nodes gather from the points, with w = c k (1 - (k h)^2/4).
double slowing(double k, double cell) {
  return -0.25 * k * k * cell * cell;
}

TEST(BodiesMotion, ABarVibratesAtItsFrequencyWithSecondOrder) {
  for (const bool free_end : {false, true}) {
    const double coarse = vibrate(8, free_end).frequency_error, middle = vibrate(16, free_end).frequency_error;
    const Vibration fine = vibrate(32, free_end);
    std::printf("%s: frequency off by %.2e, %.2e, %.2e with 8, 16, 32 cells: order %.2f, %.2f; energy kept %.6f\n",
                free_end ? "free end" : "walls", coarse, middle, fine.frequency_error, order(coarse, middle),
                order(middle, fine.frequency_error), fine.energy_kept);
    EXPECT_NEAR(order(coarse, middle), 2, 0.3);
    EXPECT_NEAR(order(middle, fine.frequency_error), 2, 0.3);
    EXPECT_NEAR(fine.frequency_error / slowing(std::numbers::pi / (free_end ? 20 : 10), 10.0 / 32), 1, 0.1);
    EXPECT_NEAR(fine.energy_kept, 1, 1e-3);
  }
}

TEST(BodiesMotion, WavesKeepTheirSpeedAndTheirShapeWithSecondOrder) {
  // Means of k^2 and k^6 over a hump cos^4(a x): 16/7 a^2 and 40/(35/128) a^6.
  const double a = 0.5 * std::numbers::pi / pulse_half_width, cell = pulse_length / 256;
  const double group = 3 * slowing(std::sqrt(16.0 / 7) * a, cell);
  // Two waves of half the hump, shifted by slowing(k) times the way.
  const double shape = std::sqrt(0.5 * 40 / (35.0 / 128)) * std::pow(a, 3) * 0.25 * cell * cell * 0.75 * pulse_length;
  for (const bool free_end : {false, true}) {
    const Pulse coarse = send_pulse(64, free_end), middle = send_pulse(128, free_end), fine = send_pulse(256, free_end);
    std::printf(
        "%s: speed off by %.2e, %.2e, %.2e, shape by %.2e, %.2e, %.2e with 64, 128, 256 cells: order %.2f, "
        "%.2f\n",
        free_end ? "free end" : "walls", coarse.speed_error, middle.speed_error, fine.speed_error, coarse.shape_error,
        middle.shape_error, fine.shape_error, order(coarse.shape_error, middle.shape_error),
        order(middle.shape_error, fine.shape_error));
    EXPECT_NEAR(fine.speed_error / group, 1, 0.1);
    EXPECT_NEAR(fine.shape_error / shape, 1, 0.2);
    EXPECT_NEAR(order(middle.speed_error, fine.speed_error), 2, 0.3);
    EXPECT_NEAR(order(middle.shape_error, fine.shape_error), 2, 0.3);
  }
}

// Splines see too little of the velocity at free edges, where nodes stand outside of the body: points there lag behind,
// and are strained for it.
TEST(BodiesMotion, AFreeBodyTurnsTheEasierTheFinerItIs) {
  const Rotation coarse = rotate(8), fine = rotate(16);
  for (const Rotation& r : {coarse, fine})
    std::printf(
        "after one turn: angular momentum %+.1e, energy %+.1e, momentum %.1e, stress %.2f rho v^2, place %.1e\n",
        r.angular_momentum, r.energy, r.momentum, r.stress, r.placed);
  EXPECT_LT(fine.momentum, 1e-12);
  EXPECT_GT(order(coarse.angular_momentum, fine.angular_momentum), 1.7);
  EXPECT_GT(order(coarse.placed, fine.placed), 1.7);
  EXPECT_GT(order(coarse.energy, fine.energy), 0.7);
  EXPECT_GT(order(coarse.stress, fine.stress), 0.7);
  EXPECT_LT(std::abs(fine.angular_momentum), 5e-3);
}

TEST(BodiesMotion, AManufacturedSolutionIsFoundWithSecondOrder) {
  const double coarse = manufactured_error(8), middle = manufactured_error(16), fine = manufactured_error(32);
  std::printf("displacements off by %.2e, %.2e, %.2e with 8, 16, 32 cells: order %.2f, %.2f\n", coarse, middle, fine,
              order(coarse, middle), order(middle, fine));
  EXPECT_LT(fine, 2e-2);
  EXPECT_GT(order(coarse, middle), 1.7);
  EXPECT_GT(order(middle, fine), 1.7);
}

}  // namespace
}  // namespace kerf::forward::bodies
