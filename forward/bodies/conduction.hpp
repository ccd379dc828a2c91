#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Heat conduction on the grid, with the kernels of the motion: nodal temperatures are means over the heat capacity,
/// fluxes q = -k grad T live at the points, and the change of the nodal temperatures goes back to the points (as FLIP
/// does with velocities, so that nothing is smoothed). In the reference configuration, explicit. A wall with a
/// temperature is a mirror, T_behind = 2 T_wall - T_before; others let no heat through. What walls give is booked.
class Conductor {
 public:
  explicit Conductor(const Scene& scene) : scene_(scene) {}
  void operator()(State& state);

 private:
  const Scene& scene_;
  std::vector<double> capacity_, content_, temperature_, rate_;
};

/// The longest step (s) that is stable: a quarter of the time in which heat crosses a cell.
double longest_conduction_step(const State& state, const Scene& scene);

}  // namespace kerf::forward::bodies
