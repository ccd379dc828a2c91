#include "forward/bodies/contact.hpp"

#include <algorithm>
#include <cmath>

#include "forward/bodies/walls.hpp"
#include "forward/mpm/bspline.hpp"
#include "forward/mpm/stencil.hpp"

namespace kerf::forward::bodies {
namespace {

/// What the nodes see of points with these volumes, and of a vector (in_x, in_y) at each.
class Look {
 public:
  Look(const Grid& grid, Presence& presence) : grid_(grid), presence_(presence) {
    presence.volume.assign(grid.nodes() + lane_count, 0.0);
    for (auto* values : {&presence.gradient, &presence.moment}) values->assign(2 * grid.nodes() + lane_count, 0.0);
  }
  void add(Lanes x, Lanes y, Lanes volume, Lanes in_x, Lanes in_y) {
    const Stencil stencil(grid_, x, y);
    stencil.add_momentum(presence_.moment.data(), presence_.volume.data(), volume, in_x, in_y);
    const Lanes along = volume * grid_.inverse_cell_x, up = volume * grid_.inverse_cell_y;
    std::array<Lanes, 6> by_weight{}, by_slope{};
    for (std::size_t i = 0; i < 3; ++i) {
      by_weight[2 * i] = stencil.slope_x[i] * along;
      by_slope[2 * i + 1] = stencil.weight_x[i] * up;
    }
    stencil.add(presence_.gradient.data(), by_weight, by_slope);
  }

 private:
  const Grid& grid_;
  Presence& presence_;
};

/// What lies behind a wall counts as its image before it.
void fold(const Grid& grid, const Scene& scene, Presence& presence) {
  for (const std::size_t normal : {1u, 0u}) {
    const std::size_t tangent = 1 - normal;
    each_mirror(grid, scene, normal, [&](const Mirror& m, Edge) {
      presence.volume[m.before] += presence.volume[m.behind];
      presence.volume[m.behind] = 0.0;
      for (auto* vectors : {&presence.gradient, &presence.moment}) {
        double *before = &(*vectors)[2 * m.before], *behind = &(*vectors)[2 * m.behind];
        before[normal] -= behind[normal];
        before[tangent] += behind[tangent];
        behind[0] = behind[1] = 0.0;
      }
    });
  }
}

void look(State& state, const Scene& scene) {
  const Grid& grid = state.grid;
  ContactState& contact = state.contact;
  const bool moved = scene.contact->overlap == Overlap::displacement;
  contact.presence.resize(state.bodies.size() + contact.rigids.size());
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const Points& p = state.bodies[b].points;
    Look seen(grid, contact.presence[b]);
    for (std::size_t i = 0; i < p.size(); i += lane_count) {
      const Lanes x = load(&p.x[i]), y = load(&p.y[i]);
      const Lanes J = load(&p.F_xx[i]) * load(&p.F_yy[i]) - load(&p.F_xy[i]) * load(&p.F_yx[i]);
      if (any((x < 0.0) | (x > scene.length) | (y < 0.0) | (y > scene.height))) state.breakdown = "a body left the box";
      seen.add(x, y, J * load(&p.volume[i]), moved ? x - load(&p.reference_x[i]) : x,
               moved ? y - load(&p.reference_y[i]) : y);
    }
  }
  for (std::size_t r = 0; r < contact.rigids.size(); ++r) {
    const RigidBody& rigid = contact.rigids[r];
    Look seen(grid, contact.presence[state.bodies.size() + r]);
    for (std::size_t i = 0; i < rigid.x.size(); i += lane_count) {
      const Lanes x = load(&rigid.x[i]), y = load(&rigid.y[i]);
      seen.add(x, y, load(&rigid.volume[i]), moved ? all_lanes(rigid.moved_x) : x,
               moved ? all_lanes(rigid.moved_y) : y);
    }
  }
  for (Presence& presence : contact.presence) {
    if (!moved)  // positions are seen from the node
      for (int j = 0; j < grid.rows; ++j)
        for (int i = 0; i < grid.columns; ++i) {
          const std::size_t node = grid.node(i, j);
          presence.moment[2 * node] -= presence.volume[node] * (grid.origin_x + i * grid.cell_x);
          presence.moment[2 * node + 1] -= presence.volume[node] * (grid.origin_y + j * grid.cell_y);
        }
    fold(grid, scene, presence);
  }
}

/// Do these two touch at this node, and with which normal?
std::optional<Touch> find_touch(const State& state, const Scene& scene, std::size_t node, std::size_t a,
                                std::size_t b) {
  const Contact& contact = *scene.contact;
  const Grid& grid = state.grid;
  const Presence &of_a = state.contact.presence[a], &of_b = state.contact.presence[b];
  const double volume_a = of_a.volume[node], volume_b = of_b.volume[node], cell = grid.cell_x * grid.cell_y;
  constexpr double nothing = 1e-9;  // of a cell
  if (volume_a < nothing * cell || volume_b < nothing * cell) return {};
  if (volume_a + volume_b < contact.screening * cell) return {};
  const std::size_t x = 2 * node, y = 2 * node + 1;
  // A kernel grows towards its node: these point out of a, and into b.
  const double ax = of_a.gradient[x], ay = of_a.gradient[y], bx = -of_b.gradient[x], by = -of_b.gradient[y];
  // Further away than about a cell a surface is lost in the ripple that points give to the volume of a full cell.
  constexpr double ripple = 0.1;  // times a cell's volume over its side
  const double least = ripple * std::sqrt(cell);
  if (std::hypot(ax, ay) < least || std::hypot(bx, by) < least) return {};
  double nx = 0, ny = 0;
  switch (contact.normal) {
    case Normal::largest_gradient:
      if (ax * ax + ay * ay > bx * bx + by * by) {
        nx = ax;
        ny = ay;
      } else {
        nx = bx;
        ny = by;
      }
      break;
    case Normal::mean_gradient:
      nx = volume_a * ax + volume_b * bx;
      ny = volume_a * ay + volume_b * by;
      break;
    case Normal::specified: {
      const double way = std::copysign(1.0, contact.normal_x * (ax + bx) + contact.normal_y * (ay + by));
      nx = way * contact.normal_x;
      ny = way * contact.normal_y;
    }
  }
  const double length = std::hypot(nx, ny);
  if (!(length > 0.0)) return {};
  nx /= length;
  ny /= length;
  // Both surfaces face along the normal, or it belongs to another side of one of them.
  constexpr double least_cosine = 0.95;
  if (ax * nx + ay * ny < least_cosine * std::hypot(ax, ay) || bx * nx + by * ny < least_cosine * std::hypot(bx, by))
    return {};
  if (contact.overlap != Overlap::off) {
    const double gap = nx * (of_b.moment[x] / volume_b - of_a.moment[x] / volume_a) +
                       ny * (of_b.moment[y] / volume_b - of_a.moment[y] / volume_a);
    const double allowance =
        contact.overlap == Overlap::position
            ? std::hypot(nx * grid.cell_x, ny * grid.cell_y) *
                  distance_at_touch(volume_a / (volume_a + volume_b), scene.particles_per_cell_side)
            : 0.0;
    if (gap >= allowance) return {};
  }
  return Touch{node, a, b, nx, ny};
}

/// A body at a node, as a contact acts on it. A rigid one has a velocity and no inverse mass.
struct Side {
  RigidBody* rigid = nullptr;
  VelocityField* field = nullptr;
  std::size_t node = 0;
  double inverse_mass = 0;

  Side(State& state, std::size_t index, std::size_t at) : node(at) {
    if (index >= state.bodies.size()) {
      rigid = &state.contact.rigids[index - state.bodies.size()];
      return;
    }
    field = &state.bodies[index].field;
    if (field->mass[node] > 0.0) inverse_mass = 1.0 / field->mass[node];
  }
  Place velocity() const {
    return rigid ? Place{rigid->velocity_x, rigid->velocity_y}
                 : Place{field->velocity[2 * node], field->velocity[2 * node + 1]};
  }
  Place change() const { return rigid ? Place{0, 0} : Place{field->change[2 * node], field->change[2 * node + 1]}; }
  void push(double x, double y) {
    if (rigid) return;
    field->change[2 * node] += inverse_mass * x;
    field->change[2 * node + 1] += inverse_mass * y;
  }
};

/// On b; normal positive where it presses.
struct Impulse {
  double normal = 0, x = 0, y = 0;  ///< x, y: along the surface
};

/// What ends the approach, and the sliding as far as friction can, of two sides whose velocities differ by w.
Impulse impulse_of(const Contact& contact, const Touch& at, double mass, const Place& w) {
  const double approach = -(w.x * at.normal_x + w.y * at.normal_y);
  if (contact.approach && approach <= 0.0) return {};
  Impulse impulse{.normal = mass * approach};
  if (contact.friction == 0.0) return impulse;
  impulse.x = -mass * (w.x + approach * at.normal_x);
  impulse.y = -mass * (w.y + approach * at.normal_y);
  const double stick = std::hypot(impulse.x, impulse.y), slip = contact.friction * std::max(impulse.normal, 0.0);
  if (stick > slip) {
    impulse.x *= slip / stick;
    impulse.y *= slip / stick;
  }
  return impulse;
}

/// Gives the changes of the nodal velocities the impulses that contact asks for, and books them.
void exchange_impulses(State& state, const Scene& scene) {
  ContactState& contact = state.contact;
  for (const Touch& at : contact.touches) {
    Side a(state, at.a, at.node), b(state, at.b, at.node);
    const double inverse = a.inverse_mass + b.inverse_mass;
    if (!(inverse > 0.0)) continue;
    const Place va = a.velocity(), vb = b.velocity(), ca = a.change(), cb = b.change();
    const Place before{vb.x - va.x, vb.y - va.y};
    const Impulse impulse =
        impulse_of(*scene.contact, at, 1.0 / inverse, {before.x + cb.x - ca.x, before.y + cb.y - ca.y});
    const double x = impulse.normal * at.normal_x + impulse.x, y = impulse.normal * at.normal_y + impulse.y;
    a.push(-x, -y);
    b.push(x, y);
    // An impulse works with the mean of the velocities before and after the change that it is part of.
    const Place after_a = a.change(), after_b = b.change();
    const double mean_x = before.x + 0.5 * (after_b.x - after_a.x), mean_y = before.y + 0.5 * (after_b.y - after_a.y);
    const double heat = -(impulse.x * mean_x + impulse.y * mean_y);
    contact.friction_heat += heat;
    if (!contact.heat.empty()) {
      const bool into_a = state.bodies[at.a].is_thermal();
      const bool into_b = at.b < state.bodies.size() && state.bodies[at.b].is_thermal();
      const double share = into_a && into_b ? 0.5 : 1.0;
      if (into_a) contact.heat[at.a][at.node] += share * heat;
      if (into_b) contact.heat[at.b][at.node] += share * heat;
      if (into_a || into_b) contact.warmed += heat;
    }
    contact.impact -= impulse.normal * (at.normal_x * mean_x + at.normal_y * mean_y);
    if (!b.rigid || state.bodies.size() == 1) contact.pressed.impulse[at.node] += impulse.normal;
    if (!b.rigid) continue;
    b.rigid->force_x -= x / state.step;
    b.rigid->force_y -= y / state.step;
    contact.rigid_work -= x * b.rigid->velocity_x + y * b.rigid->velocity_y;
  }
}

}  // namespace

double distance_at_touch(double share, int points_per_cell) {
  // A plane at s (in cells) from the node; on either side points of spacing 1/n begin half a spacing from it.
  constexpr int size = 96;
  struct Table {
    std::array<double, size + 1> share, distance;
    explicit Table(int n) {
      const auto kernel = [](double x) {
        const double r = std::abs(x);
        return r < 0.5 ? 0.75 - r * r : r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0.0;
      };
      const double gap = 1.0 / n;
      for (std::size_t k = 0; k <= size; ++k) {
        const double s = (1.5 - 0.5 * gap) * (1.0 - static_cast<double>(k) / size);
        double near = 0, near_moment = 0, far = 0, far_moment = 0;
        for (int i = 0; i <= 2 * n; ++i) {
          const double x = s + (i + 0.5) * gap;
          far += kernel(x);
          far_moment += x * kernel(x);
        }
        for (int i = 0; i <= 4 * n; ++i) {
          const double x = s - (i + 0.5) * gap;
          near += kernel(x);
          near_moment += x * kernel(x);
        }
        share[k] = far / (near + far);
        distance[k] = far > 0.0 ? far_moment / far - near_moment / near : 1.5;
      }
    }
  };
  static const std::array<Table, 4> tables{Table(1), Table(2), Table(3), Table(4)};
  const Table& table = tables.at(static_cast<std::size_t>(points_per_cell - 1));
  const double q = std::clamp(std::min(share, 1.0 - share), 0.0, 0.5);
  const auto above = std::upper_bound(table.share.begin() + 1, table.share.end() - 1, q);
  const auto k = static_cast<std::size_t>(above - table.share.begin());
  const double t = (q - table.share[k - 1]) / (table.share[k] - table.share[k - 1]);
  return table.distance[k - 1] + t * (table.distance[k] - table.distance[k - 1]);
}

void meet(State& state, const Scene& scene) {
  look(state, scene);
  ContactState& contact = state.contact;
  contact.touches.clear();
  const std::size_t deforming = state.bodies.size();
  for (std::size_t node = 0; node < state.grid.nodes(); ++node)
    for (std::size_t a = 0; a < deforming; ++a)
      for (std::size_t b = a + 1; b < contact.presence.size(); ++b)
        if (const std::optional<Touch> found = find_touch(state, scene, node, a, b)) contact.touches.push_back(*found);
  contact.velocity.resize(deforming);
  for (std::size_t b = 0; b < deforming; ++b) contact.velocity[b] = state.bodies[b].field.velocity;
  for (RigidBody& rigid : contact.rigids) rigid.force_x = rigid.force_y = 0.0;
  contact.pressed.impulse.resize(state.grid.nodes(), 0.0);
  if (friction_warms(scene)) {
    contact.heat.resize(deforming);
    for (Array& heat : contact.heat) heat.assign(state.grid.nodes(), 0.0);
  }
  exchange_impulses(state, scene);
  for (Body& body : state.bodies)
    for (std::size_t k = 0; k < 2 * state.grid.nodes(); ++k) body.field.velocity[k] += body.field.change[k];
}

void touch(State& state, const Scene& scene) {
  exchange_impulses(state, scene);
  // What `meet` took counts as part of the step's change.
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    VelocityField& field = state.bodies[b].field;
    for (std::size_t k = 0; k < 2 * state.grid.nodes(); ++k)
      field.change[k] += field.velocity[k] - state.contact.velocity[b][k];
    field.velocity = state.contact.velocity[b];
    mirror_velocity(state, scene, field);
  }
}

bool friction_warms(const Scene& scene) {
  return scene.contact && scene.contact->friction > 0.0 && scene.is_thermal();
}

void warm_by_friction(State& state, const Scene& scene) {
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    Body& body = state.bodies[b];
    if (!body.is_thermal()) continue;
    const double density = std::visit([](const auto& law) { return law.mass_density(); }, body.law);
    const double specific_heat = laws::heat_capacity(body.law) / density;
    Array& rise = state.contact.heat[b];
    for (std::size_t node = 0; node < state.grid.nodes(); ++node)
      if (rise[node] != 0.0) rise[node] /= specific_heat * body.field.mass[node];
    for (const std::size_t normal : {0u, 1u})
      each_mirror(state.grid, scene, normal, [&](const Mirror& m, Edge) { rise[m.behind] = rise[m.before]; });
    Points& p = body.points;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Spline along(state.grid.column_of(p.x[i])), up(state.grid.row_of(p.y[i]));
      for (int m = 0; m < 3; ++m)
        for (int n = 0; n < 3; ++n)
          p.temperature[i] += along.weight(n) * up.weight(m) * rise[state.grid.node(along.base + n, up.base + m)];
    }
  }
}

void move_rigids(State& state, const Scene& scene) {
  for (std::size_t r = 0; r < state.contact.rigids.size(); ++r) {
    RigidBody& rigid = state.contact.rigids[r];
    const RigidPlan& plan = scene.rigids[r];
    const double dx = state.step * rigid.velocity_x, dy = state.step * rigid.velocity_y;
    for (double& x : rigid.x) x += dx;
    for (double& y : rigid.y) y += dy;
    rigid.moved_x += dx;
    rigid.moved_y += dy;
    const double wanted = state.time + state.step < plan.stop ? 1.0 : 0.0;
    const double towards = plan.ramp > 0.0 ? 1.0 - std::exp(-state.step / plan.ramp) : 1.0;
    rigid.velocity_x += towards * (wanted * plan.velocity_x - rigid.velocity_x);
    rigid.velocity_y += towards * (wanted * plan.velocity_y - rigid.velocity_y);
  }
}

}  // namespace kerf::forward::bodies
