#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "models/base/parameter.hpp"
#include "models/laws/hardening.hpp"
#include "models/laws/material_point.hpp"

namespace kerf::laws {

/// Orthotropic elasticity with Hill (1948) plasticity in material axes that turn with the material, plane strain; as in
/// Nairn 2016, section 2.1. Material x is the cutting direction when the axes are not turned, y lies across the crack
/// plane, z out of the plane; total eps_zz = 0.
///
/// Yield, with F = (1/Y_y^2 + 1/Y_z^2 - 1/Y_x^2)/2 and cyclic (G with y, H with z in front):
///     s^2 = F (s_yy - s_zz)^2 + G (s_xx - s_zz)^2 + H (s_yy - s_xx)^2 + (t_xy/Y_xy)^2                   (1)
///     s = 1 + K eps_p^n                                                                                 (2)
/// An infinite strength counts as 1/Y = 0. Equation (1) is a sum of squares only if none of 1/Y_x, 1/Y_y, 1/Y_z is
/// larger than the sum of the other two; anything else has no closed yield surface and is refused.
///
/// eps_p is work-conjugate to q = Y_ref s: plastic work = Y_ref int (1 + K eps^n) d eps, and the flow is associated,
///     d e^p = d eps_p  dq/d sigma = d eps_p  P sigma / q,   q^2 = sigma^T P sigma                       (3)
/// Y_ref is the first finite one of Y_x, Y_y, Y_z (eps_p is then the plastic strain of a bar pulled that way), else
/// sqrt(3) Y_xy. A bar pulled along y sees the curve (2) over its own strain times Y_y/Y_ref.
///
/// Return map, implicit. P = B^T B with two rows for the normal stresses and one for shear. W, the axes of B C B^T,
/// turn it into Z = W^T B with Z C Z^T = diag(D), so with m = d eps_p / q and z = Z sigma_trial
///     Z sigma = z_i / (1 + m D_i),   sigma = sigma_trial - m C Z^T (Z sigma),   q(m) = |Z sigma|        (4)
///     Y_ref (1 + K (eps_p + m q)^n) / q = 1                                                             (5)
/// one increasing function of m per point, whatever the direction. Directions that cannot yield are absent from Z, not
/// large numbers in it. Hardening that is linear, of slope H, disappears from (5) in t = d eps_p / flow stress before:
///     Z sigma = (1 + H t) z_i k_i,   m = t/(1 + H t),   sum (z_i k_i)^2 = (flow stress before)^2,
///     k_i = 1/(1 + (D_i + H) t)                                                                         (6)
/// As elastic as (4) with stiffer modes, and a step of a simulation passes the yield surface by a few per cent at most:
/// the series of t in the excess to its third order, then one step of Newton's.
///
/// Objectivity: the axes turn by the exact rotation of the step's spin and the stress, stored in the frame of the grid,
/// turns with them (Jaumann rate, as in J2). Stress and its elastic energy are functions of the material frame, so the
/// energy ledger needs no history.
class Hill {
 public:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  struct Constants {
    double modulus_x, modulus_y, modulus_z;     ///< MPa
    double shear_modulus_xy;                    ///< MPa
    double poisson_xy, poisson_xz, poisson_yz;  ///< nu_ij = -e_j/e_i when pulled along i; nu_ij/E_i = nu_ji/E_j
    double density;                             ///< tonne/mm^3
    double yield_x = infinite, yield_y = infinite, yield_z = infinite;  ///< MPa
    double shear_yield_xy = infinite;                                   ///< MPa
    double hardening_coefficient = 0.0, hardening_exponent = 1.0;
  };

  /// A key whose value makes no material together with the others, and why.
  struct Fault {
    std::string key, reason;
  };
  static std::optional<Fault> fault(const Constants& constants);

  static Block block();
  static Hill from(const Values& values);
  /// Throws InputError on constants with a fault.
  explicit Hill(const Constants& constants);

  double density;
  static constexpr bool has_axes = true;

  const Constants& constants() const { return constants_; }
  /// Flow stress q = Y_ref (1 + K eps^n), MPa.
  const PowerHardening& hardening() const { return hardening_; }

  /// Stiffness of a half-space pressed across the crack plane, MPa: plane strain, from the reduced compliances b_ij
  ///     1/E' = sqrt(b_11 b_22 / 2) sqrt( sqrt(b_22/b_11) + (2 b_12 + b_66)/(2 b_11) )   (Sih, Paris & Irwin 1965)
  /// the same combination that turns K_I into G_I; E/(1 - nu^2) when isotropic.
  double plane_strain_modulus() const;
  /// Fastest wave along the direction at this angle to the material's x axis, mm/s: larger root of Christoffel's
  /// matrix.
  double wave_speed(double cos = 1.0, double sin = 0.0) const;
  /// Shear traction at which the virgin material yields along the crack plane, MPa; infinite if it never does.
  double shear_yield() const { return constants_.shear_yield_xy; }
  double elastic_energy(const StressPoint& point) const;
  double plastic_work(double eps_p) const { return hardening_.work(eps_p); }

  /// All of the above for eight points. False when a stress is no longer a number or a return does not converge; the
  /// points then hold nothing to go on with.
  bool update(const StrainIncrement& l, MaterialPoints& points) const;

 private:
  /// Equations (6), from the stress in material axes and its Z sigma; linear hardening.
  bool return_at_once(const std::array<Lanes, 3>& z, Lanes square, MaterialPoints& points) const;
  /// Equations (4) and (5), any hardening and any step.
  template <class Hardening>
  bool find_return(const Hardening& hardening, const std::array<Lanes, 3>& z, Lanes q, MaterialPoints& points) const;

  Constants constants_;
  PowerHardening hardening_;
  double c_xx_, c_yy_, c_xy_, c_xz_, c_yz_,
      c_shear_;  ///< stiffness; zz never strains, so c_zz only matters for return_
  std::array<std::array<double, 3>, 3> compliance_{};  ///< of the normal stresses
  std::array<std::array<double, 3>, 2> modes_{};       ///< normal rows of Z over (xx, yy, zz)
  std::array<std::array<double, 3>, 2> return_{};      ///< the same rows of (C Z^T)^T
  double shear_mode_ = 0.0;                            ///< shear row of Z
  std::array<double, 3> stiffness_{};                  ///< D, of the two normal modes and of shear
};

}  // namespace kerf::laws
