#include "forward/bodies/interface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "forward/mpm/bspline.hpp"
#include "models/base/error.hpp"

namespace kerf::forward::bodies {
namespace {

/// The common edge of two rectangles, mm.
struct Segment {
  double begin_x, begin_y, end_x, end_y;
};

std::optional<Segment> common_edge(const Shape& a, const Shape& b) {
  const auto same = [](double p, double q) { return std::abs(p - q) <= 1e-9 * (std::abs(p) + std::abs(q)); };
  const double bottom = std::max(a.bottom, b.bottom), top = std::min(a.bottom + a.height, b.bottom + b.height);
  const double left = std::max(a.left, b.left), right = std::min(a.left + a.width, b.left + b.width);
  if (top > bottom)
    for (const double x : {a.left, a.left + a.width})
      if (same(x, b.left) || same(x, b.left + b.width)) return Segment{x, bottom, x, top};
  if (right > left)
    for (const double y : {a.bottom, a.bottom + a.height})
      if (same(y, b.bottom) || same(y, b.bottom + b.height)) return Segment{left, y, right, y};
  return {};
}

}  // namespace

Joint::Joint(const State& state, const Scene& scene) : springs_(scene.interface) {
  const Grid& grid = state.grid;
  smallest_mass_ = std::numeric_limits<double>::infinity();
  for (const Body& body : state.bodies)
    smallest_mass_ = std::min(smallest_mass_, std::visit([](const auto& law) { return law.mass_density(); }, body.law));
  smallest_mass_ *= 1e-12 * grid.cell_x * grid.cell_y;
  if (!springs_) return;
  const std::optional<Segment> edge = common_edge(scene.bodies[0].shape, scene.bodies[1].shape);
  if (!edge)
    throw InputError(
        fmt::format("{}: this [[body]] has no edge in common with the other, where the [interface] could be",
                    scene.bodies[1].where));
  normal_ = edge->begin_x == edge->end_x ? 0 : 1;
  const double length = std::hypot(edge->end_x - edge->begin_x, edge->end_y - edge->begin_y);
  const int count = static_cast<int>(std::ceil(8.0 * length / std::min(grid.cell_x, grid.cell_y)));
  std::map<std::size_t, double> area;
  for (int k = 0; k < count; ++k) {
    const double t = (k + 0.5) / count;
    const Spline x(grid.column_of(edge->begin_x + t * (edge->end_x - edge->begin_x)));
    const Spline y(grid.row_of(edge->begin_y + t * (edge->end_y - edge->begin_y)));
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) area[grid.node(x.base + i, y.base + j)] += x.weight(i) * y.weight(j) * length / count;
  }
  // What falls behind a wall belongs to the mirror image.
  const auto fold = [&](std::size_t behind, std::size_t before) {
    const auto found = area.find(behind);
    if (found == area.end()) return;
    area[before] += found->second;
    area.erase(found);
  };
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < grid.columns; ++i) {
      if (scene.walls[bottom] == Wall::roller) fold(grid.node(i, k), grid.node(i, 3 - k));
      if (scene.walls[top] == Wall::roller) fold(grid.node(i, grid.rows - 1 - k), grid.node(i, grid.rows - 4 + k));
    }
    for (int j = 0; j < grid.rows; ++j) {
      if (scene.walls[left] == Wall::roller) fold(grid.node(k, j), grid.node(3 - k, j));
      if (scene.walls[right] == Wall::roller)
        fold(grid.node(grid.columns - 1 - k, j), grid.node(grid.columns - 4 + k, j));
    }
  }
  for (const auto& [node, share] : area) nodes_.push_back({.node = node, .area = share});
}

double Joint::stiffness(std::size_t component, double jump) const {
  if (component != normal_) return springs_->tangential;
  return jump < 0.0 ? springs_->compressive : springs_->normal;
}

void Joint::share_velocity(State& state) const {
  if (springs_) return slow_parting(state);
  if (state.bodies.size() < 2) return;
  for (std::size_t node = 0; node < state.grid.nodes(); ++node)
    for (std::size_t k = 2 * node; k < 2 * node + 2; ++k) {
      double mass = 0.0, momentum = 0.0, impulse = 0.0;
      for (const Body& body : state.bodies) {
        mass += body.field.mass[node];
        momentum += body.field.mass[node] * body.field.velocity[k];
        impulse += body.field.mass[node] * body.field.change[k];
      }
      if (mass <= smallest_mass_) continue;
      for (Body& body : state.bodies) {
        body.field.velocity[k] = momentum / mass;
        body.field.change[k] = impulse / mass;
      }
    }
}

/// Strains must not see a difference of the velocities that the springs will not let happen.
void Joint::slow_parting(State& state) const {
  VelocityField &a = state.bodies[0].field, &b = state.bodies[1].field;
  for (const Node& at : nodes_) {
    const double mass_a = a.mass[at.node], mass_b = b.mass[at.node];
    if (mass_a <= smallest_mass_ || mass_b <= smallest_mass_) continue;
    const double mass = mass_a * mass_b / (mass_a + mass_b);
    for (std::size_t component = 0; component < 2; ++component) {
      const std::size_t k = 2 * at.node + component;
      const double difference = b.velocity[k] - a.velocity[k];
      const double spring = stiffness(component, at.jump[component]) * at.area;
      const double lost = difference - difference / (1.0 + spring * state.step * state.step / mass);
      a.velocity[k] += mass / mass_a * lost;
      b.velocity[k] -= mass / mass_b * lost;
    }
  }
}

void Joint::join(State& state) {
  if (!springs_) return share_velocity(state);
  VelocityField &a = state.bodies[0].field, &b = state.bodies[1].field;
  const double dt = state.step;
  for (Node& at : nodes_) {
    const double mass_a = a.mass[at.node], mass_b = b.mass[at.node];
    if (mass_a <= smallest_mass_ || mass_b <= smallest_mass_) continue;
    const double mass = mass_a * mass_b / (mass_a + mass_b);
    for (std::size_t component = 0; component < 2; ++component) {
      const std::size_t k = 2 * at.node + component;
      double& jump = at.jump[component];
      const double free = b.velocity[k] + b.change[k] - a.velocity[k] - a.change[k];
      const double spring = stiffness(component, jump + dt * free) * at.area;
      const double difference = (free - spring * dt / mass * jump) / (1.0 + spring * dt * dt / mass);
      jump += dt * difference;
      const double impulse = mass * (difference - free);
      a.change[k] -= impulse / mass_a;
      b.change[k] += impulse / mass_b;
      state.damping += 0.5 * spring * dt * dt * difference * difference;
    }
  }
  state.interface_energy = energy();
}

double Joint::energy() const {
  double sum = 0.0;
  for (const Node& at : nodes_)
    for (std::size_t component = 0; component < 2; ++component) {
      const double jump = at.jump[component];
      sum += 0.5 * stiffness(component, jump) * at.area * jump * jump;
    }
  return sum;
}

}  // namespace kerf::forward::bodies
