// A rigid cylinder pressed into an elastic block: the nose bar of a scene at rest, lowered slowly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "models/laws/cubic.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using std::numbers::pi;

constexpr double radius = 40, lead = 12, compression = 0.1;  // mm

/// A block of 24 mm x 16 mm whose crack plane lies 4 mm below the surface, with bonds that nothing here breaks.
Scene block(int cells, const laws::Material& material) {
  Scene scene = kerf::testing::shipped("verification_45", {{"cut.depth", 4}});
  scene.material = material;
  scene.window = {.ahead = 6, .behind = 1, .below = 3, .above = 1.5};
  scene.resolution.cells_through_chip = cells;
  scene.resolution.courant_number = 0.5;
  scene.cut.notch = 0.1;
  scene.cut.speed = 1e-9;  // the rake face is somewhere else and stays there
  scene.nose_bar = NoseBar{.lead = lead, .radius = radius, .compression = 0};
  scene.cohesive.mode_I = scene.cohesive.mode_II = std::make_shared<laws::Cubic>(115, 10);
  return scene;
}

/// What the pressed block shows, averaged while the bar is held.
struct Pressed {
  double force = 0;       ///< N/mm, of the bar
  double half_width = 0;  ///< mm: twice the spread of the pressure, a for Hertz's
  double peak = 0;        ///< MPa, in the middle
  double edge = 0;        ///< mm: half of the length in contact
  double carried = 0;     ///< N/mm, by a section near the bottom
};

/// Lowers the bar smoothly within 0.2 ms, 17 times what a wave needs through the block, and holds it for half of that.
/// `axis` is the direction of the material's x.
Pressed press_block(int cells, const laws::Material& material, double axis = 0) {
  Scene scene = block(cells, material);
  State state = lay_out(scene);
  for (double& x : state.particles.axis_x) x = std::cos(axis);
  for (double& y : state.particles.axis_y) y = std::sin(axis);
  std::vector<Stage> stages = plan(scene);
  std::erase_if(stages, [](const Stage& stage) { return stage.name == "rake face" || stage.name == "underside"; });

  constexpr double lowering = 2e-4;
  Pressed mean;
  double spread = 0, count = 0;
  while (state.time < 1.5 * lowering) {
    const double part = std::min(1.0, state.time / lowering);
    scene.nose_bar->compression = compression * part * part * (3 - 2 * part);
    for (const Stage& stage : stages) stage.apply(state);
    state.time += state.step;
    if (state.time < lowering) continue;
    count += 1;
    double force = 0, second = 0, middle = 0;
    for (std::size_t k = 0; k < state.top.size(); ++k) {
      const double x = state.top.x[k] - lead, push = -state.top.force_y[k];
      force += push;
      second += push * x * x;
      if (std::abs(x) <= scene.cell()) middle += push;
    }
    const FaceForce& face = state.force.face[static_cast<std::size_t>(ToolFace::nose_bar)];
    EXPECT_NEAR(face.normal, force, 0.001 * force + 1e-9);  // vertical but for the bar's slope, below 0.05
    mean.force += force;
    mean.peak += middle / (2 * scene.cell());
    mean.edge += 0.5 * face.contact_length;
    spread += second / force;
    const Particles& p = state.particles;
    for (std::size_t i = 0; i < p.size(); ++i)
      if (std::abs(p.y[i] + 10) < scene.cell()) mean.carried -= p.volume[i] * p.stress_yy[i] / (2 * scene.cell());
  }
  EXPECT_TRUE(state.breakdown.empty()) << state.breakdown;
  for (double* value : {&mean.force, &mean.peak, &mean.edge, &mean.carried}) *value /= count;
  mean.half_width = 2 * std::sqrt(spread / count);
  return mean;
}

/// Hertz, line contact: P = pi E' a^2/(4 R), p_0 = E' a/(2 R), the pressure an ellipse of spread a/2. The block's
/// finite size is felt to second order in a over its depth, 1 %.
struct Hertz {
  double half_width, peak;
  Hertz(double force, double modulus)
      : half_width(std::sqrt(4 * radius * force / (pi * modulus))), peak(modulus * half_width / (2 * radius)) {}
};

/// The grid sees a surface about half a cell wide, so the contact comes out wider and the pressure lower, by a share
/// that falls as the cell. The contact is a = 6.4 cells at 16 cells through the layer, 3.1 at 8.
void expect_hertz(const Pressed& pressed, const Hertz& hertz, double cell, double width_error, double peak_error) {
  EXPECT_NEAR(pressed.half_width, hertz.half_width, width_error * hertz.half_width);
  EXPECT_NEAR(pressed.peak, hertz.peak, peak_error * hertz.peak);
  EXPECT_NEAR(pressed.edge, hertz.half_width, 0.6 * cell);
}

laws::Material polymer() {
  return laws::J2<laws::LinearHardening>{.elastic_modulus = 1000,
                                         .poisson_ratio = 0.33,
                                         .density = 1e-9,
                                         .hardening = {.yield_stress = 1e6, .modulus = 0}};
}

TEST(Hertz, ABarOnAnElasticBlockConvergesToLineContact) {
  const double modulus = 1000 / (1 - 0.33 * 0.33);
  const Pressed coarse = press_block(8, polymer()), fine = press_block(16, polymer());
  expect_hertz(coarse, {coarse.force, modulus}, 0.5, 0.075, 0.075);
  expect_hertz(fine, {fine.force, modulus}, 0.25, 0.04, 0.04);
  const auto error = [&](const Pressed& p) { return std::abs(p.half_width / Hertz(p.force, modulus).half_width - 1); };
  EXPECT_LT(error(fine), 0.65 * error(coarse));
}

/// Newton's third law through the whole block: what the bar presses with arrives at the bottom. At rest the two differ
/// by what still swings.
TEST(Hertz, TheBottomCarriesTheForceOfTheBar) {
  const Pressed pressed = press_block(8, polymer());
  EXPECT_NEAR(pressed.carried, pressed.force, 0.015 * pressed.force);
}

/// An orthotropic block with its axes turned. The compliance of a surface is the tensor L^-1 of Barnett & Lothe: with
/// 1/E'_y and 1/E'_x those of surfaces across the material's axes, a surface whose normal stands at an angle t from y
/// has
///     1/E' = cos^2 t/E'_y + sin^2 t/E'_x .
TEST(Hertz, ATurnedOrthotropicBlockHasTheComplianceOfItsTurnedSurface) {
  const laws::Hill::Constants along{.modulus_x = 2000,
                                    .modulus_y = 700,
                                    .modulus_z = 1000,
                                    .shear_modulus_xy = 400,
                                    .poisson_xy = 0.35,
                                    .poisson_xz = 0.3,
                                    .poisson_yz = 0.3,
                                    .density = 1e-9};
  laws::Hill::Constants across = along;  // x and y swapped
  across.modulus_x = along.modulus_y;
  across.modulus_y = along.modulus_x;
  across.poisson_xy = along.poisson_xy * along.modulus_y / along.modulus_x;
  across.poisson_xz = along.poisson_yz;
  across.poisson_yz = along.poisson_xz;
  const double E_y = laws::Hill(along).plane_strain_modulus(), E_x = laws::Hill(across).plane_strain_modulus();
  for (const double turn : {0.0, pi / 6, pi / 2}) {
    const Pressed pressed = press_block(12, laws::Hill(along), turn);
    const double c = std::cos(turn), s = std::sin(turn);
    expect_hertz(pressed, {pressed.force, 1 / (c * c / E_y + s * s / E_x)}, 1.0 / 3, 0.06, 0.06);
  }
}

}  // namespace
}  // namespace kerf::forward
