#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Heat in a cut: with the plastic work w_p per volume that a particle has taken, its stress tau, and theta, what
/// conduction and friction on the tool have added,
///     T = T_0 + beta w_p/(rho c) - alpha T_0 tr(tau)/(rho c) + theta,
///     rho c d theta/dt = div(k grad T) + the share of the friction's work that stays in the work.
/// All but theta needs no memory. The third part is Kelvin's: what is pulled without heat grows cooler by it. Stresses
/// do not depend on T: the strain alpha (T - T_0) that they leave out is small beside that at yield.

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

/// Friction on the tool (see press_and_warm) warms the particles at the nodes that its markers follow. The heat that
/// they take is what was booked, to rounding.
void warm_by_friction(State& state, const Scene& scene);

/// The longest step (s) in which conduction is stable: a quarter of the time in which heat crosses a cell.
double longest_conduction_step(const Grid& grid, const Scene& scene);

}  // namespace kerf::forward
