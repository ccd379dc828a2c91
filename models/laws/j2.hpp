#pragma once

#include <cmath>
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

  /// Eqs. (1)-(3) for eight points. False when a stress is no longer a number or a return does not converge; the points
  /// then hold nothing to go on with.
  [[gnu::always_inline]] bool update(const StrainIncrement& l, MaterialPoints& tau) const {
    const double G = shear_modulus(), lambda = lame();
    const auto [c, s] = step_rotation(l.xy, l.yx);
    InPlane now = InPlane::of(tau.xx, tau.yy, tau.xy).seen_from(c, -s);
    const Lanes trace = l.xx + l.yy;
    now.mean += (lambda + G) * trace;
    now.half += G * (l.xx - l.yy);
    now.shear += G * (l.xy + l.yx);
    tau.zz += lambda * trace;
    return radial_return(now, tau);
  }

 protected:
  /// Eqs. (2) and (3) from the trial stress: in the plane `now`, across it and everything else in `tau`.
  [[gnu::always_inline]] bool radial_return(InPlane now, MaterialPoints& tau) const {
    // s has two thirds of `apart` along zz and one third, the other way, in the mean of xx and yy.
    const Lanes apart = now.mean - tau.zz;
    const Lanes square = apart * apart + 3.0 * (now.half * now.half + now.shear * now.shear);
    if (any(!(square < std::numeric_limits<double>::infinity()))) return false;
    bool converged = true;
    // No curve softens: where none of the eight has reached the first yield stress, there is nothing to return.
    if (any(square > hardening.yield_stress * hardening.yield_stress)) {
      const Lanes inverse_q = inverse_sqrt(square + 1e-300), q = square * inverse_q;
      Lanes x{};
      converged = return_to_yield(q, tau.plastic_strain, x);
      const Lanes lost = 3.0 * shear_modulus() * x * inverse_q;
      now.mean -= lost * apart * (1.0 / 3.0);
      tau.zz += lost * apart * (2.0 / 3.0);
      now.half -= lost * now.half;
      now.shear -= lost * now.shear;
      tau.plastic_strain += x;
    }
    tau.xx = now.xx();
    tau.yy = now.yy();
    tau.xy = now.shear;
    return converged;
  }

 private:
  /// The root x of (3), zero where (2) is not positive.
  bool return_to_yield(Lanes q, Lanes plastic_strain, Lanes& x) const {
    const double G = shear_modulus();
    const Lanes excess = q - hardening.flow_stress(plastic_strain);
    if constexpr (std::is_same_v<Hardening, LinearHardening>) {
      x = (excess > 0.0 ? excess : Lanes{}) * (1.0 / (3.0 * G + hardening.modulus));
      return true;
    } else {
      const Lanes upper = excess > return_tolerance * q ? excess / (3.0 * G) : Lanes{};
      return find_roots(
          [&](Lanes at, Lanes& value, Lanes& slope) {
            const Lanes eps = plastic_strain + at;
            value = (hardening.flow_stress(eps) + 3.0 * G * at) / q - 1.0;
            slope = (hardening.slope(eps) + 3.0 * G) / q;
          },
          upper, x);
    }
  }
};

}  // namespace kerf::laws
