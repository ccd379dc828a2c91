#include "forward/effects/bridging.hpp"

#include <algorithm>
#include <cmath>

#include "forward/mpm/crack.hpp"

namespace kerf::forward {

void cut_bonds(State& state, const Scene& scene) {
  Crack& crack = state.crack;
  const ToolState& tool = state.tool;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  const double r = tool.tip_radius, lowest = scene.tool.lowest_point(r);
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (!crack.intact[k] || lower.inverse_mass[k] == 0.0) continue;
    double front = tool.x;
    if (r > 0.0) {
      const double height = std::clamp(upper.y[k] - tool.y, 0.0, r);
      front += lowest + std::sqrt(height * (2.0 * r - height));
    }
    if (lower.x[k] < front) break_bond(state, scene.cohesive, k);
  }
}

}  // namespace kerf::forward
