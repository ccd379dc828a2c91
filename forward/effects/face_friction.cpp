#include "forward/effects/face_friction.hpp"

#include <algorithm>
#include <cmath>

#include "forward/mpm/crack.hpp"

namespace kerf::forward {

void rub_faces(State& state, double coefficient, double stiffness) {
  Crack& crack = state.crack;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  const double length = crack.spacing;
  std::vector<double>& slips = crack.face[above].slip.back();  // the tool's contacts have theirs before it
  for (std::size_t k = 0; k < crack.size(); ++k) {
    const std::optional<Overlap> touch = crack.intact[k] ? std::nullopt : overlap(state, k);
    if (!touch) {
      slips[k] = 0.0;
      continue;
    }
    const auto [j, t, normal_x, normal_y, depth] = *touch;
    const double stretch = std::hypot(normal_x, normal_y), along_x = normal_y / stretch, along_y = -normal_x / stretch;
    const double velocity_x = upper.velocity_x[k] - (1.0 - t) * lower.velocity_x[j] - t * lower.velocity_x[j + 1];
    const double velocity_y = upper.velocity_y[k] - (1.0 - t) * lower.velocity_y[j] - t * lower.velocity_y[j + 1];
    // The penalty of close_faces acts along the normal with `depth * stretch`.
    const double longest = coefficient * depth * stretch;
    const double trial = slips[k] + state.step * (velocity_x * along_x + velocity_y * along_y);
    slips[k] = std::clamp(trial, -longest, longest);
    const double shear = -stiffness * slips[k] * length;
    push_apart(crack, k, *touch, shear * along_x, shear * along_y);
    state.work.friction -= shear * (trial - slips[k]);
    state.contact_energy += 0.5 * stiffness * slips[k] * slips[k] * length;
  }
}

}  // namespace kerf::forward
