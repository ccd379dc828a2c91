#include "forward/bodies/state.hpp"

#include <algorithm>
#include <cmath>

#include "forward/bodies/step.hpp"

namespace kerf::forward::bodies {
namespace {

constexpr int outside = 2;  // nodes beyond an edge of the box; behind a wall their values mirror those inside

int cells_along(double length, double cell) {
  return static_cast<int>(std::lround(length / cell));
}

void add_point(Points& p, double x, double y, double volume, const std::vector<laws::Memory>& memory) {
  for (auto* at : {&p.reference_x, &p.x}) at->push_back(x);
  for (auto* at : {&p.reference_y, &p.y}) at->push_back(y);
  for (auto* stretch : {&p.F_xx, &p.F_yy}) stretch->push_back(1.0);
  for (auto* shear : {&p.F_xy, &p.F_yx}) shear->push_back(0.0);
  p.volume.push_back(volume);
  for (auto* values : {&p.velocity_x, &p.velocity_y, &p.stress_xx, &p.stress_yy, &p.stress_zz, &p.stress_xy})
    values->push_back(0.0);
  for (std::size_t k = 0; k < memory.size(); ++k) p.memory[k].push_back(memory[k].at_rest);
}

Body make_body(const BodyPlan& plan, const Scene& scene, double gap_x, double gap_y) {
  Body body{.law = plan.law, .points = {}, .field = {}};
  Points& p = body.points;
  const std::vector<laws::Memory> memory =
      std::visit([](const auto& law) { return std::decay_t<decltype(law)>::memory(); }, plan.law);
  p.memory.resize(memory.size());
  // A point belongs to the body whose rectangle holds it.
  const int along = cells_along(scene.length, gap_x), up = cells_along(scene.height, gap_y);
  const auto inside = [](double at, double begin, double size) { return at > begin && at < begin + size; };
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < along; ++i) {
      const double x = gap_x * (i + 0.5), y = gap_y * (j + 0.5);
      if (inside(x, plan.left, plan.width) && inside(y, plan.bottom, plan.height))
        add_point(p, x, y, gap_x * gap_y, memory);
    }
  while (!p.x.empty() && p.size() % lane_count != 0) add_point(p, p.x.back(), p.y.back(), 0.0, memory);
  if (plan.temperature > 0.0) p.temperature.assign(p.size(), plan.temperature);
  return body;
}

}  // namespace

State lay_out(const Scene& scene) {
  State state{.grid = {}, .bodies = {}, .piston = {.position = scene.length}, .bath = {}, .breakdown = {}};
  Grid& grid = state.grid;
  const int along = cells_along(scene.length, scene.cell), up = cells_along(scene.height, scene.cell);
  grid.cell_x = scene.length / along;
  grid.cell_y = scene.height / up;
  grid.inverse_cell_x = 1.0 / grid.cell_x;
  grid.inverse_cell_y = 1.0 / grid.cell_y;
  grid.columns = along + 2 * outside;
  grid.rows = up + 2 * outside;
  constexpr int batch = static_cast<int>(lane_count);
  grid.stride = (grid.columns + batch - 1) / batch * batch;
  // Walls lie midway between two nodes, so that a wall's mirror maps nodes on nodes.
  grid.origin_x = -(outside - 0.5) * grid.cell_x;
  grid.origin_y = -(outside - 0.5) * grid.cell_y;
  const int side = scene.particles_per_cell_side;
  for (const BodyPlan& plan : scene.bodies) {
    state.bodies.push_back(make_body(plan, scene, grid.cell_x / side, grid.cell_y / side));
    VelocityField& field = state.bodies.back().field;
    field.mass.assign(grid.nodes() + lane_count, 0.0);
    for (auto* values : {&field.momentum, &field.velocity, &field.change, &field.force})
      values->assign(2 * grid.nodes() + lane_count, 0.0);
  }
  find_stress(state);
  state.step = stable_step(state, scene);
  return state;
}

}  // namespace kerf::forward::bodies
