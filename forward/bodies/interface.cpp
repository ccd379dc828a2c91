#include "forward/bodies/interface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "forward/bodies/walls.hpp"
#include "forward/mpm/bspline.hpp"
#include "models/base/error.hpp"

namespace kerf::forward::bodies {
namespace {

/// The nodes that a body's points reach, and those behind walls.
std::vector<bool> reached_by(const Grid& grid, const Points& points) {
  std::vector<bool> reached(grid.nodes(), false);
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (points.volume[p] == 0.0) continue;
    const Spline x(grid.column_of(points.reference_x[p])), y(grid.row_of(points.reference_y[p]));
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) reached[grid.node(x.base + i, y.base + j)] = true;
  }
  return reached;
}

}  // namespace

Joint::Joint(const State& state, const Scene& scene) : scene_(scene), springs_(scene.interface) {
  const Grid& grid = state.grid;
  smallest_mass_ = std::numeric_limits<double>::infinity();
  for (const Body& body : state.bodies)
    smallest_mass_ = std::min(smallest_mass_, std::visit([](const auto& law) { return law.mass_density(); }, body.law));
  smallest_mass_ *= 1e-12 * grid.cell_x * grid.cell_y;
  if (springs_) find_nodes(state);
}

void Joint::find_nodes(const State& state) {
  const Grid& grid = state.grid;
  const std::vector<EdgePiece> edge =
      common_edge(scene_.bodies[0].shape, scene_.bodies[1].shape, std::min(grid.cell_x, grid.cell_y) / 16.0);
  if (edge.empty())
    throw InputError(
        fmt::format("{}: this [[body]] has no edge in common with the other, where the [interface] could be",
                    scene_.bodies[1].where));
  const std::vector<bool> first = reached_by(grid, state.bodies[0].points),
                          second = reached_by(grid, state.bodies[1].points);
  struct Share {
    double area = 0, x = 0, y = 0;
  };
  std::map<std::size_t, Share> shares;
  for (const EdgePiece& piece : edge) {
    const Spline x(grid.column_of(piece.at.x)), y(grid.row_of(piece.at.y));
    const auto each_shared = [&](auto&& visit) {
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          if (const std::size_t node = grid.node(x.base + i, y.base + j); first[node] && second[node])
            visit(node, x.weight(i) * y.weight(j));
    };
    double sum = 0.0;
    each_shared([&](std::size_t, double weight) { sum += weight; });
    each_shared([&](std::size_t node, double weight) {
      const double area = weight / sum * piece.length;
      Share& share = shares[node];
      share.area += area;
      share.x += area * piece.normal_x;
      share.y += area * piece.normal_y;
    });
  }
  for (const auto& [node, share] : shares)
    if (std::hypot(share.x, share.y) < 0.5 * share.area)
      throw InputError(
          fmt::format("{}: a node sees two faces of the [interface] (allowed: layers of at least three cells)",
                      scene_.bodies[1].where));
  // What falls behind a wall belongs to the mirror image.
  for (const std::size_t normal : {1u, 0u})
    each_mirror(grid, scene_, normal, [&](const Mirror& m, Edge) {
      const auto found = shares.find(m.behind);
      if (found == shares.end()) return;
      const Share image = found->second;
      shares.erase(found);
      Share& share = shares[m.before];
      share.area += image.area;
      share.x += normal == 0 ? -image.x : image.x;
      share.y += normal == 1 ? -image.y : image.y;
    });
  for (const auto& [node, share] : shares) {
    const double length = std::hypot(share.x, share.y);
    if (length > 0.0)
      nodes_.push_back({.node = node, .area = share.area, .normal_x = share.x / length, .normal_y = share.y / length});
  }
}

double Joint::stiffness(std::size_t component, double jump) const {
  if (component == 1) return springs_->tangential;
  return jump < 0.0 ? springs_->compressive : springs_->normal;
}

void Joint::share_velocity(State& state) {
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

/// Calls visit(node, component, its difference of these values, reduced mass) for what the springs join, and gives both
/// bodies what it returns in place of that difference.
template <class Visit>
void Joint::each_difference(State& state, Array VelocityField::*values, Visit&& visit) {
  VelocityField &a = state.bodies[0].field, &b = state.bodies[1].field;
  for (Node& at : nodes_) {
    const double mass_a = a.mass[at.node], mass_b = b.mass[at.node];
    if (mass_a <= smallest_mass_ || mass_b <= smallest_mass_) continue;
    const double mass = mass_a * mass_b / (mass_a + mass_b);
    double *of_a = &(a.*values)[2 * at.node], *of_b = &(b.*values)[2 * at.node];
    for (std::size_t component = 0; component < 2; ++component) {
      const std::array<double, 2> way = at.along(component);
      const double difference = way[0] * (of_b[0] - of_a[0]) + way[1] * (of_b[1] - of_a[1]);
      const double lost = difference - visit(at, component, difference, mass);
      for (std::size_t i = 0; i < 2; ++i) {
        of_a[i] += mass / mass_a * lost * way[i];
        of_b[i] -= mass / mass_b * lost * way[i];
      }
    }
  }
}

void Joint::slow_parting(State& state) {
  each_difference(state, &VelocityField::velocity,
                  [&](Node& at, std::size_t component, double difference, double mass) {
                    const double spring = stiffness(component, at.jump[component]) * at.area;
                    at.keep[component] = 1.0 / (1.0 + spring * state.step * state.step / mass);
                    at.jump[component] += state.step * at.keep[component] * difference;
                    return at.keep[component] * difference;
                  });
}

void Joint::join(State& state) {
  if (!springs_) return share_velocity(state);
  // Springs that meet the piston askew lean on it: with the image of what it gives to its nodes.
  const auto momentum_at_piston = [&] {
    double sum = 0.0;
    each_mirror(state.grid, scene_, 0, [&](const Mirror& m, Edge edge) {
      if (edge != right) return;
      for (const Body& body : state.bodies)
        sum += (body.field.mass[m.before] - 2.0 * body.field.mass[m.behind]) * body.field.change[2 * m.before];
    });
    return sum;
  };
  const double before = momentum_at_piston();
  each_difference(state, &VelocityField::change, [&](Node& at, std::size_t component, double difference, double mass) {
    const double spring = stiffness(component, at.jump[component]) * at.area;
    return at.keep[component] * (difference - spring * state.step / mass * at.jump[component]);
  });
  state.piston.force += (momentum_at_piston() - before) / state.step;
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
