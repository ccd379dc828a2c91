#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "models/chip/atkins.hpp"
#include "models/chip/chip_force.hpp"
#include "models/chip/root_rotation.hpp"
#include "models/chip/shear_minimised.hpp"

namespace kerf::chip {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Cut {
  double depth, rake, yield_stress, toughness, friction, adhesion;
};

/// Hard and soft, tough and brittle, with and without friction and adhesion, positive and negative rake.
std::vector<Cut> many_cuts() {
  std::vector<Cut> cuts;
  for (const double depth : {1e-3, 0.05, 1.0}) {
    for (const double rake : {-20.0, 0.0, 15.0, 45.0, 70.0}) {
      for (const double friction : {0.0, 0.3, 1.2}) {
        for (const double adhesion : {0.0, 0.7}) {
          cuts.push_back({depth, rake * degree, 28.9, 2.0, friction, adhesion});
          cuts.push_back({depth, rake * degree, 1200.0, 0.0, friction, adhesion});
          cuts.push_back({depth, rake * degree, 5.0, 40.0, friction, adhesion});
        }
      }
    }
  }
  return cuts;
}

ToolForces<double> forces_of(const Cut& cut) {
  return shear_minimised(cut.depth, cut.rake, cut.yield_stress, cut.toughness, cut.friction, cut.adhesion).forces;
}

TEST(ShearMinimised, AgreesWithTheReferenceValues) {
  const double plane_strain = 25.0 * 2.0 / std::numbers::sqrt3;
  const std::vector<std::pair<double, double>> reference = {{0.25, 4.98933}, {0.5, 7.97866}, {1.0, 13.95732}};
  for (const auto& [depth, F_c] : reference) {
    const auto forces = forces_of({depth, 45.0 * degree, plane_strain, 2.0, 0.0, 0.0});
    EXPECT_NEAR(forces.F_c, F_c, 1e-5 * F_c) << "depth " << depth;
    EXPECT_NEAR(forces.F_t, -F_c, 1e-5 * F_c) << "frictionless at 45 deg: F_t = -F_c";
  }
}

TEST(ShearMinimised, IsAtkinsEnergyBalanceAtItsMinimum) {
  for (const auto& cut : many_cuts()) {
    const auto least = atkins_minimum(cut.depth, cut.rake, cut.yield_stress, cut.toughness, cut.friction, cut.adhesion);
    const double F_c = forces_of(cut).F_c;
    EXPECT_NEAR(least.F_c, F_c, 1e-10 * F_c) << "depth " << cut.depth << " rake " << cut.rake / degree << " friction "
                                             << cut.friction << " adhesion " << cut.adhesion;
  }
}

TEST(ShearMinimised, IsTheChipForceBalanceAtItsOwnShearAngle) {
  for (const auto& cut : many_cuts()) {
    const auto forces = forces_of(cut);
    const double phi = std::atan2(cut.yield_stress * cut.depth, forces.F_c - cut.toughness);
    const auto balance =
        chip_force(cut.depth, cut.rake, phi, cut.yield_stress, cut.toughness, cut.friction, cut.adhesion);
    EXPECT_NEAR(balance.F_c, forces.F_c, 1e-10 * forces.F_c);
    EXPECT_NEAR(balance.F_t, forces.F_t, 1e-10 * forces.F_c);
    // Eq. (2) as printed.
    const double left = cut.yield_stress * cut.depth / (2.0 * std::sin(phi));
    const double right = (forces.F_c - cut.toughness) * std::cos(phi) -
                         (forces.F_t + cut.toughness * std::tan(cut.rake)) * std::sin(phi);
    EXPECT_NEAR(left, right, 1e-9 * (forces.F_c + left));
  }
}

TEST(ShearMinimised, NoNeighbouringShearAngleNeedsLessForce) {
  for (const auto& cut : many_cuts()) {
    const auto forces = forces_of(cut);
    const double phi = std::atan2(cut.yield_stress * cut.depth, forces.F_c - cut.toughness);
    for (const double factor : {0.98, 1.02}) {
      EXPECT_GT(atkins_cutting_force(factor * phi, cut.depth, cut.rake, cut.yield_stress, cut.toughness, cut.friction,
                                     cut.adhesion),
                forces.F_c * (1.0 - 1e-12));
    }
  }
}

TEST(ShearMinimised, ReachesTheToughnessAtZeroDepthAsASquareRoot) {
  const double rake = 15.0 * degree;
  const double mu = 0.4;
  for (const double adhesion : {0.0, 0.3}) {
    EXPECT_DOUBLE_EQ(forces_of({0.0, rake, 30.0, 2.0, mu, adhesion}).F_c, 2.0);
    const double rate =
        2.0 * 30.0 * (adhesion_offset(adhesion, mu, rake) + 2.0 * (force_slope(mu, rake) + std::tan(rake)));
    const double depth = 1e-10;
    const double rise = forces_of({depth, rake, 30.0, 2.0, mu, adhesion}).F_c - 2.0;
    EXPECT_NEAR(rise, std::sqrt(rate * depth), 1e-4 * rise);
  }
}

TEST(ShearMinimised, WithoutToughnessIsMerchantsChip) {
  // phi = pi/4 - (beta - alpha)/2 with sigma_y = 2 tau_y.
  const double rake = 10.0 * degree;
  const double mu = 0.5;
  const auto forces = forces_of({0.2, rake, 100.0, 0.0, mu, 0.0});
  const double phi = std::atan2(100.0 * 0.2, forces.F_c);
  EXPECT_NEAR(phi, std::numbers::pi / 4 - (std::atan(mu) - rake) / 2, 1e-12);
}

TEST(RakeFace, ForcesFollowFromNormalAndFriction) {
  const double rake = 25.0 * degree;
  const double mu = 0.35;
  const double N = 7.0;
  const double T = 0.2 + mu * N;
  const double F_c = N * std::cos(rake) + T * std::sin(rake);
  const double F_t = T * std::cos(rake) - N * std::sin(rake);
  EXPECT_NEAR(F_t, force_slope(mu, rake) * F_c + adhesion_offset(0.2, mu, rake), 1e-12);
  EXPECT_NEAR(force_slope(mu, rake), std::tan(std::atan(mu) - rake), 1e-12);
  EXPECT_NEAR(friction_from_slope(force_slope(mu, rake), rake), mu, 1e-12);
}

TEST(RakeFace, BottomForceFollowsEquationOne) {
  const double rake = 15.0 * degree;
  const double mu = 0.46;
  const double Z = force_slope(mu, rake);
  const double F_b = 30.0;
  const auto forces = with_bottom_force<double>({100.0, Z * 100.0}, F_b, mu);
  EXPECT_NEAR(forces.F_t, Z * forces.F_c + (1.0 - mu * Z) * F_b, 1e-12);
}

TEST(RootRotation, GivesThePublishedValuesForDouglasFir) {
  EXPECT_NEAR(orthotropic_root_rotation(14500, 960, 830), 1.586, 5e-4);  // RL
  EXPECT_NEAR(orthotropic_root_rotation(14500, 620, 760), 1.689, 5e-4);  // TL
}

TEST(RootRotation, OfAnIsotropicMaterialIsCloseToTwoThirds) {
  const double nu = 0.33;
  EXPECT_NEAR(orthotropic_root_rotation(1.0, 1.0, 1.0 / (2.0 * (1.0 + nu))), isotropic_root_rotation, 0.03);
}

TEST(ClosedForms, HaveUniqueNamesAndKeys) {
  std::vector<std::string> names;
  for (const auto& form : closed_forms()) {
    EXPECT_EQ(find_closed_form(form.name), &form);
    EXPECT_EQ(std::count(names.begin(), names.end(), form.name), 0);
    names.push_back(form.name);
    std::vector<std::string> keys;
    for (const auto& parameter : form.parameters) {
      EXPECT_EQ(std::count(keys.begin(), keys.end(), parameter.key), 0) << form.name << " " << parameter.key;
      EXPECT_FALSE(parameter.meaning.empty());
      keys.push_back(parameter.key);
    }
  }
  EXPECT_EQ(find_closed_form("atkin"), nullptr);
}

}  // namespace
}  // namespace kerf::chip
