#pragma once

#include "models/laws/piecewise_linear.hpp"

namespace kerf::laws {

/// Linear softening: full bridging stress at once, then a straight loss (Hillerborg, Modeer & Petersson 1976), the law
/// behind the R-curve of a crack bridged by fibres or ligaments:
///     T = sigma_b (1 - delta / delta_c),   G_b = sigma_b delta_c / 2                         (1)
/// A jump from zero to sigma_b at zero opening is an infinite stiffness that no explicit step can follow. So the law
/// rises along a straight line over the share `rise` of delta_c and meets (1) shifted to end at the same delta_c:
///     T = sigma_b delta / (rise delta_c),   then   T = sigma_b (delta_c - delta) / ((1 - rise) delta_c)   (2)
/// which keeps sigma_b, delta_c and G_b exactly. The default rise of 0.02 moves no point of the softening branch by
/// more than 2 % of sigma_b.
class LinearSoftening final : public PiecewiseLinear {
 public:
  LinearSoftening(double strength, double toughness, double rise)
      : PiecewiseLinear({{.opening = rise * 2.0 * toughness / strength, .traction = strength},
                         {.opening = 2.0 * toughness / strength, .traction = 0.0}}) {}
};

TractionLawKind linear_softening();

}  // namespace kerf::laws
