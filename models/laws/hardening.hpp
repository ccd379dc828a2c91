#pragma once

#include <cmath>

#include "models/base/parameter.hpp"
#include "models/laws/lanes.hpp"

namespace kerf::laws {

// Flow stress against equivalent plastic strain, for any law whose plastic work is the integral of
//     dw = flow_stress(eps) d eps.                                                             (1)
// Each curve offers flow_stress and its slope, of one point or of eight, the work (1) since the virgin state, and its
// keys in a file. None softens:
// a local law that softens puts its whole strain into one row of cells.

/// sigma_y + H eps.
struct LinearHardening {
  double yield_stress;  ///< sigma_y, MPa
  double modulus;       ///< H, MPa; 0 is perfectly plastic

  static constexpr const char* suffix = "";
  static constexpr const char* meaning = "linear hardening";
  static std::vector<Parameter> parameters();
  static LinearHardening from(const Values& values);

  double flow_stress(double eps) const { return yield_stress + modulus * eps; }
  double slope(double) const { return modulus; }
  Lanes flow_stress(Lanes eps) const { return yield_stress + modulus * eps; }
  Lanes slope(Lanes) const { return all_lanes(modulus); }
  double work(double eps) const { return (yield_stress + 0.5 * modulus * eps) * eps; }
};

/// sigma_y (1 + K eps^n), Ludwik's curve. For n < 1 the slope at eps = 0 is infinite, and so it is returned.
struct PowerHardening {
  double yield_stress;  ///< sigma_y, MPa
  double coefficient;   ///< K
  double exponent;      ///< n

  static constexpr const char* suffix = "_power";
  static constexpr const char* meaning = "power-law hardening";
  static std::vector<Parameter> parameters();
  static PowerHardening from(const Values& values);

  double flow_stress(double eps) const { return yield_stress * (1.0 + coefficient * std::pow(eps, exponent)); }
  double slope(double eps) const {
    return coefficient == 0.0 ? 0.0 : yield_stress * coefficient * exponent * std::pow(eps, exponent - 1.0);
  }
  Lanes flow_stress(Lanes eps) const {
    return each_lane(eps, [this](double e) { return flow_stress(e); });
  }
  Lanes slope(Lanes eps) const {
    return each_lane(eps, [this](double e) { return slope(e); });
  }
  double work(double eps) const {
    return yield_stress * eps * (1.0 + coefficient * std::pow(eps, exponent) / (exponent + 1.0));
  }
};

/// sigma_y + (sigma_s - sigma_y) (1 - exp(-eps/eps_0)), Voce 1948.
struct SaturatingHardening {
  double yield_stress;       ///< sigma_y, MPa
  double saturation_stress;  ///< sigma_s, MPa
  double saturation_strain;  ///< eps_0

  static constexpr const char* suffix = "_saturating";
  static constexpr const char* meaning = "hardening that saturates";
  static std::vector<Parameter> parameters();
  static SaturatingHardening from(const Values& values);

  double flow_stress(double eps) const {
    return yield_stress - (saturation_stress - yield_stress) * std::expm1(-eps / saturation_strain);
  }
  double slope(double eps) const {
    return (saturation_stress - yield_stress) / saturation_strain * std::exp(-eps / saturation_strain);
  }
  Lanes flow_stress(Lanes eps) const {
    return each_lane(eps, [this](double e) { return flow_stress(e); });
  }
  Lanes slope(Lanes eps) const {
    return each_lane(eps, [this](double e) { return slope(e); });
  }
  double work(double eps) const {
    return saturation_stress * eps +
           (saturation_stress - yield_stress) * saturation_strain * std::expm1(-eps / saturation_strain);
  }
};

}  // namespace kerf::laws
