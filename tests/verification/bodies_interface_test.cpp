// Imperfect interfaces at any orientation against the closed form of a laminate with springs between its layers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "forward/bodies/shape.hpp"
#include "tests/shipped_scene.hpp"
#include "tests/verification/bodies_result.hpp"
#include "tests/verification/bodies_trial.hpp"

namespace kerf::forward::bodies {
namespace {

using kerf::testing::replaced;
using kerf::testing::shipped_text;

/// The shipped laminate with its layers' normal at `angle` (deg) to the pull.
std::string laminate(int angle, double normal, double tangential) {
  std::string text = shipped_text("laminate");
  text = replaced(text, "slab_angle = \"60 deg\"", fmt::format("slab_angle = \"{} deg\"", 90 - angle));
  text = replaced(text, "slab_angle = \"-120 deg\"", fmt::format("slab_angle = \"{} deg\"", -90 - angle));
  text = replaced(text, "normal = \"100 MPa", fmt::format("normal = \"{} MPa", normal));
  return replaced(text, "tangential = \"50 MPa", fmt::format("tangential = \"{} MPa", tangential));
}

/// Two layers alone, pulled ten times as slowly: soft springs let layers swing.
std::string pair_of_layers(int angle, double D) {
  std::string text = laminate(angle, D, D);
  for (int k = 0; k < 2; ++k)
    text = replaced(replaced(replaced(text, "\"17 mm\"", "\"150 mm\""), "\"34 mm\"", "\"300 mm\""), "\"15 mm\"",
                    "\"50 mm\"");
  text = replaced(replaced(text, "\"0.02 m/s\"", "\"0.002 m/s\""), "ramp = \"0.2 ms\"", "ramp = \"8 ms\"");
  return replaced(text, "longest = \"12 ms\"", "longest = \"60 ms\"\nramp = \"4 ms\"");
}

TEST(BodiesInterface, ALaminateAtAnyAngleIsAsStiffAsTheClosedForm) {
  for (const int angle : {0, 15, 30, 45, 60, 90})
    for (const double D : {30.0, 1e3, 5e8}) {  // the last a million times E/cell
      const BodiesResult result = result_of(laminate(angle, D, 0.5 * D));
      ASSERT_TRUE(result.accepted) << angle << ' ' << D << result.refusals[0];
      std::printf("%d deg, D = %.0e MPa/mm: effective modulus %.1f MPa, off by %.1e\n", angle, D,
                  number(result, "effective_modulus"), number(result, "effective_modulus_error"));
      EXPECT_LT(number(result, "effective_modulus_error"), 5e-3) << angle << ' ' << D;
      if (D > 1e8) {
        EXPECT_NEAR(number(result, "effective_modulus") / (1000 / 0.91), 1.0, 5e-3) << angle;
      }
      const Reading& end = result.history.back();
      EXPECT_LT(std::abs(end.residue()), 2e-3 * end.piston_work) << angle << ' ' << D;
    }
}

TEST(BodiesInterface, SoftSpringsHoldNearlyAllTheWork) {
  constexpr double D = 0.01;  // E/1000 over the bar's length
  for (const int angle : {0, 45}) {
    const BodiesResult result = result_of(pair_of_layers(angle, D));
    ASSERT_TRUE(result.accepted) << angle;
    std::printf("%d deg, D = %.2f MPa/mm: effective modulus %.4f MPa, off by %.1e\n", angle, D,
                number(result, "effective_modulus"), number(result, "effective_modulus_error"));
    EXPECT_LT(number(result, "effective_modulus_error"), 5e-3) << angle;
    const Reading& end = result.history.back();
    EXPECT_NEAR(end.interface / end.piston_work, 1.0, 5e-3);
    EXPECT_LT(std::abs(end.residue()), 2e-3 * end.piston_work);
  }
}

TEST(BodiesInterface, LayersOfTwoMaterialsFollowReussAndVoigt) {
  const std::string modulus = "elastic_modulus = \"1000 MPa\"", rigid_side = "poisson_ratio = 0.3";
  for (const auto& [angle, tolerance] : {std::pair{0, 5e-3}, {90, 5e-3}, {45, 0.03}}) {
    std::string text = laminate(angle, 100, 100);
    text = replaced(text, modulus, "elastic_modulus = \"2000 MPa\"");
    for (int k = 0; k < 2; ++k) text = replaced(text, rigid_side, "poisson_ratio = 0.0");
    const BodiesResult result = result_of(text);
    ASSERT_TRUE(result.accepted) << angle;
    std::printf("%d deg, 1 and 2 GPa: effective modulus off by %.1e\n", angle,
                number(result, "effective_modulus_error"));
    EXPECT_LT(number(result, "effective_modulus_error"), tolerance) << angle;
  }
}

/// Two bars of 10 mm, free at their far ends and joined by springs, fly apart and together. By symmetry each swings on
/// springs 2D to a plane at rest: w = c k with k L tan(k L) = 2 D L/E.
struct Swing {
  double frequency_error;
  double energy_kept, energy_swing;  ///< of all energy, the springs' included, over ten periods
};
Swing swing_on_springs(double D, double cell) {
  constexpr double length = 10;
  const double c = std::sqrt(trial_modulus / trial_density);
  double low = 0, high = 0.5 * std::numbers::pi;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (middle * std::tan(middle) < 2 * D * length / trial_modulus ? low : high) = middle;
  }
  const double period = 2 * std::numbers::pi * length / (low * c);
  const auto bar = [&](double left, double velocity) {
    return fmt::format("left = \"{} mm\"\nwidth = \"{} mm\"\nvelocity_x = \"{} m/s\"", left, length, velocity);
  };
  const std::string one = trial_scene(24, 4 * cell, cell, "left = \"open\"", bar(2, -0.1), "");
  const std::size_t body = one.find("[[body]]"), stroke = one.find("[[stroke]]");
  std::string other = one.substr(body, stroke - body);
  other.replace(other.find("left ="), std::string::npos, bar(12, 0.1) + "\n");
  Trial trial(one.substr(0, stroke) + other + one.substr(stroke) +
              fmt::format("[interface]\nnormal = \"{0} MPa/mm\"\ntangential = \"{0} MPa/mm\"\n", D));
  const auto apart = [&] {
    double sum = 0;
    for (std::size_t b = 0; b < 2; ++b) {
      const Points& p = trial.state.bodies[b].points;
      for (std::size_t i = 0; i < p.size(); ++i) sum += (b == 0 ? -1 : 1) * p.volume[i] * (p.x[i] - p.reference_x[i]);
    }
    return sum;
  };
  constexpr int periods = 10;
  const auto [crossings, energy] = watch(trial, (periods + 0.75) * period, apart);
  if (crossings.size() < 2) return {.frequency_error = std::nan(""), .energy_kept = 0, .energy_swing = 1};
  const std::size_t one_period = energy.size() * 4 / (4 * periods + 3);
  const auto mean = [&](std::size_t first) {
    double sum = 0;
    for (std::size_t i = first; i < first + one_period; ++i) sum += energy[i];
    return sum / static_cast<double>(one_period);
  };
  double most = 0;
  for (const double e : energy) most = std::max(most, std::abs(e / mean(0) - 1));
  const double found = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  return {.frequency_error = period / found - 1,
          .energy_kept = mean(energy.size() - one_period) / mean(0),
          .energy_swing = most};
}

TEST(BodiesInterface, BarsSwingOnSpringsAtTheirFrequencyAndKeepTheirEnergy) {
  for (const double D : {1.0, 100.0, 2000.0}) {  // the last E/cell
    const Swing coarse = swing_on_springs(D, 1.0), fine = swing_on_springs(D, 0.5);
    std::printf(
        "D = %.0f MPa/mm: frequency off by %+.2e, %+.2e with cells of 1, 0.5 mm; energy kept %.5f, swings by %.1e\n", D,
        coarse.frequency_error, fine.frequency_error, fine.energy_kept, fine.energy_swing);
    // FLIP slows waves by (k h)^2/4, at most 1.5e-3 here.
    EXPECT_LT(std::abs(fine.frequency_error), 2e-3) << D;
    EXPECT_GT(std::log2(coarse.frequency_error / fine.frequency_error), 1.5) << D;
    EXPECT_NEAR(fine.energy_kept, 1, 3e-4) << D;
    EXPECT_LT(fine.energy_swing, 0.04) << D;
  }
}

TEST(BodiesInterface, TheEdgeOfTwoShapesHasItsLengthAndNormal) {
  for (const double degrees : {0.0, 15.0, 37.0, 90.0, 140.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    Shape one{.left = 2, .bottom = 1, .width = 10, .height = 10, .disc = {}, .slab = {}}, other = one;
    constexpr double infinite = std::numeric_limits<double>::infinity();
    one.slab = {.x = 7, .y = 6, .angle = angle, .thickness = infinite, .period = infinite};
    other.slab = {.x = 7, .y = 6, .angle = angle + std::numbers::pi, .thickness = infinite, .period = infinite};
    double length = 0;
    for (const EdgePiece& piece : common_edge(one, other, 0.05)) {
      length += piece.length;
      EXPECT_NEAR(piece.normal_x, std::sin(angle), 1e-12);
      EXPECT_NEAR(piece.normal_y, -std::cos(angle), 1e-12);
    }
    EXPECT_NEAR(length, 10 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle))), 1e-9) << degrees;
    double volume = 0;
    for (const Shape& shape : {one, other})
      for (const Part& part : divide(shape, 0.5, 0.5)) volume += part.volume;
    EXPECT_NEAR(volume, 100, 0.02) << degrees;
  }
}

}  // namespace
}  // namespace kerf::forward::bodies
