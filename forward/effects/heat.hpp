#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Heat of plastic work: with the plastic work w_p per volume that a particle has taken, and theta, what conduction has
/// added,
///     T = T_0 + beta w_p/(rho c) + theta,    rho c d theta/dt = div(k grad T).
/// The first part needs no memory. Stresses do not depend on T, and neither friction on the tool nor elastic strains
/// heat.

/// Temperatures of all particles, K. The scene has a [thermal] block.
std::vector<double> temperatures(const State& state, const Scene& scene);

/// Conduction on the grid, explicit: nodal temperatures are means over the volume, fluxes live at the particles, and
/// the changes of the nodal temperatures go back to theta (as FLIP does with velocities). Heat crosses the crack where
/// its faces are less than about a cell apart; tool and air take none.
class HeatConduction {
 public:
  explicit HeatConduction(const Scene& scene) : scene_(scene) {}
  void operator()(State& state);

 private:
  const Scene& scene_;
  std::vector<double> volume_, temperature_, rate_;
};

/// The longest step (s) in which conduction is stable: a quarter of the time in which heat crosses a cell.
double longest_conduction_step(const Grid& grid, const Scene& scene);

}  // namespace kerf::forward
