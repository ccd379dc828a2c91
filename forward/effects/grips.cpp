#include "forward/effects/grips.hpp"

#include <algorithm>
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

/// What the laws of the bonds that still hold around a place have taken, per area.
double bonded(const State& state, const Scene& scene, double place) {
  const Crack& crack = state.crack;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  double n = 0, taken = 0;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (std::abs(crack.reference_x[k] - place) > 0.5 * scene.grips->gauge) continue;
    n += 1.0;
    taken += scene.cohesive.mode_I->area(std::max(upper.y[k] - lower.y[k], 0.0)) +
             scene.cohesive.mode_II->area(std::abs(upper.x[k] - lower.x[k]));
  }
  return taken / n;
}

/// What a section of the uncracked end takes from the J-integral of one pulled arm, with the normal along the cut:
///     int (W - s_xx u_x,x - s_xy u_y,x) dy,   the negative of it being   P sin(theta) + int (W - 2 W_shear) dy
/// where W is the stored energy and W_shear that of the shear stress alone: s_yy is small there, and every point's face
/// along the cut turns by theta. W is read off the stresses; M^2 / (2 E' I) would leave out the energy of shear and
/// what clamp and bonds that slip do to a section of wood. Of J at the notch the section lacks what the bonds that it
/// crosses have taken.
double uncracked_release(const State& state, const Scene& scene, double pull) {
  const double height = scene.cut.depth + scene.grips->lower_arm;
  const double section = scene.window.ahead * scene.cut.depth - 0.75 * height;
  const Particles& p = state.particles;
  double stored = 0.0;
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) {
          const double share = 1.0 - std::abs(p.x[i] - section) / state.grid.cell_x;
          if (share <= 0.0) continue;
          laws::StressPoint stress = p.stress(i);
          const double whole = law.elastic_energy(stress);
          stress.xx = stress.yy = stress.zz = 0.0;
          stored += p.volume[i] * share / state.grid.cell_x * (whole - 2.0 * law.elastic_energy(stress));
        }
      },
      scene.material);
  return pull * std::sin(rotation(state, scene, above, section)) + stored - bonded(state, scene, section);
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
