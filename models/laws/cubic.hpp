#pragma once

#include "models/laws/traction_law.hpp"

namespace kerf::laws {

/// Cubic cohesive law (Needleman 1987 as used by Nairn 2013), with d = delta / delta_c:
///     T = (27/4) sigma_c d (1 - d)^2,   peak sigma_c at d = 1/3                (1)
///     area(d) = G_c d^2 (6 - 8 d + 3 d^2),   G_c = (9/16) sigma_c delta_c      (2)
class Cubic final : public TractionLaw {
 public:
  Cubic(double strength, double toughness)
      : strength_(strength), toughness_(toughness), critical_opening_(16.0 * toughness / (9.0 * strength)) {}

  double traction(double opening) const override {
    const double d = opening / critical_opening_;
    return d < 1.0 ? 6.75 * strength_ * d * (1.0 - d) * (1.0 - d) : 0.0;
  }
  double slope(double opening) const override {
    const double d = opening / critical_opening_;
    return d < 1.0 ? 6.75 * strength_ / critical_opening_ * (1.0 - d) * (1.0 - 3.0 * d) : 0.0;
  }
  double area(double opening) const override {
    const double d = opening / critical_opening_;
    return d < 1.0 ? toughness_ * d * d * (6.0 - 8.0 * d + 3.0 * d * d) : toughness_;
  }
  double strength() const override { return strength_; }
  double critical_opening() const override { return critical_opening_; }
  double toughness() const override { return toughness_; }

 private:
  double strength_, toughness_, critical_opening_;
};

TractionLawKind cubic();

}  // namespace kerf::laws
