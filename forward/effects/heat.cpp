#include "forward/effects/heat.hpp"

#include <algorithm>

#include "forward/mpm/each_node.hpp"

namespace kerf::forward {
namespace {

double capacity(const Scene& scene) {
  return laws::density(scene.material) * scene.thermal->specific_heat;
}

}  // namespace

std::vector<double> temperatures(const State& state, const Scene& scene) {
  const Particles& p = state.particles;
  std::vector<double> T(p.size(), scene.thermal->start);
  const double per_work = scene.thermal->taylor_quinney / capacity(scene);
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) T[i] += per_work * law.plastic_work(p.plastic_strain[i]);
      },
      scene.material);
  if (const double alpha = scene.thermal->expansion; alpha > 0.0) {
    const double per_stress = alpha * scene.thermal->start / capacity(scene);
    for (std::size_t i = 0; i < p.size(); ++i) T[i] -= per_stress * (p.stress_xx[i] + p.stress_yy[i] + p.stress_zz[i]);
  }
  if (p.keeps_heat)
    for (std::size_t i = 0; i < p.size(); ++i) T[i] += p.conducted[i];
  return T;
}

void HeatConduction::operator()(State& state) {
  Particles& p = state.particles;
  const Grid& grid = state.grid;
  const std::vector<double> T = temperatures(state, scene_);
  for (auto* values : {&volume_, &temperature_, &rate_}) values->assign(grid.nodes(), 0.0);
  const auto each_particle = [&](auto&& visit) {
    for (std::size_t i = 0; i < p.begin[2]; ++i)
      if (p.volume[i] > 0.0 && grid.holds(grid.column_of(p.x[i]), grid.row_of(p.y[i]))) visit(i);
  };
  each_particle([&](std::size_t i) {
    each_node(grid, p.x[i], p.y[i], [&](std::size_t node, double w, double, double) {
      volume_[node] += w * p.volume[i];
      temperature_[node] += w * p.volume[i] * T[i];
    });
  });
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    if (volume_[node] > 0.0) temperature_[node] /= volume_[node];
  const double diffusivity = scene_.thermal->conductivity / capacity(scene_);
  each_particle([&](std::size_t i) {
    double along = 0.0, up = 0.0;
    each_node(grid, p.x[i], p.y[i], [&](std::size_t node, double, double dx, double dy) {
      along += dx * temperature_[node];
      up += dy * temperature_[node];
    });
    const double flow = diffusivity * p.volume[i];
    each_node(grid, p.x[i], p.y[i],
              [&](std::size_t node, double, double dx, double dy) { rate_[node] -= flow * (along * dx + up * dy); });
  });
  for (std::size_t node = 0; node < grid.nodes(); ++node)
    if (volume_[node] > 0.0) rate_[node] *= state.step / volume_[node];
  each_particle([&](std::size_t i) {
    each_node(grid, p.x[i], p.y[i],
              [&](std::size_t node, double w, double, double) { p.conducted[i] += w * rate_[node]; });
  });
}

void warm_by_friction(State& state, const Scene& scene) {
  Particles& p = state.particles;
  const double per_capacity = 1.0 / scene.thermal->specific_heat;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<double>& heat = state.friction_heat[side];
    if (std::all_of(heat.begin(), heat.end(), [](double h) { return h == 0.0; })) continue;
    for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; ++i)
      each_node(state.grid, p.x[i], p.y[i],
                [&](std::size_t node, double w, double, double) { p.conducted[i] += per_capacity * w * heat[node]; });
    std::fill(heat.begin(), heat.end(), 0.0);
  }
}

double longest_conduction_step(const Grid& grid, const Scene& scene) {
  const double cell = std::min(grid.cell_x, grid.cell_y);
  return 0.25 * cell * cell * capacity(scene) / scene.thermal->conductivity;
}

}  // namespace kerf::forward
