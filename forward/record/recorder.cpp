#include "forward/record/recorder.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::forward {

Ledger take_stock(const State& state, const laws::J2& material) {
  const Particles& p = state.particles;
  const Work& work = state.work;
  Ledger ledger{.tool_work = work.tool,
                .fracture = work.mode_I + work.mode_II,
                .plastic = work.retired_plastic,
                .elastic = work.retired_elastic + state.contact_energy,
                .kinetic = work.retired_kinetic,
                .friction = work.friction,
                .damping = work.damping};
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double volume = p.volume[i];
    ledger.elastic += volume * material.elastic_energy(p.stress_xx[i], p.stress_yy[i], p.stress_zz[i], p.stress_xy[i]);
    ledger.plastic += volume * material.plastic_work(p.plastic_strain[i]);
    ledger.kinetic +=
        0.5 * volume * state.density * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
  }
  return ledger;
}

ChipShape measure_chip(const State& state, double depth) {
  const Particles& p = state.particles;
  double n = 0, mx = 0, my = 0, mu = 0, mv = 0, speed = 0;
  const auto in_chip = [&](std::size_t i) {
    return p.volume[i] > 0.0 && p.y[i] > 1.25 * depth && p.y[i] < 2.75 * depth;
  };
  for (std::size_t i = p.begin[above]; i < p.begin[above + 1]; ++i) {
    if (!in_chip(i)) continue;
    const double u = p.velocity_x[i] - state.tool.speed, v = p.velocity_y[i];
    n += 1.0;
    mx += p.x[i];
    my += p.y[i];
    mu += u;
    mv += v;
    speed += std::hypot(u, v);
  }
  if (n < 8.0 || speed == 0.0) return {std::nan(""), std::nan("")};
  mx /= n, my /= n, mu /= n, mv /= n, speed /= n;
  double moment = 0, inertia = 0;
  for (std::size_t i = p.begin[above]; i < p.begin[above + 1]; ++i) {
    if (!in_chip(i)) continue;
    const double rx = p.x[i] - mx, ry = p.y[i] - my;
    const double u = p.velocity_x[i] - state.tool.speed - mu, v = p.velocity_y[i] - mv;
    moment += rx * v - ry * u;
    inertia += rx * rx + ry * ry;
  }
  // The tool stands behind the chip: a chip that turns clockwise on its way up leaves the face.
  return {state.tool.speed / speed, -moment / inertia / speed};
}

void Recorder::add_step(const State& state) {
  sum_.rake_normal += state.force.rake_normal;
  sum_.rake_tangential += state.force.rake_tangential;
  sum_.bottom_normal += state.force.bottom_normal;
  sum_.bottom_tangential += state.force.bottom_tangential;
  sum_.on_work_x += state.force.on_work_x;
  sum_.on_work_y += state.force.on_work_y;
  sum_.penetration = std::max(sum_.penetration, state.force.penetration);
  steps_ += 1.0;
}

void Recorder::add_crossing(const State& state, const Scene& scene) {
  history_.push_back({.travel = state.tool.x,
                      .rake_normal = sum_.rake_normal / steps_,
                      .rake_tangential = sum_.rake_tangential / steps_,
                      .bottom_normal = sum_.bottom_normal / steps_,
                      .bottom_tangential = sum_.bottom_tangential / steps_,
                      .F_c = sum_.on_work_x / steps_,
                      .F_t = -sum_.on_work_y / steps_,
                      .crack_lead = state.crack.front - state.tool.x,
                      .fracture_I = state.work.mode_I,
                      .penetration = sum_.penetration,
                      .ledger = take_stock(state, scene.material)});
  chip_.push_back(measure_chip(state, scene.cut.depth));
  sum_ = {};
  steps_ = 0.0;
}

}  // namespace kerf::forward
