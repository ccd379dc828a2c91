#pragma once

#include <string>
#include <vector>

#include "models/base/parameter.hpp"
#include "models/laws/body_point.hpp"

namespace kerf::laws {

/// The ideal gas as a hyperelastic material. Per reference volume, with J the volume ratio:
///     p = p_0 T / (T_0 J),   tau = -J p 1                                   (1)
///     S = c ln(T/T_0) + (p_0/T_0) ln J,   c = p_0 / (T_0 (gamma - 1))       (2)
///     U = c (T - T_0)                                                       (3)
/// (1) and (2) obey d tau/dT = -dS/dF, so that p V^gamma is constant where S is.
struct IdealGas {
  double pressure;    ///< p_0, MPa
  double reference;   ///< T_0, K
  double heat_ratio;  ///< gamma
  double density;     ///< rho at p_0 and T_0, tonne/mm^3

  static std::string name() { return "ideal_gas"; }
  static std::string meaning() { return "ideal gas without viscosity"; }
  static std::vector<Parameter> parameters();
  static IdealGas from(const Values& values);
  static std::vector<Memory> memory() { return {{"volume ratio", 1.0}}; }
  static constexpr bool is_thermal = true;

  double mass_density() const { return density; }
  double heat_capacity() const { return pressure / (reference * (heat_ratio - 1.0)); }
  void deform(const StrainIncrement& l, BodyPoints& points) const { points.memory[0] *= volume_growth(l); }
  Lanes configurational_entropy(const BodyPoints& points) const {
    return pressure / reference * each_lane(points.memory[0], [](double J) { return std::log(J); });
  }
  /// Eq. (1). False where the gas has lost its volume or its temperature.
  bool find_stress(BodyPoints& points) const {
    points.xx = points.yy = points.zz = -pressure / reference * points.temperature;
    points.xy = Lanes{};
    return !any(!((points.memory[0] > 0.0) & (points.temperature > 0.0)));
  }
  Lanes energy(const BodyPoints& points) const { return heat_capacity() * (points.temperature - reference); }
  Lanes wave_speed(const BodyPoints& points) const {
    return sqrt(heat_ratio * pressure / (reference * density) * points.temperature);
  }
};

}  // namespace kerf::laws
