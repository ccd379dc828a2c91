#include "forward/record/recorder.hpp"

#include <Eigen/Dense>
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
  const double low = 1.25 * depth, high = 2.75 * depth, middle = 0.5 * (low + high);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  const auto each_in_chip = [&](auto&& visit) {
    for (std::size_t i = p.begin[above]; i < p.begin[above + 1]; ++i)
      if (p.volume[i] > 0.0 && p.y[i] > low && p.y[i] < high) visit(i, (p.y[i] - middle) / depth);
  };
  std::size_t count = 0;
  each_in_chip([&](std::size_t i, double eta) {
    const Eigen::Vector3d row(1.0, eta, eta * eta);
    normal += row * row.transpose();
    moments += row * ((p.x[i] - state.tool.x) / depth);
    ++count;
  });
  if (count < 16) return {std::nan(""), std::nan("")};
  const Eigen::Vector3d line = normal.ldlt().solve(moments);
  double area = 0.0;
  each_in_chip(
      [&](std::size_t i, double eta) { area += p.volume[i] / std::hypot(1.0, line[1] + 2.0 * line[2] * eta); });
  return {area / ((high - low) * depth), 2.0 * line[2] / std::pow(std::hypot(1.0, line[1]), 3) / depth};
}

void Recorder::add_step(const State& state) {
  sum_.rake_normal += state.force.rake_normal;
  sum_.rake_tangential += state.force.rake_tangential;
  sum_.slip_limit += state.force.slip_limit;
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
                      .slip_limit = sum_.slip_limit / steps_,
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
