#pragma once

namespace kerf::chip {

// A chip is not clamped at the crack tip: it turns there by theta_0 = chi h kappa_0 as if it rested on the elastic
// material below (crack-length correction of a double cantilever beam, chi h).

/// chi of an isotropic material: two thirds, printed as 0.67.
inline constexpr double isotropic_root_rotation = 2.0 / 3.0;

/// chi of an orthotropic material cut along x, with y across the crack plane; moduli in any one unit. Eq. (7):
/// Gamma = 1.18 sqrt(E_x E_y) / G_xy, chi^2 = E_x / (11 G_xy) [3 - 2 (Gamma / (1 + Gamma))^2]. No plane-strain
/// reduction of the moduli: as they stand, the Douglas-fir constants give the published 1.59 (RL) and 1.7 (TL).
double orthotropic_root_rotation(double E_x, double E_y, double G_xy);

}  // namespace kerf::chip
