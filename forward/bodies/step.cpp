#include "forward/bodies/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "forward/bodies/conduction.hpp"
#include "forward/bodies/contact.hpp"
#include "forward/bodies/walls.hpp"
#include "forward/mpm/stencil.hpp"

namespace kerf::forward::bodies {
namespace {

using laws::BodyPoints;

BodyPoints load_points(const Points& p, std::size_t first) {
  BodyPoints points{.xx = load(&p.stress_xx[first]),
                    .yy = load(&p.stress_yy[first]),
                    .zz = load(&p.stress_zz[first]),
                    .xy = load(&p.stress_xy[first]),
                    .memory = {},
                    .temperature = {},
                    .heating = {}};
  for (std::size_t k = 0; k < p.memory.size(); ++k) points.memory[k] = load(&p.memory[k][first]);
  if (!p.temperature.empty()) points.temperature = load(&p.temperature[first]);
  return points;
}

void store_points(Points& p, std::size_t first, const BodyPoints& points) {
  store(&p.stress_xx[first], points.xx);
  store(&p.stress_yy[first], points.yy);
  store(&p.stress_zz[first], points.zz);
  store(&p.stress_xy[first], points.xy);
  for (std::size_t k = 0; k < p.memory.size(); ++k) store(&p.memory[k][first], points.memory[k]);
  if (!p.temperature.empty()) store(&p.temperature[first], points.temperature);
}

/// dx/dX of eight points, or a nominal stress.
struct Gradient {
  Lanes xx, xy, yx, yy;
  Gradient inverse() const {
    const Lanes one_over = 1.0 / (xx * yy - xy * yx);
    return {one_over * yy, -one_over * xy, -one_over * yx, one_over * xx};
  }
  Gradient transpose() const { return {xx, yx, xy, yy}; }
  Gradient operator*(const Gradient& b) const {
    return {xx * b.xx + xy * b.yx, xx * b.xy + xy * b.yy, yx * b.xx + yy * b.yx, yx * b.xy + yy * b.yy};
  }
};
Gradient load_gradient(const Points& p, std::size_t first) {
  return {load(&p.F_xx[first]), load(&p.F_xy[first]), load(&p.F_yx[first]), load(&p.F_yy[first])};
}
void store_gradient(Points& p, std::size_t first, const Gradient& F) {
  store(&p.F_xx[first], F.xx);
  store(&p.F_xy[first], F.xy);
  store(&p.F_yx[first], F.yx);
  store(&p.F_yy[first], F.yy);
}

/// Calls visit(law, points, first point) for every batch of a body.
template <class Visit>
void each_batch(const Body& body, Visit&& visit) {
  std::visit(
      [&](const auto& law) {
        for (std::size_t first = 0; first < body.points.size(); first += lane_count)
          visit(law, load_points(body.points, first), first);
      },
      body.law);
}

double density_of(const Body& body) {
  return std::visit([](const auto& law) { return law.mass_density(); }, body.law);
}

/// What a point gives to the nodes when its velocity has a gradient.
template <class Shape>
void add_affine_momentum(const Grid& grid, StencilOf<Shape> stencil, const Points& p, std::size_t first, Lanes mass,
                         VelocityField& field) {
  stencil.take_moments();
  const Lanes vx = load(&p.velocity_x[first]), vy = load(&p.velocity_y[first]);
  const Points::Affine& C = p.affine;
  const Lanes along = mass * grid.cell_x, up = mass * grid.cell_y;
  std::array<Lanes, 6> by_weight, by_moment;
  for (std::size_t i = 0; i < 3; ++i) {
    by_weight[2 * i] = stencil.weight_x[i] * mass * vx + stencil.slope_x[i] * along * load(&C.xx[first]);
    by_weight[2 * i + 1] = stencil.weight_x[i] * mass * vy + stencil.slope_x[i] * along * load(&C.yx[first]);
    by_moment[2 * i] = stencil.weight_x[i] * up * load(&C.xy[first]);
    by_moment[2 * i + 1] = stencil.weight_x[i] * up * load(&C.yy[first]);
  }
  stencil.add(field.momentum.data(), by_weight, by_moment);
  stencil.add_mass(field.mass.data(), mass);
}

/// Nodal velocities under the walls, of points' velocities that `velocity_of(stencil, first point)` tells.
template <bool is_affine, class Shape, class VelocityOf>
void gather(State& state, const Scene& scene, const Shape& shape, Body& body, const VelocityOf& velocity_of) {
  VelocityField& field = body.field;
  for (auto* values : {&field.mass, &field.momentum, &field.velocity}) std::fill(values->begin(), values->end(), 0.0);
  const Points& p = body.points;
  const std::vector<double>&x = p.kernel_x(frame_of(scene)), &y = p.kernel_y(frame_of(scene));
  const double density = density_of(body);
  for (std::size_t i = 0; i < p.size(); i += lane_count) {
    const StencilOf<Shape> stencil(state.grid, load(&x[i]), load(&y[i]), shape);
    const Lanes mass = density * load(&p.volume[i]);
    if constexpr (is_affine) {
      add_affine_momentum(state.grid, stencil, p, i, mass, field);
    } else {
      const std::array<Lanes, 2> velocity = velocity_of(stencil, i);
      stencil.add_momentum(field.momentum.data(), field.mass.data(), mass, velocity[0], velocity[1]);
    }
  }
  fold_momentum(state, scene, field);
  for (std::size_t node = 0; node < state.grid.nodes(); ++node)
    for (std::size_t k = 2 * node; k < 2 * node + 2; ++k)
      field.velocity[k] = field.mass[node] > 0.0 ? field.momentum[k] / field.mass[node] : 0.0;
}

template <class Transfer, class Shape>
void gather_momentum(State& state, const Scene& scene, const Shape& shape) {
  for (Body& body : state.bodies) {
    for (auto* values : {&body.field.change, &body.field.force}) std::fill(values->begin(), values->end(), 0.0);
    const Points& p = body.points;
    gather<Transfer::is_affine>(state, scene, shape, body, [&](const auto&, std::size_t i) {
      return std::array<Lanes, 2>{load(&p.velocity_x[i]), load(&p.velocity_y[i])};
    });
  }
}

/// The velocities that XPIC(m) takes, see effects/xpic.hpp. `share` gives bodies that are one their common velocity.
template <class Shape>
void filter_velocity(State& state, const Scene& scene, const Shape& shape, int order,
                     const std::function<void(State&)>& share) {
  std::vector<std::vector<double>> velocity, term;
  for (Body& body : state.bodies) {
    mirror_velocity(state, scene, body.field);
    mirror_change(state, scene, body.field);
    velocity.push_back(body.field.velocity);
    term.push_back(body.field.velocity);
    for (std::size_t k = 0; k < term.back().size(); ++k) term.back()[k] += body.field.change[k];
    body.field.filtered = term.back();
  }
  // Differences of velocities know walls that stand still.
  const double speed = state.piston.speed;
  for (int l = 1; l < order; ++l) {
    for (std::size_t b = 0; b < state.bodies.size(); ++b)
      gather<false>(state, scene, shape, state.bodies[b],
                    [&](const auto& stencil, std::size_t) { return stencil.sum(term[b].data()); });
    if (share) share(state);
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
      VelocityField& field = state.bodies[b].field;
      mirror_velocity(state, scene, field);
      for (std::size_t k = 0; k < term[b].size(); ++k) {
        term[b][k] -= field.velocity[k];
        field.filtered[k] += term[b][k];
      }
    }
    state.piston.speed = 0.0;
  }
  state.piston.speed = speed;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) state.bodies[b].field.velocity.swap(velocity[b]);
}

/// The heat of a step in which the deformation has changed the entropy by `configuration` at constant temperature:
/// dS = c d(ln T) + configuration. Without a bath dS = 0. With one the temperature decays to the bath's.
template <laws::ThermalLaw Law>
void exchange_heat(const Law& law, const Stroke& stroke, double step, Lanes configuration, Lanes volume,
                   BodyPoints& points, HeatBook& book) {
  const double c = law.heat_capacity();
  const Lanes before = points.temperature;
  points.temperature *= each_lane(configuration, [c](double ds) { return std::exp(-ds / c); });
  if (stroke.heat != Heat::isothermal) return;
  const double keep = stroke.exchange_time > 0.0 ? std::exp(-step / stroke.exchange_time) : 0.0;
  points.temperature = stroke.temperature + keep * (points.temperature - stroke.temperature);
  const Lanes entropy =
      configuration + c * each_lane(points.temperature / before, [](double ratio) { return std::log(ratio); });
  const double heat = sum(volume * 0.5 * (before + points.temperature) * entropy);
  book.heat += heat;
  book.entropy += heat / stroke.temperature;
}

/// Adds the internal forces of eight points. The stress that goes with gradients in X is the nominal one,
/// P = tau F^-T.
template <Frame frame, class Shape>
[[gnu::always_inline]] inline void add_forces(const Grid& grid, const StencilOf<Shape>& stencil, Lanes volume,
                                              const Gradient& tau, const Gradient& F, VelocityField& field) {
  const Gradient P = frame == Frame::current ? tau : tau * F.inverse().transpose();
  const Lanes along = -grid.inverse_cell_x * volume, across = -grid.inverse_cell_y * volume;
  std::array<Lanes, 6> by_weight, by_slope;
  for (std::size_t i = 0; i < 3; ++i) {
    by_weight[2 * i] = stencil.slope_x[i] * along * P.xx;
    by_weight[2 * i + 1] = stencil.slope_x[i] * along * P.yx;
    by_slope[2 * i] = stencil.weight_x[i] * across * P.xy;
    by_slope[2 * i + 1] = stencil.weight_x[i] * across * P.yy;
  }
  stencil.add(field.force.data(), by_weight, by_slope);
}

/// Deformation and stress after a time `step` with these nodal velocities; and, if asked, the internal forces.
template <Frame frame, bool with_forces, class Shape, class Law>
void strain_points(State& state, Body& body, const Law& law, const Stroke& stroke, const Shape& shape,
                   const std::vector<double>& velocity, double step) {
  Points& p = body.points;
  const Grid& grid = state.grid;
  const double strain_x = step * grid.inverse_cell_x, strain_y = step * grid.inverse_cell_y;
  bool sound = true;
  for (std::size_t first = 0; first < p.size(); first += lane_count) {
    const StencilOf<Shape> stencil(grid, load(&p.kernel_x(frame)[first]), load(&p.kernel_y(frame)[first]), shape);
    const auto [value, rise] = stencil.value_and_rise(velocity.data());
    Lanes xx{}, xy{}, yx{}, yy{};
    for (std::size_t i = 0; i < 3; ++i) {
      xx += stencil.slope_x[i] * value[2 * i];
      yx += stencil.slope_x[i] * value[2 * i + 1];
      xy += stencil.weight_x[i] * rise[2 * i];
      yy += stencil.weight_x[i] * rise[2 * i + 1];
    }
    const Gradient F = load_gradient(p, first);
    // dt dv/dX = dF, or dt dv/dx = l; dF = l F.
    const Gradient rate{strain_x * xx, strain_y * xy, strain_x * yx, strain_y * yy};
    const Gradient dF = frame == Frame::current ? rate * F : rate;
    const Gradient dx = frame == Frame::current ? rate : rate * F.inverse();
    const laws::StrainIncrement l{.xx = dx.xx, .xy = dx.xy, .yx = dx.yx, .yy = dx.yy};
    const Gradient now{F.xx + dF.xx, F.xy + dF.xy, F.yx + dF.yx, F.yy + dF.yy};
    store_gradient(p, first, now);
    const Lanes volume = load(&p.volume[first]);
    BodyPoints points = load_points(p, first);
    if constexpr (Law::is_thermal) {
      const Lanes before = law.configurational_entropy(points);
      law.deform(l, points);
      exchange_heat(law, stroke, step, law.configurational_entropy(points) - before, volume, points, state.bath);
      sound &= law.find_stress(points);
      points.temperature += points.heating / law.heat_capacity();
    } else {
      law.deform(l, points);
      sound &= law.find_stress(points);
    }
    store_points(p, first, points);
    if constexpr (with_forces)
      add_forces<frame>(grid, stencil, volume, {points.xx, points.xy, points.xy, points.yy}, now, body.field);
  }
  if (!sound && state.breakdown.empty())
    state.breakdown = "a body lost its volume, its temperature, or the return to its yield surface";
}

template <bool with_forces, class Shape>
void strain_body(State& state, const Scene& scene, Body& body, const Stroke& stroke, const Shape& shape,
                 const std::vector<double>& velocity, double step) {
  std::visit(
      [&](const auto& law) {
        if (frame_of(scene) == Frame::current)
          strain_points<Frame::current, with_forces>(state, body, law, stroke, shape, velocity, step);
        else
          strain_points<Frame::reference, with_forces>(state, body, law, stroke, shape, velocity, step);
      },
      body.law);
}

/// Internal forces of the stresses as they are.
template <Frame frame, class Shape>
void push_nodes(const State& state, Body& body, const Shape& shape) {
  const Points& p = body.points;
  for (std::size_t i = 0; i < p.size(); i += lane_count) {
    const Lanes xy = load(&p.stress_xy[i]);
    add_forces<frame>(
        state.grid, StencilOf<Shape>(state.grid, load(&p.kernel_x(frame)[i]), load(&p.kernel_y(frame)[i]), shape),
        load(&p.volume[i]), {load(&p.stress_xx[i]), xy, xy, load(&p.stress_yy[i])}, load_gradient(p, i), body.field);
  }
}

template <class Shape>
void weigh(State& state, const Scene& scene, const Shape& shape) {
  for (Body& body : state.bodies) {
    const Points& p = body.points;
    const std::vector<double>&x = p.kernel_x(frame_of(scene)), &y = p.kernel_y(frame_of(scene));
    const double density = std::visit([](const auto& law) { return law.mass_density(); }, body.law);
    for (std::size_t first = 0; first < p.size(); first += lane_count) {
      const StencilOf<Shape> stencil(state.grid, load(&x[first]), load(&y[first]), shape);
      const Lanes mass = density * load(&p.volume[first]);
      std::array<Lanes, 6> share;
      for (std::size_t i = 0; i < 3; ++i) {
        share[2 * i] = stencil.weight_x[i] * mass * scene.gravity->x;
        share[2 * i + 1] = stencil.weight_x[i] * mass * scene.gravity->y;
      }
      stencil.add(body.field.force.data(), share);
    }
  }
}

void change_velocity(State& state, const Scene& scene, VelocityField& field) {
  state.piston.force += fold_force(state, scene, field);
  for (std::size_t node = 0; node < state.grid.nodes(); ++node)
    for (std::size_t k = 2 * node; k < 2 * node + 2; ++k)
      field.change[k] = field.mass[node] > 0.0 ? state.step * field.force[k] / field.mass[node] : 0.0;
}

/// Per mass, of eight points whose velocity has the gradient C: 1/2 C D C^T.
Lanes affine_energy(const std::array<Lanes, 4>& C, Lanes spread_x, Lanes spread_y) {
  return 0.5 * ((C[0] * C[0] + C[2] * C[2]) * spread_x + (C[1] * C[1] + C[3] * C[3]) * spread_y);
}

/// C = D^-1 sum w_i v_i (x_i - x_p)^T, row by row, of a stencil that holds moments.
template <class Shape>
std::array<Lanes, 4> affine_part(const Grid& grid, const StencilOf<Shape>& moments, const std::array<Lanes, 2>& spread,
                                 const std::vector<double>& nodal) {
  const auto [value, rise] = moments.value_and_rise(nodal.data());
  std::array<Lanes, 4> C{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      C[2 * k] += moments.slope_x[i] * value[2 * i + k];
      C[2 * k + 1] += moments.weight_x[i] * rise[2 * i + k];
    }
  // A linear shape function knows no gradient on a node.
  const auto over = [](Lanes a, Lanes b) { return b > 1e-9 ? a / (b > 1e-9 ? b : all_lanes(1.0)) : Lanes{}; };
  for (std::size_t k = 0; k < 2; ++k) {
    C[2 * k] = over(C[2 * k], spread[0]) * grid.inverse_cell_x;
    C[2 * k + 1] = over(C[2 * k + 1], spread[1]) * grid.inverse_cell_y;
  }
  return C;
}

/// Gives the points their gradients; returns the energy per mass that they would have had with the changes alone, less
/// what they have.
template <class Shape>
Lanes take_affine(const Grid& grid, StencilOf<Shape> stencil, const VelocityField& field, Points::Affine& to,
                  std::size_t first) {
  const std::array<Lanes, 2> spread = stencil.take_moments();
  const std::array<Lanes, 4> old = affine_part(grid, stencil, spread, field.velocity);
  const std::array<Lanes, 4> change = affine_part(grid, stencil, spread, field.change);
  const std::array<std::vector<double>*, 4> values{&to.xx, &to.xy, &to.yx, &to.yy};
  std::array<Lanes, 4> before, now;
  for (std::size_t k = 0; k < 4; ++k) {
    before[k] = load(&(*values[k])[first]) + change[k];
    now[k] = old[k] + change[k];
    store(&(*values[k])[first], now[k]);
  }
  const Lanes spread_x = grid.cell_x * grid.cell_x * spread[0], spread_y = grid.cell_y * grid.cell_y * spread[1];
  store(&to.spread_x[first], spread_x);
  store(&to.spread_y[first], spread_y);
  return affine_energy(before, spread_x, spread_y) - affine_energy(now, spread_x, spread_y);
}

template <class Transfer, class Shape>
void move_points(State& state, const Scene& scene, Body& body, const Shape& shape) {
  constexpr bool is_flip = std::is_same_v<Transfer, Flip>;
  Points& p = body.points;
  const Frame frame = frame_of(scene);
  const std::vector<double>&kernel_x = p.kernel_x(frame), &kernel_y = p.kernel_y(frame);
  const double dt = state.step;
  const double rate = scene.pic_damping ? 1.0 - std::exp(-scene.pic_damping->rate * scene.courant_number) : 0.0;
  const double density = density_of(body);
  Lanes lost{};
  for (std::size_t first = 0; first < p.size(); first += lane_count) {
    const Lanes x = load(&p.x[first]), y = load(&p.y[first]);
    const StencilOf<Shape> stencil(state.grid, load(&kernel_x[first]), load(&kernel_y[first]), shape);
    const auto [old_x, old_y] = stencil.sum(body.field.velocity.data());
    const auto [change_x, change_y] = stencil.sum(body.field.change.data());
    const Lanes move_x = old_x + change_x, move_y = old_y + change_y;
    Lanes vx = load(&p.velocity_x[first]) + change_x, vy = load(&p.velocity_y[first]) + change_y;
    if (!is_flip || rate > 0.0) {
      const Lanes flip_x = vx, flip_y = vy, mass = density * load(&p.volume[first]);
      if constexpr (is_flip) {
        vx += rate * (move_x - vx);
        vy += rate * (move_y - vy);
      } else if constexpr (Transfer::filters) {
        const auto [filtered_x, filtered_y] = stencil.sum(body.field.filtered.data());
        vx = filtered_x;
        vy = filtered_y;
      } else {
        vx = move_x;
        vy = move_y;
      }
      lost += 0.5 * mass * (flip_x * flip_x + flip_y * flip_y - vx * vx - vy * vy);
      if constexpr (Transfer::is_affine) lost += mass * take_affine(state.grid, stencil, body.field, p.affine, first);
    }
    store(&p.velocity_x[first], vx);
    store(&p.velocity_y[first], vy);
    store(&p.x[first], x + dt * move_x);
    store(&p.y[first], y + dt * move_y);
  }
  state.damping += sum(lost);
}

}  // namespace

void find_stress(State& state) {
  for (Body& body : state.bodies)
    each_batch(body, [&](const auto& law, BodyPoints points, std::size_t first) {
      if (!law.find_stress(points)) state.breakdown = "a body has no stress where it starts";
      store_points(body.points, first, points);
    });
}

namespace {

template <class Shape, class Transfer>
std::vector<Stage> plan_with(const Shape& shape, const Transfer& transfer, const Scene& scene, Joint& joint) {
  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::string does, std::function<void(State&, const Stroke&)> apply) {
    stages.push_back({std::move(name), std::move(does), std::move(apply)});
  };
  const bool is_current = frame_of(scene) == Frame::current;
  const bool bonded = scene.bodies.size() > 1 && !scene.contact;
  const StressUpdate update = scene.numerics.stress_update;
  const auto add_projection = [&] {
    add("project",
        fmt::format("grid velocities p/m of every body under the walls, in the {} configuration",
                    is_current ? "current" : "reference"),
        [&scene, shape](State& state, const Stroke&) { gather_momentum<Transfer>(state, scene, shape); });
    if (scene.contact)
      add("meet", "where bodies touch, along which normal; strains see no surfaces that approach",
          [&scene](State& state, const Stroke&) { meet(state, scene); });
    else if (bonded)
      add("share", scene.interface ? "the interface slows what parts the bodies" : "bodies share one velocity",
          [&joint](State& state, const Stroke&) { joint.share_velocity(state); });
  };
  const std::string strains =
      scene.is_thermal() ? "deformation, heat of the stroke, temperature, stress" : "deformation, stress";
  const auto add_strain = [&]<bool with_forces>(double share, std::bool_constant<with_forces>) {
    add("strain", (share < 1.0 ? "for half a step: " : "") + strains + (with_forces ? ", internal forces" : ""),
        [&scene, shape, share](State& state, const Stroke& stroke) {
          for (Body& body : state.bodies) {
            mirror_velocity(state, scene, body.field);
            strain_body<with_forces>(state, scene, body, stroke, shape, body.field.velocity, share * state.step);
          }
        });
  };
  const double each_time = update == StressUpdate::average ? 0.5 : 1.0;

  add_projection();
  if (update == StressUpdate::first || update == StressUpdate::average)
    add_strain(each_time, std::true_type());
  else
    add("push", "internal forces", [&scene, shape](State& state, const Stroke&) {
      for (Body& body : state.bodies) {
        mirror_velocity(state, scene, body.field);
        if (frame_of(scene) == Frame::current)
          push_nodes<Frame::current>(state, body, shape);
        else
          push_nodes<Frame::reference>(state, body, shape);
      }
    });
  if (scene.gravity)
    add("gravity", "weight of every body",
        [&scene, shape](State& state, const Stroke&) { weigh(state, scene, shape); });
  if (scene.conduction)
    add("conduct", "heat flows down the temperature's gradient and through walls that have a temperature",
        [conductor = Conductor(scene)](State& state, const Stroke&) mutable { conductor(state); });
  add("accelerate", "changes of the grid velocities under the walls, and the piston's force",
      [&scene](State& state, const Stroke&) {
        state.piston.force = 0.0;
        for (Body& body : state.bodies) change_velocity(state, scene, body.field);
      });
  if (scene.contact)
    add("touch",
        scene.contact->friction > 0.0 ? "normal impulses and Coulomb friction between bodies that touch"
                                      : "normal impulses between bodies that touch",
        [&scene](State& state, const Stroke&) { touch(state, scene); });
  if (friction_warms(scene))
    add("warm", "heat of friction warms the bodies that rub",
        [&scene](State& state, const Stroke&) { warm_by_friction(state, scene); });
  if (bonded)
    add("join", scene.interface ? "springs of the interface" : "bodies share one change of velocity",
        [&joint](State& state, const Stroke&) { joint.join(state); });
  if (update == StressUpdate::last)
    add("strain", strains + ", with the velocities at the end of the step",
        [&scene, shape](State& state, const Stroke& stroke) {
          for (Body& body : state.bodies) {
            VelocityField& field = body.field;
            mirror_change(state, scene, field);
            field.filtered = field.velocity;
            for (std::size_t k = 0; k < field.filtered.size(); ++k) field.filtered[k] += field.change[k];
            strain_body<false>(state, scene, body, stroke, shape, field.filtered, state.step);
          }
        });
  if constexpr (Transfer::filters) {
    std::function<void(State&)> share;
    if (bonded && !scene.interface) share = [&joint](State& state) { joint.share_velocity(state); };
    add("filter", fmt::format("what XPIC({}) takes from the nodes", transfer.order),
        [&scene, shape, share, order = transfer.order](State& state, const Stroke&) {
          filter_velocity(state, scene, shape, order, share);
        });
  }
  add("advance",
      fmt::format("points move ({}{})", transfer.name,
                  scene.pic_damping ? " with a share of PIC, booked as damping" : ""),
      [&scene, shape](State& state, const Stroke&) {
        for (Body& body : state.bodies) {
          mirror_change(state, scene, body.field);
          move_points<Transfer>(state, scene, body, shape);
        }
      });
  if (update == StressUpdate::last_gathered || update == StressUpdate::average) {
    add_projection();
    add_strain(each_time, std::false_type());
  }
  if (!scene.rigids.empty())
    add("push", "rigid bodies move", [&scene](State& state, const Stroke&) { move_rigids(state, scene); });
  add("piston", "the piston moves and its work is booked", [](State& state, const Stroke&) {
    state.piston.work += state.piston.force * state.piston.speed * state.step;
    state.piston.position += state.piston.speed * state.step;
    state.time += state.step;
  });
  return stages;
}

}  // namespace

std::vector<Stage> plan(const Scene& scene, Joint& joint) {
  return std::visit([&](const auto& shape, const auto& transfer) { return plan_with(shape, transfer, scene, joint); },
                    scene.numerics.shape, scene.numerics.transfer);
}

double stable_step(const State& state, const Scene& scene) {
  double most = 0.0;  // transits of a cell per second
  for (const Body& body : state.bodies)
    each_batch(body, [&](const auto& law, const BodyPoints& points, std::size_t first) {
      Lanes speed = law.wave_speed(points) + std::abs(state.piston.speed);
      Lanes along = all_lanes(state.grid.inverse_cell_x), across = all_lanes(state.grid.inverse_cell_y);
      if (frame_of(scene) == Frame::current) {
        const Lanes vx = load(&body.points.velocity_x[first]), vy = load(&body.points.velocity_y[first]);
        speed += sqrt(vx * vx + vy * vy);
      } else {
        const Gradient F = load_gradient(body.points, first);
        along /= sqrt(F.xx * F.xx + F.yx * F.yx);
        across /= sqrt(F.xy * F.xy + F.yy * F.yy);
      }
      const Lanes transits = speed * (along > across ? along : across);
      for (std::size_t i = 0; i < lane_count; ++i) most = std::max(most, transits[i]);
    });
  const double step = scene.courant_number / most;
  return scene.conduction ? std::min(step, longest_conduction_step(state, scene)) : step;
}

namespace {

/// What gradients of the points' velocities add.
void add_affine_part(const Points& p, std::size_t first, Lanes mass, Frame frame, Totals& all) {
  const std::array<Lanes, 4> C{load(&p.affine.xx[first]), load(&p.affine.xy[first]), load(&p.affine.yx[first]),
                               load(&p.affine.yy[first])};
  const Lanes spread_x = load(&p.affine.spread_x[first]), spread_y = load(&p.affine.spread_y[first]);
  all.kinetic += sum(mass * affine_energy(C, spread_x, spread_y));
  const Gradient F =
      frame == Frame::current ? Gradient{all_lanes(1.0), {}, {}, all_lanes(1.0)} : load_gradient(p, first);
  all.angular_momentum += sum(mass * ((F.xx * C[2] - F.yx * C[0]) * spread_x + (F.xy * C[3] - F.yy * C[1]) * spread_y));
}

}  // namespace

Totals totals(const State& state) {
  Totals all;
  double heated = 0.0;
  for (const Body& body : state.bodies) {
    const Points& p = body.points;
    each_batch(body, [&](const auto& law, const BodyPoints& points, std::size_t first) {
      const Lanes volume = load(&p.volume[first]), vx = load(&p.velocity_x[first]), vy = load(&p.velocity_y[first]);
      all.volume += sum(volume);
      all.mass += law.mass_density() * sum(volume);
      all.momentum_x += law.mass_density() * sum(volume * vx);
      all.momentum_y += law.mass_density() * sum(volume * vy);
      const Lanes x = load(&p.x[first]), y = load(&p.y[first]);
      all.moment_x += law.mass_density() * sum(volume * x);
      all.moment_y += law.mass_density() * sum(volume * y);
      all.angular_momentum += law.mass_density() * sum(volume * (x * vy - y * vx));
      all.kinetic += 0.5 * law.mass_density() * sum(volume * (vx * vx + vy * vy));
      if (!p.affine.xx.empty()) add_affine_part(p, first, law.mass_density() * volume, state.frame, all);
      all.internal += sum(volume * law.energy(points));
      all.stress_xx += sum(volume * points.xx);
      all.stress_yy += sum(volume * points.yy);
      if constexpr (std::decay_t<decltype(law)>::is_thermal) {
        heated += sum(volume);
        all.temperature += sum(volume * points.temperature);
        if constexpr (requires { law.plastic_work(points); })
          all.plastic_work += sum(volume * law.plastic_work(points));
        const Lanes thermal = each_lane(points.temperature, [](double T) { return std::log(T); });
        all.entropy += sum(volume * (law.heat_capacity() * thermal + law.configurational_entropy(points)));
      }
    });
  }
  all.stress_xx /= all.volume;
  all.stress_yy /= all.volume;
  if (heated > 0.0) all.temperature /= heated;
  return all;
}

}  // namespace kerf::forward::bodies
