#pragma once

#include <cmath>
#include <string>

#include "models/laws/j2.hpp"

namespace kerf::laws {

/// sinh(x)/x of x^2, and atanh(x)/x of x^2; NaN where |x| >= 1. The series hold up to |x| = 0.2 and 0.1 to the last
/// digit, which covers the elastic strains of all that yields.
inline Lanes sinh_ratio(Lanes square) {
  if (any(!(square <= 0.04)))
    return each_lane(square, [](double x2) { return x2 > 0.0 ? std::sinh(std::sqrt(x2)) / std::sqrt(x2) : 1.0; });
  Lanes sum = all_lanes(1.0);
  for (const double n : {5.0, 4.0, 3.0, 2.0, 1.0}) sum = 1.0 + sum * square * (1.0 / (2.0 * n * (2.0 * n + 1.0)));
  return sum;
}
inline Lanes atanh_ratio(Lanes square) {
  if (any(!(square <= 0.01)))
    return each_lane(square, [](double x2) { return x2 == 0.0 ? 1.0 : std::atanh(std::sqrt(x2)) / std::sqrt(x2); });
  Lanes sum = all_lanes(1.0 / 15.0);
  for (const double n : {13.0, 11.0, 9.0, 7.0, 5.0, 3.0, 1.0}) sum = 1.0 / n + sum * square;
  return sum;
}

/// Isotropic hyperelasticity, quadratic in the elastic logarithmic (Hencky) strain, with von Mises plasticity and
/// isotropic hardening at any strain, plane strain. F = F_e F_p, b_e = F_e F_e^T:
///     eps = ln(b_e)/2,   tau = lambda tr(eps) I + 2 G eps                                         (1)
///     b_e <- f b_e f^T,  f = (I - l/2)^-1 (I + l/2)                                               (2)
/// then the radial return of J2, which in eps is the exponential map of the plastic flow and keeps its volume. By (1)
/// the stress tells the elastic strain, so that a particle carries nothing beside what it does with J2, and what J2
/// says of elastic energy and plastic work holds.
///
/// Cayley's f instead of I + l, which has an error of the second order in every step: a spin then turns and stretches
/// nothing, the way back undoes the way there, and the energy ledger sees the work tau:l of the step to its third
/// order.
///
/// (1) and (2) need no eigenvectors. In the plane b_e = J B with det B = 1, and with eps' = (eps_xx - eps_yy)/2, eps_xy
/// of norm d
///     B = [ c + a, s; s, c - a ],   (a, s) = sinh(2d)/d eps',   c = cosh(2d)                      (3)
/// whose inverse is eps' = (a, s) atanh(t)/(t (1 + c)), t = tanh(d) = |(a, s)|/(1 + c): smooth where eigenvalues meet.
/// Source: Simo, Comput. Methods Appl. Mech. Engrg 99 (1992) 61.
template <class Hardening>
struct Hencky : J2<Hardening> {
  static Block block();
  static Hencky from(const Values& values);

  /// Eqs. (1) and (2) for eight points. False when a step turns a point inside out, a stress is no longer a number or a
  /// return does not converge; the points then hold nothing to go on with.
  bool update(const StrainIncrement& l, MaterialPoints& tau) const {
    const double G = this->shear_modulus(), lambda = this->lame();
    // (3) of the elastic strain
    const Lanes half = 0.5 * (tau.xx + tau.yy);
    const Lanes exx = (tau.xx - half) * (0.5 / G), exy = tau.xy * (0.5 / G);
    const Lanes stretch = 2.0 * sinh_ratio(4.0 * (exx * exx + exy * exy));
    const Lanes a = stretch * exx, s = stretch * exy, c = sqrt(1.0 + a * a + s * s);
    // (2): f = n/(1 - t + D) with n = (1 - t - D) I + l, t = tr(l)/2, D = det(l)/4
    const Lanes t = 0.5 * (l.xx + l.yy), D = 0.25 * (l.xx * l.yy - l.xy * l.yx);
    const Lanes nxx = 1.0 - t - D + l.xx, nyy = 1.0 - t - D + l.yy;
    const Lanes scale = reciprocal((1.0 + D) * (1.0 + D) - t * t);  // 1/det(n)
    const Lanes Bxx = c + a, Byy = c - a;
    const Lanes px = nxx * Bxx + l.xy * s, qx = nxx * s + l.xy * Byy;  // n B
    const Lanes py = l.yx * Bxx + nyy * s, qy = l.yx * s + nyy * Byy;
    const Lanes xx = scale * (px * nxx + qx * l.xy), yy = scale * (py * l.yx + qy * nyy);
    const Lanes now_a = 0.5 * (xx - yy), now_s = scale * (px * l.yx + qx * nyy), now_c = 1.0 + 0.5 * (xx + yy);
    // (1)
    const Lanes per = reciprocal(now_c);
    const Lanes shear = 2.0 * G * per * atanh_ratio((now_a * now_a + now_s * now_s) * per * per);
    const Lanes u = t * reciprocal(1.0 + D), log_volume = 2.0 * u * atanh_ratio(u * u);
    tau.zz += lambda * log_volume;
    return this->radial_return({half + (lambda + G) * log_volume, shear * now_a, shear * now_s}, tau);
  }
};

}  // namespace kerf::laws
