// Imperfect interfaces at any orientation against the closed form of a laminate with springs between its layers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "forward/bodies/shape.hpp"
#include "tests/shipped_scene.hpp"
#include "tests/verification/bodies_result.hpp"

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
