#pragma once

#include <cmath>

#include "models/chip/closed_form.hpp"
#include "models/chip/rake_face.hpp"

namespace kerf::chip {

// Williams' chip on a shear plane whose angle minimises the cutting force (J. G. Williams, Y. Patel and
// B. R. K. Blackman, Eng. Fract. Mech. 77 (2010) 293). No shear angle need be measured; friction is T = G_a + mu N.
//
//     F_t = Z F_c + g,                              g = G_a / (cos alpha + mu sin alpha)                     (3)
//     F_c = G_c + sigma_y h (Z + sqrt(1 + Z^2 + H)),    cot phi = Z + sqrt(1 + Z^2 + H)                      (4)
//     H   = 2 [g + G_c (Z + tan alpha)] / (sigma_y h)
//
// Written below without the division by sigma_y h, so that it holds down to zero depth: F_c -> G_c, and with friction
// or adhesion it leaves that value as a square root of the depth.

template <class T>
struct ShearPlane {
  ToolForces<T> forces;  ///< on the rake face
  T radicand;            ///< under the square root; negative means no solution (a fit may stray there)
};

/// Eqs. (3) and (4). Depth in mm, rake in rad, yield stress in MPa, toughness and adhesion in N/mm.
template <class T>
ShearPlane<T> shear_minimised(double depth, double rake, const T& yield_stress, const T& toughness, const T& friction,
                              const T& adhesion) {
  using std::sqrt;
  const T slope = force_slope(friction, rake);
  const T offset = adhesion_offset(adhesion, friction, rake);
  const T shear = yield_stress * depth;
  const T radicand =
      shear * shear * (1.0 + slope * slope) + 2.0 * shear * (offset + toughness * (slope + std::tan(rake)));
  const T cutting = toughness + shear * slope + (radicand > 0.0 ? sqrt(radicand) : T(0.0));
  return {{cutting, slope * cutting + offset}, radicand};
}

ClosedForm shear_minimised_model();

}  // namespace kerf::chip
