#include "forward/bodies/step.hpp"

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

void gather_momentum(State& state, const Scene& scene) {
  for (Body& body : state.bodies) {
    VelocityField& field = body.field;
    for (auto* values : {&field.mass, &field.momentum, &field.velocity, &field.change, &field.force})
      std::fill(values->begin(), values->end(), 0.0);
    const Points& p = body.points;
    const std::vector<double>&x = p.kernel_x(frame_of(scene)), &y = p.kernel_y(frame_of(scene));
    const double density = std::visit([](const auto& law) { return law.mass_density(); }, body.law);
    for (std::size_t i = 0; i < p.size(); i += lane_count)
      Stencil(state.grid, load(&x[i]), load(&y[i]))
          .add_momentum(field.momentum.data(), field.mass.data(), density * load(&p.volume[i]), load(&p.velocity_x[i]),
                        load(&p.velocity_y[i]));
    fold_momentum(state, scene, field);
    for (std::size_t node = 0; node < state.grid.nodes(); ++node)
      for (std::size_t k = 2 * node; k < 2 * node + 2; ++k)
        field.velocity[k] = field.mass[node] > 0.0 ? field.momentum[k] / field.mass[node] : 0.0;
  }
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

template <Frame frame, class Law>
void strain_points(State& state, Body& body, const Law& law, const Stroke& stroke) {
  Points& p = body.points;
  const Grid& grid = state.grid;
  const double strain_x = state.step * grid.inverse_cell_x, strain_y = state.step * grid.inverse_cell_y;
  bool sound = true;
  for (std::size_t first = 0; first < p.size(); first += lane_count) {
    const Stencil stencil(grid, load(&p.kernel_x(frame)[first]), load(&p.kernel_y(frame)[first]));
    const auto [value, rise] = stencil.value_and_rise(body.field.velocity.data());
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
      exchange_heat(law, stroke, state.step, law.configurational_entropy(points) - before, volume, points, state.bath);
      sound &= law.find_stress(points);
      points.temperature += points.heating / law.heat_capacity();
    } else {
      law.deform(l, points);
      sound &= law.find_stress(points);
    }
    store_points(p, first, points);
    // The stress that goes with gradients in X is the nominal one, P = tau F^-T.
    const Gradient tau{points.xx, points.xy, points.xy, points.yy};
    const Gradient P = frame == Frame::current ? tau : tau * now.inverse().transpose();
    const Lanes along = -grid.inverse_cell_x * volume, across = -grid.inverse_cell_y * volume;
    std::array<Lanes, 6> by_weight, by_slope;
    for (std::size_t i = 0; i < 3; ++i) {
      by_weight[2 * i] = stencil.slope_x[i] * along * P.xx;
      by_weight[2 * i + 1] = stencil.slope_x[i] * along * P.yx;
      by_slope[2 * i] = stencil.weight_x[i] * across * P.xy;
      by_slope[2 * i + 1] = stencil.weight_x[i] * across * P.yy;
    }
    stencil.add(body.field.force.data(), by_weight, by_slope);
  }
  if (!sound && state.breakdown.empty())
    state.breakdown = "a body lost its volume, its temperature, or the return to its yield surface";
}

void weigh(State& state, const Scene& scene) {
  for (Body& body : state.bodies) {
    const Points& p = body.points;
    const std::vector<double>&x = p.kernel_x(frame_of(scene)), &y = p.kernel_y(frame_of(scene));
    const double density = std::visit([](const auto& law) { return law.mass_density(); }, body.law);
    for (std::size_t first = 0; first < p.size(); first += lane_count) {
      const Stencil stencil(state.grid, load(&x[first]), load(&y[first]));
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

void move_points(State& state, const Scene& scene, Body& body) {
  Points& p = body.points;
  const Frame frame = frame_of(scene);
  const std::vector<double>&kernel_x = p.kernel_x(frame), &kernel_y = p.kernel_y(frame);
  const double dt = state.step;
  const double rate = scene.pic_damping ? 1.0 - std::exp(-scene.pic_damping->rate * scene.courant_number) : 0.0;
  const double density = std::visit([](const auto& law) { return law.mass_density(); }, body.law);
  Lanes lost{};
  for (std::size_t first = 0; first < p.size(); first += lane_count) {
    const Lanes x = load(&p.x[first]), y = load(&p.y[first]);
    const Stencil stencil(state.grid, load(&kernel_x[first]), load(&kernel_y[first]));
    const auto [old_x, old_y] = stencil.sum(body.field.velocity.data());
    const auto [change_x, change_y] = stencil.sum(body.field.change.data());
    const Lanes move_x = old_x + change_x, move_y = old_y + change_y;
    Lanes vx = load(&p.velocity_x[first]) + change_x, vy = load(&p.velocity_y[first]) + change_y;
    if (rate > 0.0) {
      const Lanes flip_x = vx, flip_y = vy;
      vx += rate * (move_x - vx);
      vy += rate * (move_y - vy);
      lost += 0.5 * density * load(&p.volume[first]) * (flip_x * flip_x + flip_y * flip_y - vx * vx - vy * vy);
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

std::vector<Stage> plan(const Scene& scene, Joint& joint) {
  std::vector<Stage> stages;
  const auto add = [&](std::string name, std::string does, std::function<void(State&, const Stroke&)> apply) {
    stages.push_back({std::move(name), std::move(does), std::move(apply)});
  };
  add("project",
      scene.contact ? "grid velocities p/m of every body under the walls, in the current configuration"
                    : "grid velocities p/m of every body under the walls, in the reference configuration",
      [&scene](State& state, const Stroke&) { gather_momentum(state, scene); });
  if (scene.contact)
    add("meet", "where bodies touch, along which normal; strains see no surfaces that approach",
        [&scene](State& state, const Stroke&) { meet(state, scene); });
  else if (scene.bodies.size() > 1)
    add("share", scene.interface ? "the interface slows what parts the bodies" : "bodies share one velocity",
        [&joint](State& state, const Stroke&) { joint.share_velocity(state); });
  add("strain",
      scene.is_thermal() ? "deformation, heat of the stroke, temperature, stress, internal forces"
                         : "deformation, stress, internal forces",
      [&scene](State& state, const Stroke& stroke) {
        for (Body& body : state.bodies) {
          mirror_velocity(state, scene, body.field);
          std::visit(
              [&](const auto& law) {
                if (scene.contact)
                  strain_points<Frame::current>(state, body, law, stroke);
                else
                  strain_points<Frame::reference>(state, body, law, stroke);
              },
              body.law);
        }
      });
  if (scene.gravity)
    add("gravity", "weight of every body", [&scene](State& state, const Stroke&) { weigh(state, scene); });
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
  if (!scene.contact && scene.bodies.size() > 1)
    add("join", scene.interface ? "springs of the interface" : "bodies share one change of velocity",
        [&joint](State& state, const Stroke&) { joint.join(state); });
  add("advance", scene.pic_damping ? "points move (FLIP with a share of PIC, booked as damping)" : "points move (FLIP)",
      [&scene](State& state, const Stroke&) {
        for (Body& body : state.bodies) {
          mirror_change(state, scene, body.field);
          move_points(state, scene, body);
        }
      });
  if (!scene.rigids.empty())
    add("push", "rigid bodies move", [&scene](State& state, const Stroke&) { move_rigids(state, scene); });
  add("piston", "the piston moves and its work is booked", [](State& state, const Stroke&) {
    state.piston.work += state.piston.force * state.piston.speed * state.step;
    state.piston.position += state.piston.speed * state.step;
    state.time += state.step;
  });
  return stages;
}

double stable_step(const State& state, const Scene& scene) {
  double most = 0.0;  // transits of a cell per second
  for (const Body& body : state.bodies)
    each_batch(body, [&](const auto& law, const BodyPoints& points, std::size_t first) {
      Lanes speed = law.wave_speed(points) + std::abs(state.piston.speed);
      Lanes along = all_lanes(state.grid.inverse_cell_x), across = all_lanes(state.grid.inverse_cell_y);
      if (scene.contact) {
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
