#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>

#include "models/base/parameter.hpp"
#include "models/laws/hardening.hpp"
#include "models/laws/material_point.hpp"
#include "models/laws/return_map.hpp"

namespace kerf::laws {

/// Isotropic elasticity with von Mises (J2) plasticity and isotropic hardening sigma_f(eps_p), plane strain.
///
/// Hypoelastic in the Kirchhoff stress tau with the Jaumann rate, the spin applied as an exact rotation:
///     tau <- R tau R^T + lambda tr(d) I + 2 G d,        R = rotation by the spin of the step      (1)
///     q = sqrt(3/2 s:s),  f = q - sigma_f(eps_p)                                                  (2)
///     f > 0:  sigma_f(eps_p + x) + 3 G x = q,  eps_p <- eps_p + x,  s <- s (1 - 3 G x / q)        (3)
/// (radial return). With linear hardening x = f / (3 G + H). The elastic energy per reference volume is
/// tau:C^-1:tau/2 and the plastic work the integral of sigma_f: the rate is corotational and C isotropic, so both are
/// exact and the energy ledger needs no history. Source: Simo & Hughes, Computational Inelasticity, sections 3.3
/// and 8.3.
template <class Hardening>
struct J2 {
  double elastic_modulus;  ///< E, MPa
  double poisson_ratio;    ///< nu
  double density;          ///< rho, tonne/mm^3
  Hardening hardening;

  static constexpr bool has_axes = false;

  static Block block();
  static J2 from(const Values& values);

  double shear_modulus() const { return elastic_modulus / (2.0 * (1.0 + poisson_ratio)); }
  double lame() const {
    return elastic_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
  }
  /// Stiffness of a half-space pressed across the crack plane, MPa.
  double plane_strain_modulus() const { return elastic_modulus / (1.0 - poisson_ratio * poisson_ratio); }
  /// Fastest wave, the same in all directions, mm/s.
  double wave_speed(double /*cos*/ = 1.0, double /*sin*/ = 0.0) const {
    return std::sqrt((lame() + 2.0 * shear_modulus()) / density);
  }
  /// Shear traction at which the virgin material yields along a plane, MPa.
  double shear_yield() const { return hardening.yield_stress / std::numbers::sqrt3; }

  /// Stored energy per reference volume (MPa) of a stress state.
  double elastic_energy(const StressPoint& t) const {
    const double trace = t.xx + t.yy + t.zz;
    return ((1.0 + poisson_ratio) * (t.xx * t.xx + t.yy * t.yy + t.zz * t.zz + 2.0 * t.xy * t.xy) -
            poisson_ratio * trace * trace) /
           (2.0 * elastic_modulus);
  }
  /// Dissipated energy per reference volume (MPa) after the plastic strain `eps_p`.
  double plastic_work(double eps_p) const { return hardening.work(eps_p); }

  /// Eqs. (1)-(3) over n points. False when a stress is no longer a number or a return does not converge; the points
  /// then hold nothing to go on with.
  bool update(std::size_t n, StrainIncrement l, MaterialPoints tau) const {
    if constexpr (std::is_same_v<Hardening, LinearHardening>) return update_linear(n, l, tau);
    return update_curved(n, l, tau);
  }

 private:
  /// A stress after (1), split into mean and deviator.
  struct Trial {
    double mean, sxx, syy, szz, xy, q;
  };
  static Trial trial(std::size_t i, StrainIncrement l, MaterialPoints tau, double G, double lambda) {
    const auto [c, s] = step_rotation(l.xy[i], l.yx[i]);
    const double cc = c * c, ss = s * s, cs = c * s;
    const double volumetric = lambda * (l.xx[i] + l.yy[i]);
    const double xx = cc * tau.xx[i] + ss * tau.yy[i] - 2.0 * cs * tau.xy[i] + volumetric + 2.0 * G * l.xx[i];
    const double yy = ss * tau.xx[i] + cc * tau.yy[i] + 2.0 * cs * tau.xy[i] + volumetric + 2.0 * G * l.yy[i];
    const double xy = cs * (tau.xx[i] - tau.yy[i]) + (cc - ss) * tau.xy[i] + G * (l.xy[i] + l.yx[i]);
    const double zz = tau.zz[i] + volumetric;
    const double mean = (xx + yy + zz) / 3.0;
    const double sxx = xx - mean, syy = yy - mean, szz = zz - mean;
    const double q = std::sqrt(1.5 * (sxx * sxx + syy * syy + szz * szz + 2.0 * xy * xy)) + 1e-300;
    return {.mean = mean, .sxx = sxx, .syy = syy, .szz = szz, .xy = xy, .q = q};
  }
  static void store(std::size_t i, const Trial& t, double keep, double yielding, MaterialPoints tau) {
    tau.xx[i] = t.mean + keep * t.sxx;
    tau.yy[i] = t.mean + keep * t.syy;
    tau.zz[i] = t.mean + keep * t.szz;
    tau.xy[i] = keep * t.xy;
    tau.plastic_strain[i] += yielding;
  }

  /// Branch-free, so that the loop runs in SIMD lanes.
  bool update_linear(std::size_t n, StrainIncrement l,
                     MaterialPoints tau) const requires std::is_same_v<Hardening, LinearHardening> {
    const double G = shear_modulus(), lambda = lame(), H = hardening.modulus, sigma_y = hardening.yield_stress;
    double unsound = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const Trial t = trial(i, l, tau, G, lambda);
      const double excess = t.q - (sigma_y + H * tau.plastic_strain[i]);
      const double yielding = excess > 0.0 ? excess / (3.0 * G + H) : 0.0;
      unsound = t.q < std::numeric_limits<double>::infinity() ? unsound : 1.0;
      store(i, t, 1.0 - 3.0 * G * yielding / t.q, yielding, tau);
    }
    return unsound == 0.0;
  }

  /// Flow stresses are asked for lane by lane: pow and exp have no SIMD form here, and lanes below the first yield
  /// stress never need them.
  bool update_curved(std::size_t n, StrainIncrement l, MaterialPoints tau) const {
    const double G = shear_modulus(), lambda = lame();
    bool converged = true;
    for (std::size_t first = 0; first < n; first += batch_size) {
      const std::size_t count = std::min(batch_size, n - first);
      std::array<Trial, batch_size> trials{};
      Batch upper{}, x{};
      bool yields = false;
      for (std::size_t i = 0; i < count; ++i) {
        trials[i] = trial(first + i, l, tau, G, lambda);
        const double q = trials[i].q;
        if (q <= hardening.yield_stress) continue;
        const double excess = q - hardening.flow_stress(tau.plastic_strain[first + i]);
        if (excess <= return_tolerance * q) continue;
        upper[i] = excess / (3.0 * G);
        yields = true;
      }
      if (yields)
        converged &= find_roots(
            [&](const Batch& at, Batch& value, Batch& slope) {
              for (std::size_t i = 0; i < batch_size; ++i) {
                if (upper[i] == 0.0) continue;
                const double eps = tau.plastic_strain[first + i] + at[i], q = trials[i].q;
                value[i] = (hardening.flow_stress(eps) + 3.0 * G * at[i]) / q - 1.0;
                slope[i] = (hardening.slope(eps) + 3.0 * G) / q;
              }
            },
            upper, x);
      for (std::size_t i = 0; i < count; ++i) {
        converged &= trials[i].q < std::numeric_limits<double>::infinity();
        store(first + i, trials[i], 1.0 - 3.0 * G * x[i] / trials[i].q, x[i], tau);
      }
    }
    return converged;
  }
};

}  // namespace kerf::laws
