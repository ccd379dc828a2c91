#pragma once

#include <string>
#include <vector>

#include "models/base/parameter.hpp"
#include "models/laws/body_point.hpp"

namespace kerf::laws {

/// Mooney-Rivlin rubber whose stress is all entropy, Flory's ideal rubber: (dU/dF)_T = 0. With the left Cauchy-Green
/// tensor b = F F^T, J^2 = det b and the isochoric invariants I_1, I_2 of b,
///     w(F) = C_1 (I_1 - 3) + C_2 (I_2 - 3) + K/2 (J - 1)^2                  (1)
///     tau = T/T_0 dw/dF F^T,   S = c ln(T/T_0) - w/T_0,   U = c (T - T_0)    (2)
/// so that an isothermal stretch gives off as heat all the work it takes, dq = -dw, and an adiabatic one warms:
/// T = T_start exp((w - w_start) / (c T_0)).
struct IdealRubber {
  double C_1, C_2;       ///< MPa at T_0
  double bulk_modulus;   ///< K at T_0, MPa
  double reference;      ///< T_0, K
  double density;        ///< tonne/mm^3
  double specific_heat;  ///< mm^2/(s^2 K)
  bool thin;             ///< free to contract out of the plane (tau_zz = 0); else held there

  static std::string name() { return "ideal_rubber"; }
  static std::string meaning() { return "Mooney-Rivlin rubber whose stress is all entropy"; }
  static std::vector<Parameter> parameters();
  static IdealRubber from(const Values& values);
  static std::vector<Memory> memory() { return {{"b xx", 1.0}, {"b yy", 1.0}, {"b xy", 0.0}, {"b zz", 1.0}}; }
  static constexpr bool is_thermal = true;

  double mass_density() const { return density; }
  double heat_capacity() const { return density * specific_heat; }
  /// b <- (1 + l) b (1 + l)^T; of a thin sheet, b_zz follows from tau_zz = 0.
  void deform(const StrainIncrement& l, BodyPoints& points) const;
  Lanes configurational_entropy(const BodyPoints& points) const { return -potential(points) / reference; }
  bool find_stress(BodyPoints& points) const;
  Lanes energy(const BodyPoints& points) const { return heat_capacity() * (points.temperature - reference); }
  Lanes wave_speed(const BodyPoints& points) const;
  /// Eq. (1).
  Lanes potential(const BodyPoints& points) const;

 private:
  struct Stress {
    Lanes xx, yy, zz, xy;
  };
  Stress at_reference(const BodyPoints& points) const;
};

}  // namespace kerf::laws
