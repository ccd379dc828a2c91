#pragma once

#include "models/laws/piecewise_linear.hpp"

namespace kerf::laws {

/// Trilinear cohesive law (Nairn 2016): initiation under a high peak, then a long tail of bridging,
///     (0, 0) -> (delta_1, sigma_c) -> (delta_2, sigma_b) -> (delta_c, 0)                     (1)
///     G_init = (sigma_c delta_2 - sigma_b delta_1) / 2,   G_b = sigma_b delta_c / 2          (2)
///     G = G_init + G_b                                                                       (3)
/// (3) is the exact area; (2) gives G_b the triangle (0, 0), (0, sigma_b), (delta_c, 0) and G_init the rest, so a
/// bridging stress fixes delta_c = 2 G_b / sigma_b whatever the initiation. Assumes 0 < delta_1 < delta_2 < delta_c and
/// 0 < sigma_b < sigma_c; without bridging the law is the sawtooth.
///
/// The opening of the peak matters little for G but not for the force: moving delta_1 / delta_2 through its range
/// changed the cutting force of a bridged wood by 8 %. So nothing is assumed for it; 0.1 is a usual choice.
class Trilinear final : public PiecewiseLinear {
 public:
  struct Shape {
    double strength;          ///< sigma_c, MPa
    double peak_opening;      ///< delta_1, mm
    double bridging_stress;   ///< sigma_b, MPa
    double knee_opening;      ///< delta_2, mm
    double critical_opening;  ///< delta_c, mm
  };

  explicit Trilinear(const Shape& shape)
      : PiecewiseLinear({{.opening = shape.peak_opening, .traction = shape.strength},
                         {.opening = shape.knee_opening, .traction = shape.bridging_stress},
                         {.opening = shape.critical_opening, .traction = 0.0}}),
        shape_(shape) {}

  /// The shape behind any five independent ones of: strength, peak_opening, bridging_stress, knee_opening,
  /// critical_opening, initiation_toughness, bridging_toughness, toughness (N/mm) and peak = delta_1 / delta_2. Throws
  /// InputError that says what was given and what is missing, too much or impossible.
  static Shape complete(const Values& values);

  const Shape& shape() const { return shape_; }
  double initiation_toughness() const {
    return 0.5 * (shape_.strength * shape_.knee_opening - shape_.bridging_stress * shape_.peak_opening);
  }
  double bridging_toughness() const { return 0.5 * shape_.bridging_stress * shape_.critical_opening; }

 private:
  Shape shape_;
};

TractionLawKind trilinear();

}  // namespace kerf::laws
