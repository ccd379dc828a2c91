#include "forward/bodies/state.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/bodies/strain.hpp"
#include "forward/mpm/stencil.hpp"

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

/// Velocities of APIC's points begin with the gradient of the start velocity.
void make_affine(const BodyPlan& plan, const Grid& grid, const ShapeFunction& shape, Frame frame, Points& p) {
  Points::Affine& C = p.affine;
  for (auto* values : {&C.xx, &C.xy, &C.yx, &C.yy, &C.spread_x, &C.spread_y}) values->assign(p.size(), 0.0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double k = plan.wavelength > 0.0 ? 2.0 * std::numbers::pi / plan.wavelength : 0.0;
    const double rise = k * std::cos(k * (p.x[i] - plan.shape.left));
    C.xx[i] = rise * plan.velocity_x;
    C.yx[i] = rise * plan.velocity_y + plan.spin;
    C.xy[i] = -plan.spin;
  }
  std::visit(
      [&](const auto& of) {
        for (std::size_t i = 0; i < p.size(); i += lane_count) {
          StencilOf stencil(grid, load(&p.kernel_x(frame)[i]), load(&p.kernel_y(frame)[i]), of);
          const auto [along, up] = stencil.take_moments();
          store(&C.spread_x[i], grid.cell_x * grid.cell_x * along);
          store(&C.spread_y[i], grid.cell_y * grid.cell_y * up);
        }
      },
      shape);
}

Place start_velocity(const BodyPlan& plan, double x, double y) {
  const Shape& shape = plan.shape;
  const double wave =
      plan.wavelength > 0.0 ? std::sin(2.0 * std::numbers::pi * (x - shape.left) / plan.wavelength) : 1.0;
  const Place middle = shape.middle();
  return {wave * plan.velocity_x - plan.spin * (y - middle.y), wave * plan.velocity_y + plan.spin * (x - middle.x)};
}

Body make_body(const BodyPlan& plan, double gap_x, double gap_y) {
  Body body{.law = plan.law, .points = {}, .field = {}};
  Points& p = body.points;
  const std::vector<laws::Memory> memory =
      std::visit([](const auto& law) { return std::decay_t<decltype(law)>::memory(); }, plan.law);
  p.memory.resize(memory.size());
  for (const Part& part : divide(plan.shape, gap_x, gap_y)) add_point(p, part.at.x, part.at.y, part.volume, memory);
  while (p.size() % lane_count != 0) add_point(p, p.x.back(), p.y.back(), 0.0, memory);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Place velocity = start_velocity(plan, p.x[i], p.y[i]);
    p.velocity_x[i] = velocity.x;
    p.velocity_y[i] = velocity.y;
  }
  if (plan.temperature > 0.0) p.temperature.assign(p.size(), plan.temperature);
  return body;
}

RigidBody make_rigid(const RigidPlan& plan, double gap_x, double gap_y) {
  RigidBody rigid;
  const auto add = [&](const Place& at, double volume) {
    rigid.x.push_back(at.x);
    rigid.y.push_back(at.y);
    rigid.volume.push_back(volume);
  };
  for (const Part& part : divide(plan.shape, gap_x, gap_y)) add(part.at, part.volume);
  while (rigid.x.size() % lane_count != 0) add({rigid.x.back(), rigid.y.back()}, 0.0);
  if (plan.ramp == 0.0) {
    rigid.velocity_x = plan.velocity_x;
    rigid.velocity_y = plan.velocity_y;
  }
  return rigid;
}

}  // namespace

State lay_out(const Scene& scene) {
  State state{.grid = {},
              .frame = frame_of(scene),
              .bodies = {},
              .piston = {.position = scene.length},
              .bath = {},
              .contact = {},
              .breakdown = {}};
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
    state.bodies.push_back(make_body(plan, grid.cell_x / side, grid.cell_y / side));
    if (std::holds_alternative<Apic>(scene.numerics.transfer))
      make_affine(plan, grid, scene.numerics.shape, state.frame, state.bodies.back().points);
    VelocityField& field = state.bodies.back().field;
    field.mass.assign(grid.nodes() + lane_count, 0.0);
    for (auto* values : {&field.momentum, &field.velocity, &field.change, &field.force})
      values->assign(2 * grid.nodes() + lane_count, 0.0);
  }
  for (const RigidPlan& plan : scene.rigids)
    state.contact.rigids.push_back(make_rigid(plan, grid.cell_x / side, grid.cell_y / side));
  find_stress(state);
  state.step = stable_step(state, scene);
  return state;
}

}  // namespace kerf::forward::bodies
