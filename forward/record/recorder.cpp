#include "forward/record/recorder.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace kerf::forward {

Ledger take_stock(const State& state, const laws::Material& material) {
  const Particles& p = state.particles;
  const Work& work = state.work;
  Ledger ledger{.tool_work = work.tool,
                .fracture = work.mode_I + work.mode_II,
                .plastic = work.retired_plastic,
                .elastic = work.retired_elastic + state.contact_energy,
                .kinetic = work.retired_kinetic,
                .friction = work.friction,
                .damping = work.damping};
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) {
          ledger.elastic += p.volume[i] * law.elastic_energy(p.stress(i));
          ledger.plastic += p.volume[i] * law.plastic_work(p.plastic_strain[i]);
        }
      },
      material);
  for (std::size_t i = 0; i < p.size(); ++i)
    ledger.kinetic +=
        0.5 * p.volume[i] * state.density * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
  return ledger;
}

ChipShape measure_chip(const State& state, double depth) {
  const Particles& p = state.particles;
  const double low = 1.25 * depth, high = 2.75 * depth, middle = 0.5 * (low + high);
  const double ahead = state.tool.x + 2.5 * depth;  // further on, a curled chip comes back
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  const auto each_in_chip = [&](auto&& visit) {
    for (std::size_t i = p.begin[above]; i < p.begin[above + 1]; ++i)
      if (p.volume[i] > 0.0 && p.y[i] > low && p.y[i] < high && p.x[i] < ahead) visit(i, (p.y[i] - middle) / depth);
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

/// Reference position of the foremost pair that is past the peak of one of its laws: where separation is under way.
double softened_front(const Crack& crack, const Cohesive& law) {
  for (std::size_t k = crack.size(); k-- > 0;)
    if (!crack.intact[k] || law.mode_I->slope(crack.largest_normal[k]) < 0.0 ||
        law.mode_II->slope(crack.largest_shear[k]) < 0.0)
      return crack.reference_x[k];
  return crack.front;
}

Extension measure_extension(const State& state, const Scene& scene, double release) {
  const Crack& crack = state.crack;
  const double notch = scene.cut.notch * scene.cut.depth;
  const auto first = static_cast<std::size_t>(
      std::upper_bound(crack.reference_x.begin(), crack.reference_x.end(), notch) - crack.reference_x.begin());
  return {.opening = state.tool.x,
          .crack = std::max(0.0, softened_front(crack, scene.cohesive) - notch),
          .release = release,
          .at_notch_I = scene.cohesive.mode_I->area(crack.largest_normal.at(first)),
          .at_notch_II = scene.cohesive.mode_II->area(crack.largest_shear.at(first))};
}

void Recorder::add_step(const State& state) {
  for (std::size_t f = 0; f < tool_face_count; ++f) {
    const FaceForce& now = state.force.face[f];
    FaceForce& sum = sum_.face[f];
    sum.normal += now.normal;
    sum.tangential += now.tangential;
    sum.slip_limit += now.slip_limit;
    sum.contact_length += now.contact_length;
  }
  sum_.on_work_x += state.force.on_work_x;
  sum_.on_work_y += state.force.on_work_y;
  sum_.at_edge += state.force.at_edge;
  sum_.release += state.force.release;
  sum_.penetration = std::max(sum_.penetration, state.force.penetration);
  steps_ += 1.0;
}

void Recorder::add_crossing(const State& state, const Scene& scene) {
  ForceSample sample{.travel = state.tool.x - state.tool.start,
                     .face = sum_.face,
                     .F_c = sum_.on_work_x / steps_,
                     .F_t = -sum_.on_work_y / steps_,
                     .crack_lead = state.crack.front - state.tool.x,
                     .softening_lead = softened_front(state.crack, scene.cohesive) - state.tool.x,
                     .extension = {},
                     .fracture_I = state.work.mode_I,
                     .broken_length = state.work.broken_length,
                     .broken_energy = state.work.broken_energy,
                     .at_edge = sum_.at_edge / steps_,
                     .penetration = sum_.penetration,
                     .ledger = take_stock(state, scene.material)};
  for (FaceForce& face : sample.face) {
    face.normal /= steps_;
    face.tangential /= steps_;
    face.slip_limit /= steps_;
    face.contact_length /= steps_;
  }
  if (scene.grips) sample.extension = measure_extension(state, scene, sum_.release / steps_);
  history_.push_back(sample);
  if (!scene.grips) chip_.push_back(measure_chip(state, scene.cut.depth));
  sum_ = {};
  steps_ = 0.0;
}

}  // namespace kerf::forward
