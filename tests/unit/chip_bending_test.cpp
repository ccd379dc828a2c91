#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "models/chip/beam_section.hpp"
#include "models/chip/chip_shape.hpp"
#include "models/chip/plastic_bending.hpp"
#include "models/chip/root_rotation.hpp"

namespace kerf::chip {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

BendingChip<double> verification_chip(double depth) {
  return {.depth = depth,
          .rake = 45.0 * degree,
          .yield_stress = 25.0 * plane_yield_stress_factor(true),
          .toughness = 2.0,
          .friction = 0.0,
          .modulus = plane_modulus(1000.0, 0.33, true),
          .hardening = 0.0,
          .root_rotation = 2.0 / 3.0};
}

/// Little toughness, strong hardening: yields, and stays inside the model's range.
BendingChip<double> sound_chip(double friction = 0.0, double hardening = 0.3) {
  auto chip = verification_chip(1.0);
  chip.toughness = 0.25;
  chip.friction = friction;
  chip.hardening = hardening;
  return chip;
}

/// Moment of a rectangular section of unit height by summing the stresses of its layers.
double layered_moment(double k, double hardening) {
  constexpr int layers = 200000;
  double moment = 0.0;
  for (int i = 0; i < layers; ++i) {
    const double y = (i + 0.5) / layers;  // half height 1, first yield at y = 1 for k = 1
    const double strain = k * y;
    const double stress = strain <= 1.0 ? strain : 1.0 + hardening * (strain - 1.0);
    moment += stress * y / layers;
  }
  return 3.0 * moment;  // M_y is one third
}

TEST(BeamSection, MomentIsTheSumOverItsLayers) {
  for (const double hardening : {0.0, 0.05, 0.3}) {
    for (const double k : {0.3, 1.0, 1.5, 4.0, 20.0}) {
      EXPECT_NEAR(section_moment(k, hardening), layered_moment(k, hardening), 1e-6);
    }
  }
}

TEST(BeamSection, EnergiesAreTheAreasUnderTheMoment) {
  for (const double hardening : {0.0, 0.1}) {
    const double k = 5.0;
    double complementary = 0.0;
    double work = 0.0;
    constexpr int steps = 200000;
    for (int i = 0; i < steps; ++i) {
      const double a = k * i / steps;
      const double b = k * (i + 1) / steps;
      const double ma = section_moment(a, hardening);
      const double mb = section_moment(b, hardening);
      complementary += 0.5 * (a + b) * (mb - ma);
      work += 0.5 * (ma + mb) * (b - a);
    }
    const double m = section_moment(k, hardening);
    EXPECT_NEAR(complementary_energy(k, hardening), complementary, 1e-8);
    EXPECT_NEAR(plastic_work(k, hardening), work - 0.5 * m * m, 1e-8);
  }
}

TEST(BeamSection, CurvatureInvertsTheComplementaryEnergy) {
  for (const double hardening : {0.0, 1e-4, 0.1, 0.9}) {
    for (const double k : {0.0, 0.5, 1.0, 1.7, 10.0, 300.0}) {
      EXPECT_NEAR(curvature_of_complementary_energy(complementary_energy(k, hardening), hardening), k,
                  1e-8 * (1.0 + k * k));
    }
  }
  EXPECT_TRUE(std::isinf(curvature_of_complementary_energy(1.5, 0.0))) << "perfect plasticity stores no more";
}

TEST(PlasticBending, AgreesWithTheReferenceValues) {
  const std::vector<std::pair<double, double>> reference = {{0.25, 3.92062}, {0.5, 5.81055}, {1.0, 9.57034}};
  for (const auto& [depth, F_c] : reference) {
    const auto chip = verification_chip(depth);
    const auto k = root_curvature(chip);
    ASSERT_TRUE(k.has_value());
    EXPECT_NEAR(chip.forces(*k).F_c, F_c, 1e-5 * F_c) << "depth " << depth;
    EXPECT_NEAR(chip.root_angle(*k) / chip.turn(), 0.97, 0.01);
    EXPECT_NE(out_of_bending_range(chip, *k), "");
  }
}

TEST(PlasticBending, SatisfiesBothOfItsEquations) {
  for (const double friction : {0.0, 0.3, 0.8}) {
    for (const double hardening : {0.0, 0.05, 0.3}) {
      const auto chip = sound_chip(friction, hardening);
      const auto k = root_curvature(chip);
      ASSERT_TRUE(k.has_value());
      const double N = chip.normal_force(*k);
      const double scale = chip.energy_scale();
      EXPECT_NEAR(N * chip.projection(chip.turn()), chip.toughness + plastic_work(*k, hardening) * scale, 1e-10);
      EXPECT_NEAR(N * chip.projection(chip.turn() - chip.root_angle(*k)), complementary_energy(*k, hardening) * scale,
                  1e-10);
      // Energy: the drive's work per area, less friction over the length that slides on the face, is what the chip
      // takes.
      const auto forces = chip.forces(*k);
      EXPECT_NEAR(forces.F_c - friction * N, chip.toughness + plastic_work(*k, hardening) * scale, 1e-10);
      EXPECT_NEAR(forces.F_t, force_slope(friction, chip.rake) * forces.F_c, 1e-10);
    }
  }
}

TEST(PlasticBending, ElasticWithoutRootRotationIsTheDoubleCantileverBeam) {
  auto chip = verification_chip(1.0);
  chip.yield_stress = 1e4;
  chip.root_rotation = 0.0;
  const auto k = root_curvature(chip);
  ASSERT_TRUE(k.has_value());
  ASSERT_LT(*k, 1.0);
  const double moment = *k * chip.yield_stress * chip.depth * chip.depth / 6.0;
  const double inertia = std::pow(chip.depth, 3) / 12.0;
  EXPECT_NEAR(moment * moment / (2.0 * chip.modulus * inertia), chip.toughness, 1e-10);
  EXPECT_NEAR(chip.forces(*k).F_c, chip.toughness, 1e-10) << "nothing else takes energy";
}

TEST(PlasticBending, TakesTheFirstCurvatureOfABendingChip) {
  // Little hardening: the two equations are met at k = 1.19, and once more where the root has used up the angle.
  auto chip = sound_chip(0.0, 0.05);
  chip.toughness = 0.16;
  const auto k = root_curvature(chip);
  ASSERT_TRUE(k.has_value());
  EXPECT_NEAR(*k, 1.19, 0.01);
  EXPECT_EQ(out_of_bending_range(chip, *k), "");
  for (double below = 0.01; below < *k * 0.999; below += 0.01) EXPECT_LT(chip.imbalance(below), 0.0);
  EXPECT_LT(chip.imbalance(5.0), 0.0) << "plastic work outgrows what the beam gives back";
}

/// Douglas-fir cut along the grain, crack plane RL, 45 degrees, frictionless.
BendingChip<double> bent_fir(double depth, double hardening) {
  return {.depth = depth,
          .rake = 45.0 * degree,
          .yield_stress = 100.0,
          .toughness = 0.158,
          .friction = 0.0,
          .modulus = 14500.0,
          .hardening = hardening,
          .root_rotation = orthotropic_root_rotation(14500.0, 960.0, 830.0)};
}

TEST(PlasticBending, IsFlaggedOnWoodUnlessItHardens) {
  // Least hardening ratio that keeps theta_0 <= theta/2, and F_c with a = 0.3. Within that rule is not
  // yet right: at the least ratio the form gives two to six times the force of a simulation.
  struct Case {
    double depth, least_hardening, F_c;
  };
  for (const auto& [depth, least_hardening, F_c] :
       {Case{0.1, 0.141, 0.600}, Case{0.2, 0.125, 0.807}, Case{0.3, 0.120, 0.973}, Case{0.4, 0.117, 1.116},
        Case{0.5, 0.1155, 1.242}}) {
    const auto reason = [&](double hardening) {
      const auto chip = bent_fir(depth, hardening);
      return out_of_bending_range(chip, root_curvature(chip).value());
    };
    EXPECT_NE(reason(0.0).find("without hardening"), std::string::npos) << depth;
    EXPECT_NEAR(*root_curvature(bent_fir(depth, 0.0)), 35.0, 0.1) << depth;
    EXPECT_NE(reason(least_hardening - 0.002), "") << depth;
    EXPECT_EQ(reason(least_hardening + 0.001), "") << depth;
    const auto hardened = bent_fir(depth, 0.3);
    EXPECT_NEAR(hardened.forces(*root_curvature(hardened)).F_c, F_c, 1e-3 * F_c) << depth;
  }
}

TEST(PlasticBending, FindsNoSolutionWhereTheBeamCannotStoreTheToughness) {
  auto chip = verification_chip(0.5);
  chip.root_rotation = 0.0;  // nothing is left that could swallow the angle
  EXPECT_FALSE(root_curvature(chip).has_value());
}

TEST(PlasticBending, PlaneStrainIsStifferAndStronger) {
  EXPECT_DOUBLE_EQ(plane_modulus(1000.0, 0.33, true), 1000.0 / (1.0 - 0.33 * 0.33));
  EXPECT_DOUBLE_EQ(plane_modulus(1000.0, 0.33, false), 1000.0);
  EXPECT_DOUBLE_EQ(plane_yield_stress_factor(false), 1.0);
}

TEST(ChipShape, OfAnElasticChipMeetsTheElastica) {
  // Elastic, clamped: k = sqrt(2 N A / scale); the arc is the elliptic integral of the elastica, summed here in the
  // angle.
  auto chip = verification_chip(1.0);
  chip.yield_stress = 1e4;
  chip.root_rotation = 0.0;
  const double k = *root_curvature(chip);
  const auto shape = chip_shape(chip, k);
  const double N = chip.normal_force(k);
  const double stiffness = chip.modulus * std::pow(chip.depth, 3) / 12.0;
  double length = 0.0;
  double rise = 0.0;
  constexpr int steps = 2000000;
  for (int i = 0; i < steps; ++i) {
    const double angle = chip.turn() * (i + 0.5) / steps;
    const double curvature = std::sqrt(2.0 * N * std::sin(chip.turn() - angle) / stiffness);
    length += chip.turn() / steps / curvature;
    rise += std::sin(angle) * chip.turn() / steps / curvature;
  }
  EXPECT_NEAR(shape.contact_length, length, 1e-3 * length);
  const double contact_rise = rise + 0.5 * chip.depth * (1.0 - std::cos(chip.turn()));
  EXPECT_NEAR(shape.lower_face.back().y, contact_rise, 2e-3 * contact_rise);
  EXPECT_TRUE(std::isinf(shape.curl_radius)) << "an elastic chip springs back straight";
  EXPECT_FALSE(shape.touching);
}

TEST(ChipShape, HangsTogether) {
  const auto chip = sound_chip(0.2);
  const double k = *root_curvature(chip);
  const auto shape = chip_shape(chip, k, 400);
  EXPECT_NEAR(shape.lower_face.front().x, 0.0, 1e-12);
  EXPECT_NEAR(shape.lower_face.front().y, 0.0, 1e-12);
  double arc = 0.0;
  for (std::size_t i = 1; i < shape.lower_face.size(); ++i) {
    arc += std::hypot(shape.lower_face[i].x - shape.lower_face[i - 1].x,
                      shape.lower_face[i].y - shape.lower_face[i - 1].y);
  }
  const double turned = chip.turn() - chip.root_angle(k);
  EXPECT_NEAR(arc, shape.contact_length + 0.5 * chip.depth * turned, 1e-4 * arc) << "the lower face is the outer one";
  EXPECT_GT(shape.tip_gap, 0.0);
  EXPECT_FALSE(shape.touching);
  EXPECT_GT(shape.curl_radius, chip.depth);
}

TEST(ChipShape, OfAChipThatOnlyTurnsAtItsRootTouches) {
  const auto chip = verification_chip(0.25);
  EXPECT_TRUE(chip_shape(chip, *root_curvature(chip)).touching);
}

}  // namespace
}  // namespace kerf::chip
