// What the dampings take from velocity fields whose fate is known, and that it is booked.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "forward/effects/thermostat.hpp"
#include "forward/effects/xpic.hpp"
#include "forward/mpm/transfer.hpp"
#include "forward/mpm/window.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

constexpr int none = 0, pic = 1;

/// A layer of 16 cells by 96 on a thin base.
Scene small_scene() {
  Scene scene = kerf::testing::shipped("verification_45", {{"resolution.cells_through_chip", 16}});
  scene.window.below = 1;
  return scene;
}

/// Energy of the upper layer before and after one step without forces that replaces the velocities wholly by PIC or by
/// XPIC of an order.
struct Energies {
  double before, after, booked;
};

/// Velocities v(x, y) at the particles, x and y in cells. Those within so many cells of the layer's faces do not count,
/// nor those within 12 of its ends.
template <class Field>
Energies damp(int order, double margin, Field&& field) {
  const Scene scene = small_scene();
  const double cell = scene.cell(), height = scene.cut.depth, length = scene.window.ahead * scene.cut.depth;
  State state = lay_out(scene);
  Particles& p = state.particles;
  const Array x = p.x, y = p.y;
  const auto counts = [&](std::size_t i) {
    return p.volume[i] > 0 && x[i] > 12 * cell && x[i] < length - 12 * cell && y[i] > margin * cell &&
           y[i] < height - margin * cell;
  };
  const auto energy = [&] {
    double sum = 0;
    for (std::size_t i = p.begin[above]; i < p.begin[above + 1]; ++i)
      if (counts(i))
        sum +=
            0.5 * state.density * p.volume[i] * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
    return sum;
  };
  for (std::size_t i = p.begin[above]; i < p.begin[above + 1]; ++i) {
    const auto [vx, vy] = field(x[i] / cell, y[i] / cell);
    p.velocity_x[i] = vx;
    p.velocity_y[i] = vy;
  }
  Energies result{.before = energy(), .after = 0, .booked = 0};
  gather_momentum(state);
  project_velocity(state);
  accelerate(state);
  if (order > pic) filter_velocity(state, order);
  order == none ? advance(state, 0.0) : order == pic ? advance(state, 1.0) : advance_filtered(state, 1.0);
  result.after = energy();
  result.booked = state.work.damping;
  return result;
}

struct Vector {
  double x, y;
};

constexpr double k = 2 * std::numbers::pi / 16;  // per cell
Vector wave(double x, double) {
  return {0, std::sin(k * x)};
}

/// The kernel smears a field by its variance, a quarter of a cell squared, on the way to the grid and again on the way
/// back. A wave of 16 cells keeps 1 - k^2/4 of its amplitude under PIC and 1 - (k^2/4)^m under XPIC(m), up to terms of
/// the next order in k^2.
TEST(Xpic, TakesFromALongWaveWhatTheKernelSmears) {
  const double smeared = k * k / 4;
  for (const auto& [order, left_out] : {std::pair{1, smeared}, {2, smeared * smeared}, {3, std::pow(smeared, 3)}}) {
    const Energies e = damp(order, 0, wave);
    EXPECT_NEAR(1 - std::sqrt(e.after / e.before), left_out, 0.1 * left_out) << "order " << order;
  }
}

/// Inside a body both leave linear fields alone, where a kernel and its transpose (three cells together) see material
/// only. At its surface, where half of the kernel is empty, PIC damps a rigid rotation and XPIC gives most of it back.
TEST(Xpic, LeavesARotationWherePicDampsIt) {
  const auto rotation = [](double x, double y) { return Vector{-(y - 8), x - 48}; };
  for (const int order : {1, 2}) {
    const Energies inside = damp(order, 3.0 * order, rotation);
    EXPECT_NEAR(inside.after, inside.before, 1e-12 * inside.before);
  }
  const auto of_layer = [&](int order) {
    const Energies e = damp(order, 0, rotation);
    return 1 - e.after / e.before;
  };
  EXPECT_GT(of_layer(pic), 1e-4);
  EXPECT_LT(of_layer(2), 0.1 * of_layer(pic));
  EXPECT_LT(of_layer(3), 0.5 * of_layer(2));
}

/// What goes from the particles is in the books, and plain FLIP takes nothing.
TEST(Xpic, BooksWhatItTakes) {
  const auto rough = [](double x, double y) {
    const double inside = x > 30 && x < 66 ? 1 : 0;  // away from the end that is held
    return Vector{inside * std::sin(2.3 * x) * std::cos(y), inside * std::cos(1.7 * x + y)};
  };
  for (const int order : {1, 2, 4}) {
    const Energies e = damp(order, 0, rough);
    EXPECT_GT(e.booked, 0);
    EXPECT_NEAR(e.booked, e.before - e.after, 1e-12 * e.before) << order;
  }
  const Energies flip = damp(none, 0, rough);
  EXPECT_EQ(flip.booked, 0);
}

/// A body with elastic energy U and kinetic energy K.
struct Body {
  Scene scene = small_scene();
  State state = lay_out(scene);
  double elastic = 0;

  double kinetic() const {
    const Particles& p = state.particles;
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
      sum +=
          0.5 * p.volume[i] * state.density * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
    return sum;
  }
  void scale(double factor) {
    for (double& v : state.particles.velocity_x) v *= factor;
    for (double& v : state.particles.velocity_y) v *= factor;
  }
  /// Uniaxial stress of 10 MPa, E = 1000 MPa: U = 0.05 MPa times the volume; and K = share times U.
  explicit Body(double share) {
    Particles& p = state.particles;
    for (std::size_t i = 0; i < p.size(); ++i) {
      p.stress_xx[i] = 10;
      elastic += 0.05 * p.volume[i];
      p.velocity_x[i] = std::sin(p.x[i]);
      p.velocity_y[i] = 1;
    }
    scale(std::sqrt(share * elastic / kinetic()));
    gather_momentum(state);
  }
};

constexpr Thermostat thermostat{.kinetic_share = 0.01, .gain = 0.02};

TEST(Thermostat, TakesItsFirstBiteFromParticlesAndNodesAlike) {
  Body body(0.03);  // three times the wanted share
  KineticThermostat act(thermostat, body.scene);
  const double before = body.kinetic();
  const Array momentum = body.state.grid.side[above].momentum;
  act(body.state);
  const double cfl = body.scene.resolution.courant_number, rate = 0.02 * cfl * (3 - 1);
  const double keep = std::exp(-rate * cfl);
  EXPECT_NEAR(body.kinetic(), before * keep * keep, 1e-12 * before);
  EXPECT_NEAR(body.state.work.damping, before * (1 - keep * keep), 1e-12 * before);
  for (std::size_t i = 0; i < momentum.size(); ++i)
    EXPECT_NEAR(body.state.grid.side[above].momentum[i], keep * momentum[i], 1e-15 + 1e-12 * std::abs(momentum[i]));
}

TEST(Thermostat, LetsBeWhatIsBelowItsTargetOrHasNone) {
  for (const double share : {0.005, 0.01}) {
    Body body(share);
    KineticThermostat act(thermostat, body.scene);
    const double before = body.kinetic();
    for (int i = 0; i < 10; ++i) act(body.state);
    EXPECT_NEAR(body.kinetic(), before, 1e-12 * before);
    EXPECT_NEAR(body.state.work.damping, 0, 1e-12 * before);
  }
  Body moving(0.03);
  for (double& stress : moving.state.particles.stress_xx) stress = 0;  // nothing to compare with
  KineticThermostat act(thermostat, moving.scene);
  act(moving.state);
  EXPECT_EQ(moving.state.work.damping, 0);
}

TEST(Thermostat, NeverBrakesFasterThanTenGains) {
  Body body(10);  // a thousand times the target
  KineticThermostat act(thermostat, body.scene);
  double last = body.kinetic();
  for (int i = 0; i < 5; ++i) {
    act(body.state);
    const double cfl = body.scene.resolution.courant_number;
    EXPECT_GE(body.kinetic(), last * std::exp(-2 * 10 * 0.02 * cfl) * (1 - 1e-12));
    last = body.kinetic();
  }
}

/// Something drives the body: in each step its velocities grow by a factor. The rate takes up what has come in, so over
/// whole swings the mean energy is the wanted one (what a feedback by an integral cannot miss).
TEST(Thermostat, HoldsADrivenBodyAtItsTarget) {
  Body body(0.02);
  KineticThermostat act(thermostat, body.scene);
  double sum = 0;
  constexpr int settle = 500, count = 5000;
  for (int i = 0; i < settle + count; ++i) {
    body.scale(1.002);
    act(body.state);
    if (i >= settle) sum += body.kinetic() / (0.01 * body.elastic);
  }
  EXPECT_NEAR(sum / count, 1, 0.01);
}

}  // namespace
}  // namespace kerf::forward
