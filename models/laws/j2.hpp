#pragma once

#include <cmath>
#include <cstddef>

#include "models/base/parameter.hpp"

namespace kerf::laws {

/// Isotropic elasticity with von Mises (J2) plasticity and linear hardening, plane strain.
///
/// Hypoelastic in the Kirchhoff stress tau with the Jaumann rate, the spin applied as an exact rotation:
///     tau <- R tau R^T + lambda tr(d) I + 2 G d,        R = rotation by the spin of the step      (1)
///     q = sqrt(3/2 s:s),  f = q - (sigma_y + H eps_p)                                             (2)
///     f > 0:  d_eps_p = f / (3 G + H),  s <- s (1 - 3 G d_eps_p / q)       (radial return)        (3)
/// The elastic energy per reference volume is tau:C^-1:tau/2 and the plastic work sigma_y eps_p + H eps_p^2/2: the rate
/// is corotational and C isotropic, so both are exact and the energy ledger needs no history. Source: Simo & Hughes,
/// Computational Inelasticity, sections 3.3 and 8.3.
struct J2 {
  double elastic_modulus;    ///< E, MPa
  double poisson_ratio;      ///< nu
  double density;            ///< rho, tonne/mm^3
  double yield_stress;       ///< sigma_y, MPa, uniaxial
  double hardening_modulus;  ///< H = d sigma_y / d eps_p, MPa; 0 is perfectly plastic

  static Block block();
  static J2 from(const Values& values);

  double shear_modulus() const { return elastic_modulus / (2.0 * (1.0 + poisson_ratio)); }
  double lame() const {
    return elastic_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  }
  double plane_strain_modulus() const { return elastic_modulus / (1.0 - poisson_ratio * poisson_ratio); }
  double wave_speed() const { return std::sqrt((lame() + 2.0 * shear_modulus()) / density); }

  /// Stored energy per reference volume (MPa) of a stress state.
  double elastic_energy(double xx, double yy, double zz, double xy) const {
    const double trace = xx + yy + zz;
    return ((1.0 + poisson_ratio) * (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy) - poisson_ratio * trace * trace) /
           (2.0 * elastic_modulus);
  }
  /// Dissipated energy per reference volume (MPa) after the plastic strain `eps_p`.
  double plastic_work(double eps_p) const { return (yield_stress + 0.5 * hardening_modulus * eps_p) * eps_p; }

  /// Stress of `n` material points, structure of arrays; tau in MPa, updated in place.
  struct Stress {
    double *xx, *yy, *zz, *xy, *plastic_strain;
  };
  /// Velocity gradient times the time step: l_ij = dt d v_i / d x_j.
  struct StrainIncrement {
    const double *xx, *xy, *yx, *yy;
  };

  /// Eqs. (1)-(3) over n points. Branch-free, so that the loop runs in SIMD lanes.
  void update(std::size_t n, StrainIncrement l, Stress tau) const {
    const double G = shear_modulus(), lambda = lame(), H = hardening_modulus, sigma_y = yield_stress;
    for (std::size_t i = 0; i < n; ++i) {
      const double half_spin = 0.25 * (l.yx[i] - l.xy[i]);
      const double scale = 1.0 / (1.0 + half_spin * half_spin);
      const double c = (1.0 - half_spin * half_spin) * scale, s = 2.0 * half_spin * scale;
      const double cc = c * c, ss = s * s, cs = c * s;
      const double volumetric = lambda * (l.xx[i] + l.yy[i]);
      const double xx = cc * tau.xx[i] + ss * tau.yy[i] - 2.0 * cs * tau.xy[i] + volumetric + 2.0 * G * l.xx[i];
      const double yy = ss * tau.xx[i] + cc * tau.yy[i] + 2.0 * cs * tau.xy[i] + volumetric + 2.0 * G * l.yy[i];
      const double xy = cs * (tau.xx[i] - tau.yy[i]) + (cc - ss) * tau.xy[i] + G * (l.xy[i] + l.yx[i]);
      const double zz = tau.zz[i] + volumetric;
      const double mean = (xx + yy + zz) / 3.0;
      const double sxx = xx - mean, syy = yy - mean, szz = zz - mean;
      const double q = std::sqrt(1.5 * (sxx * sxx + syy * syy + szz * szz + 2.0 * xy * xy)) + 1e-300;
      const double excess = q - (sigma_y + H * tau.plastic_strain[i]);
      const double yielding = excess > 0.0 ? excess / (3.0 * G + H) : 0.0;
      const double keep = 1.0 - 3.0 * G * yielding / q;
      tau.xx[i] = mean + keep * sxx;
      tau.yy[i] = mean + keep * syy;
      tau.zz[i] = mean + keep * szz;
      tau.xy[i] = keep * xy;
      tau.plastic_strain[i] += yielding;
    }
  }
};

}  // namespace kerf::laws
