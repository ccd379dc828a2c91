#include "forward/effects/grips.hpp"

#include <cmath>

namespace kerf::forward {
namespace {

/// Rotation of a face, from the straight line through the markers around a place; positive opens the crack.
double rotation(const State& state, const Scene& scene, Side side, double place) {
  const Face& face = state.crack.face[side];
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t k = 0; k < state.crack.size(); ++k) {
    if (std::abs(state.crack.reference_x[k] - place) > 0.5 * scene.grips->gauge) continue;
    n += 1.0;
    sx += face.x[k];
    sy += face.y[k];
    sxx += face.x[k] * face.x[k];
    sxy += face.x[k] * face.y[k];
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return side == above ? -std::atan(slope) : std::atan(slope);
}

/// E' of a beam along the cut: one over twice the least energy of unit stress along it, the stress across the plane of
/// the picture being free to take its plane-strain value.
double beam_modulus(const laws::Material& material) {
  return std::visit(
      [](const auto& law) {
        const auto energy = [&](double zz) { return law.elastic_energy({1.0, 0.0, zz, 0.0}); };
        const double least = energy(0.0), linear = 0.5 * (energy(1.0) - energy(-1.0));
        const double square = 0.5 * (energy(1.0) + energy(-1.0)) - least;
        return 0.5 / (least - 0.25 * linear * linear / square);
      },
      material);
}

/// What a section of the uncracked end, clear of the clamp, takes from the J-integral of one pulled arm: the shear
/// force P through its rotation, and the bending energy M^2 / (2 E' I).
double uncracked_release(const State& state, const Scene& scene, double pull) {
  const double height = scene.cut.depth + scene.grips->lower_arm;
  const double section = scene.window.ahead * scene.cut.depth - 0.75 * height;
  const double moment = pull * (section - scene.grips->position);
  return pull * std::sin(rotation(state, scene, above, section)) +
         moment * moment / (2.0 * beam_modulus(scene.material) * height * height * height / 12.0);
}

}  // namespace

void move_grips(State& state, const Scene& scene) {
  const Cut& cut = scene.cut;
  ToolState& grip = state.tool;
  grip.speed = state.time < cut.ramp ? cut.speed * state.time / cut.ramp : cut.speed;
  grip.x += state.step * grip.speed;
  state.force = {};
  state.contact_energy = 0.0;
}

void pull_arms(State& state, const Scene& scene, double stiffness) {
  const Grips& grips = *scene.grips;
  const double length = state.crack.spacing;
  double arms = 0.0;
  for (const Side side : {above, below}) {
    if (side == below && !grips.both_arms) continue;
    const double way = side == above ? 1.0 : -1.0;
    Face& face = state.crack.face[side];
    // All markers of the grip share one spring: what they do about their mean is the arm's affair, so that it can turn.
    double count = 0.0, sum = 0.0;
    const auto each_held = [&](auto&& visit) {
      for (std::size_t k = 0; k < state.crack.size(); ++k)
        if (std::abs(state.crack.reference_x[k] - grips.position) <= 0.5 * grips.width) visit(k);
    };
    each_held([&](std::size_t k) {
      count += 1.0;
      sum += face.y[k];
    });
    const double stretch = way * state.tool.x - sum / count, force = stiffness * stretch * length;
    each_held([&](std::size_t k) { face.force_y[k] += force; });
    const double pull = way * force * count;
    state.contact_energy += 0.5 * force * stretch * count;
    state.work.tool += pull * state.tool.speed * state.step;
    state.force.on_work_x += pull;  // what drives the crack on, as F_c drives a cut
    state.force.release += pull * std::sin(rotation(state, scene, side, grips.position));
    arms += 1.0;
  }
  state.force.on_work_x /= arms;
  if (!grips.both_arms) state.force.release -= uncracked_release(state, scene, state.force.on_work_x);
}

}  // namespace kerf::forward
