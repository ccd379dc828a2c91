#pragma once

#include <cmath>
#include <numbers>

#include "models/laws/traction_law.hpp"

namespace kerf::laws {

/// Exponential cohesive law (Needleman 1990; Xu & Needleman 1993, one mode), with x = delta / delta_0:
///     T = sigma_c x e^(1-x),   peak sigma_c at x = 1,   up to x_t = 6                              (1)
///     area = sigma_c delta_0 e [1 - (1 + x) e^-x]                                                  (2)
/// The law of the literature never ends. Here its tail leaves (1) at x_t along the tangent and is zero at
///     delta_c = delta_0 [x_t + x_t / (x_t - 1)] = 7.2 delta_0,   T_t = sigma_c x_t e^(1-x_t) = 0.040 sigma_c     (3)
/// so traction and slope stay continuous and nothing snaps at the end. delta_0 makes the whole area, tail included, the
/// toughness that was asked for:
///     G_c = sigma_c delta_0 {e [1 - (1 + x_t) e^-x_t] + x_t^2 e^(1-x_t) / (2 (x_t - 1))}           (4)
/// which is 0.8 % more delta_0 than the endless law has.
class Exponential final : public TractionLaw {
 public:
  Exponential(double strength, double toughness)
      : strength_(strength),
        toughness_(toughness),
        length_(toughness / (strength * (body(tail_start) + 0.5 * tail_traction() * (tail_end - tail_start)))) {}

  double traction(double opening) const override {
    const double x = opening / length_;
    if (x < tail_start) return strength_ * x * std::exp(1.0 - x);
    return opening < critical_opening() ? strength_ * tail_traction() * (tail_end - x) / (tail_end - tail_start) : 0.0;
  }
  double slope(double opening) const override {
    const double x = opening / length_;
    if (x < tail_start) return strength_ / length_ * (1.0 - x) * std::exp(1.0 - x);
    return opening < critical_opening() ? -strength_ / length_ * tail_traction() / (tail_end - tail_start) : 0.0;
  }
  double area(double opening) const override {
    const double x = opening / length_;
    if (x < tail_start) return strength_ * length_ * body(x);
    if (opening >= critical_opening()) return toughness_;
    return toughness_ -
           0.5 * strength_ * length_ * tail_traction() * (tail_end - x) * (tail_end - x) / (tail_end - tail_start);
  }
  double strength() const override { return strength_; }
  double critical_opening() const override { return tail_end * length_; }
  double toughness() const override { return toughness_; }

  /// delta_0, the opening of the peak, mm.
  double peak_opening() const { return length_; }

 private:
  static constexpr double tail_start = 6.0;
  static constexpr double tail_end = tail_start + tail_start / (tail_start - 1.0);
  static double tail_traction() { return tail_start * std::exp(1.0 - tail_start); }
  /// Eq. (2) over sigma_c delta_0; expm1 saves half the digits that the plain form loses at small x.
  static double body(double x) { return -std::numbers::e * (std::expm1(-x) + x * std::exp(-x)); }

  double strength_, toughness_, length_;
};

TractionLawKind exponential();

}  // namespace kerf::laws
