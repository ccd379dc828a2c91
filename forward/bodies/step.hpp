#pragma once

#include "forward/bodies/interface.hpp"
#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// One explicit step, stresses first: particles to grid, strains and heat, forces, new velocities under walls and
/// joints, particles moved (FLIP, blended with PIC where the scene damps).
void advance(State& state, const Scene& scene, const Stroke& stroke, Joint& joint);

/// The stress of every body for its deformation and temperature as they are.
void find_stress(State& state);

/// Sums over the points of all bodies, per unit width: N mm/mm, N mm/(mm K), K, MPa.
struct Totals {
  double kinetic = 0, internal = 0, entropy = 0;
  double temperature = 0;  ///< mean over the reference volume of thermal bodies
  double volume = 0;       ///< reference volume, mm^2
  double stress_xx = 0;    ///< mean Kirchhoff stress along the piston's way
  double stress_yy = 0;
};
Totals totals(const State& state);

}  // namespace kerf::forward::bodies
