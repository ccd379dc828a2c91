#pragma once

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// Sums over the points of all bodies, per unit width: N mm/mm, N mm/(mm K), K, MPa.
struct Totals {
  double kinetic = 0, internal = 0, entropy = 0;
  double plastic_work = 0;  ///< of bodies with a temperature
  double temperature = 0;   ///< mean over the reference volume of thermal bodies
  double volume = 0;        ///< reference volume, mm^2
  double stress_xx = 0;     ///< mean Kirchhoff stress along the piston's way
  double stress_yy = 0;
  double mass = 0;
  double momentum_x = 0, momentum_y = 0;  ///< tonne/s
  double moment_x = 0, moment_y = 0;      ///< mass times position of its centre, tonne
  double angular_momentum = 0;            ///< about the origin, tonne mm/s
};
Totals totals(const State& state);

}  // namespace kerf::forward::bodies
