#pragma once

#include "models/laws/piecewise_linear.hpp"

namespace kerf::laws {

/// Sawtooth (triangular) cohesive law, Geubelle & Baylor 1998, the mode II law of Nairn 2016:
///     T = sigma_c delta / delta_1                             up to delta_1 = peak delta_c          (1)
///     T = sigma_c (delta_c - delta) / (delta_c - delta_1)     from there to delta_c                 (2)
///     G_c = sigma_c delta_c / 2, whatever the peak                                                  (3)
/// Nothing is dissipated before the peak. The share `peak` sets the stiffness of the intact plane, sigma_c / delta_1:
/// small shares are stiff and bound the time step, large ones make the uncut plane compliant. The default of a tenth
/// starts with 10 sigma_c / delta_c, the order of the cubic law's 6.75.
class Sawtooth final : public PiecewiseLinear {
 public:
  Sawtooth(double strength, double toughness, double peak)
      : PiecewiseLinear({{.opening = peak * 2.0 * toughness / strength, .traction = strength},
                         {.opening = 2.0 * toughness / strength, .traction = 0.0}}) {}
};

TractionLawKind sawtooth();

}  // namespace kerf::laws
