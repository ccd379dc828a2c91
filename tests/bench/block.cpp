#include "tests/bench/block.hpp"

#include <cmath>
#include <numbers>

#include "forward/mpm/transfer.hpp"
#include "forward/mpm/window.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::bench {
namespace {

using forward::Particles;
using forward::State;

const forward::Scene& verification_cut() {
  static const forward::Scene scene = kerf::testing::shipped("verification_45");
  return scene;
}

/// Pulls every particle upwards through its own law, in place, until it flows.
void stretch(Particles& p, const laws::Material& material) {
  constexpr int pulls = 60;
  constexpr double pull = 1e-3;
  const laws::StrainIncrement strain{{}, {}, {}, all_lanes(pull)};
  std::visit(
      [&]<class Law>(const Law& law) {
        for (std::size_t first = 0; first < p.size(); first += lane_count) {
          laws::MaterialPoints points = p.material_points<Law::has_axes>(first);
          for (int i = 0; i < pulls; ++i) law.update(strain, points);
          p.set<Law::has_axes>(first, points);
        }
      },
      material);
}

}  // namespace

State block(const laws::Material& material, std::size_t particles, Flow flow) {
  forward::Scene scene = verification_cut();
  scene.material = material;
  scene.resolution.cells_through_chip = static_cast<int>(std::lround(std::sqrt(static_cast<double>(particles) / 16)));
  scene.resolution.courant_number = 1e-4;
  scene.window = {.ahead = 2, .behind = 0, .below = 1, .above = 1};
  State state = forward::lay_out(scene);

  constexpr double turn = 2.0 * std::numbers::pi;
  const double length = scene.window.ahead * scene.cut.depth, bottom = -scene.window.below * scene.cut.depth;
  const double rate = (flow == Flow::plastic ? 1e-4 : 1e-9) / state.step;
  Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double wave = std::sin(turn * p.x[i] / length) * std::sin(turn * (p.y[i] - bottom) / length);
    p.velocity_x[i] = 0.02 * rate * length * wave;
    p.velocity_y[i] = rate * (p.y[i] - bottom) * (1.0 + 0.05 * wave);
    p.x[i] += 0.5 * state.grid.cell_x * wave;
    p.y[i] += 0.5 * state.grid.cell_y * wave;
  }
  if (flow == Flow::plastic) stretch(p, material);
  forward::gather_momentum(state);
  return state;
}

double pic_share() {
  const forward::Scene& scene = verification_cut();
  return 1.0 - std::exp(-scene.pic_damping->rate * scene.resolution.courant_number);
}

void kernel_step(State& state, const laws::Material& material) {
  static const double pic = pic_share();
  forward::project_velocity(state);
  forward::update_stress(state, material);
  forward::accelerate(state);
  forward::advance(state, pic);
}

double yielding_share(const State& before, const State& after) {
  double yielding = 0;
  const auto &now = after.particles.plastic_strain, &then = before.particles.plastic_strain;
  for (std::size_t i = 0; i < now.size(); ++i) yielding += now[i] > then[i] ? 1.0 : 0.0;
  return yielding / static_cast<double>(now.size());
}

laws::Material polymer() {
  return verification_cut().material;
}

laws::Material elastic() {
  auto law = std::get<laws::J2<laws::LinearHardening>>(verification_cut().material);
  law.hardening.yield_stress = 1e12;
  return law;
}

laws::Material hencky() {
  return laws::Hencky<laws::LinearHardening>{std::get<laws::J2<laws::LinearHardening>>(verification_cut().material)};
}

laws::Material wood() {
  static const forward::Scene scene = kerf::testing::shipped("wood_rl");
  return scene.material;
}

}  // namespace kerf::bench
