// A log that turns against the tool, against the straight cut that it becomes as its radius grows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "forward/mpm/window.hpp"
#include "forward/run.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using kerf::testing::shipped;

/// The verification polymer, coarse; in a log of this radius (mm), or flat.
Scene polymer(double radius) {
  std::string text = kerf::testing::shipped_text("verification_45");
  text = kerf::testing::replaced(text, "cells_through_chip = 8", "cells_through_chip = 4");
  if (radius > 0) text += fmt::format("\n[log]\nradius = \"{} mm\"\n", radius);
  return read_scene(Document::parse(text, "log.toml"));
}

TEST(Spiral, GoesOneDepthInPerTurn) {
  const double R = 8, h = 0.5;
  const Spiral path(R, h);
  EXPECT_NEAR(path.radius_at(path.turn_length()), R - h, 1e-12);
  EXPECT_NEAR(path.angle_at(path.turn_length()), 2 * std::numbers::pi, 1e-12);
  // h s is the area that has been peeled off.
  const double s = 7;
  EXPECT_NEAR(std::numbers::pi * (R * R - path.radius_at(s) * path.radius_at(s)), h * s, 1e-12);
  // Material particle s stands still when the tip is there, but for the feed that lifts it by h a turn.
  const Roll roll = path.roll(s, 1000);
  EXPECT_NEAR(roll.velocity_x(0), 0, 1e-9);
  EXPECT_NEAR(roll.velocity_y(s), 1000 * h / (2 * std::numbers::pi * path.radius_at(s)), 1e-9);
  // Axis and turn are the integrals of their velocities.
  const double ds = 1e-3, dt = ds / 1000;
  const Roll before = path.roll(s - ds / 2, 1000), after = path.roll(s + ds / 2, 1000);
  EXPECT_NEAR((after.y - before.y) / dt, roll.speed_y, 1e-4);
  EXPECT_NEAR((after.turn - before.turn) / dt, roll.spin, 1e-4);
  // The normal is that of the curve: perpendicular to the chord between its neighbours.
  const auto point = [&](double at) {
    const double angle = path.angle_at(at) - roll.turn, r = path.radius_at(at);
    return std::pair{roll.x + r * std::sin(angle), roll.y + r * std::cos(angle)};
  };
  const auto [x1, y1] = point(s + 2 - ds);
  const auto [x2, y2] = point(s + 2 + ds);
  const auto [n_x, n_y] = path.normal(s + 2, s);
  EXPECT_NEAR((n_x * (x2 - x1) + n_y * (y2 - y1)) / (2 * ds), 0, 1e-5);
}

TEST(Log, LosesNothingOfItsArea) {
  const Scene scene = polymer(6.5);
  const State state = lay_out(scene);
  double volume = 0, layer = 0;
  for (std::size_t i = 0; i < state.particles.size(); ++i) {
    volume += state.particles.volume[i];
    if (i >= state.particles.begin[above]) layer += state.particles.volume[i];
  }
  // Between the outer spiral and a circle one and a half cells inside the core.
  const double R = 6, h = 0.5, deepest = scene.log->core - 1.5 * scene.cell();
  const double outer = R + h / 2;  // the mean of (R + h - h theta / 2 pi)^2 is outer^2 + h^2/12
  EXPECT_NEAR(volume, std::numbers::pi * (outer * outer + h * h / 12 - deepest * deepest), 2e-3 * volume);
  // h s + curvature: a ring of thickness h outside the path of length s.
  EXPECT_NEAR(layer, scene.log->length * h * (1 + h / (2 * R)), 0.02 * layer);
}

TEST(Log, LargeOnesAreCutLikeFlatWork) {
  const double flat = run(polymer(0)).F_c.value;
  const auto share = [&](double radius) {
    const CutResult log = run(polymer(radius));
    EXPECT_TRUE(log.accepted) << radius << ": " << log.refusals.front();
    EXPECT_NEAR(log.F_t.value / log.F_c.value, -1, 1e-3);
    EXPECT_NEAR(log.fracture_energy_ratio, 1, 0.025);
    EXPECT_LT(std::abs(log.ledger.residue()), 5e-3 * log.ledger.tool_work);
    return log.F_c.value / flat;
  };
  // Of a log the layer is already bent towards the base: the force is smaller, to first order in h/R.
  const double small = share(3), large = share(5.5);  // R = 5 h, 10 h
  std::cout << "F_c over that of flat work at R = 5 h and 10 h: " << small << ", " << large << "\n";
  EXPECT_LT(small, 0.95);
  EXPECT_NEAR(2 * large - small, 1, 0.02);
}

TEST(Log, TurnsItsGrain) {
  // Far from the knife nothing has happened to the wood but that it turned.
  const Scene scene = shipped("veneer", {{"cut.travel", 8}, {"steady_state.not_before", 8}, {"log.radius", 4.5}});
  State state = lay_out(scene);
  const auto far_side = [&](const State& s) {  // the particle deepest below the tip
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < s.particles.begin[above]; ++i)
      if (s.particles.volume[i] > 0 && s.particles.y[i] < s.particles.y[lowest]) lowest = i;
    return lowest;
  };
  const std::size_t i = far_side(state);
  EXPECT_NEAR(state.particles.axis_x[i], -1, 1e-3);  // around the log: opposite to what it is at the top
}

}  // namespace
}  // namespace kerf::forward
