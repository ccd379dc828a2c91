#pragma once

#include <cmath>

#include "models/chip/closed_form.hpp"
#include "models/chip/rake_face.hpp"

namespace kerf::chip {

// Williams' balance of the forces on a chip that shears at a known angle phi:
//
//     sigma_y h / (2 sin phi) = (F_c - G_c) cos phi - (F_t + G_c tan alpha) sin phi                          (2)
//
// With phi measured this is linear in sigma_y and G_c and needs no law of friction: it is the fit's equation. To
// predict, F_t is eliminated with the friction line (3).

/// Shear angle from the chip's thickness over the depth of cut: tan phi = cos alpha / (h_c/h - sin alpha).
inline double shear_angle_from_chip_ratio(double chip_ratio, double rake) {
  return std::atan2(std::cos(rake), chip_ratio - std::sin(rake));
}

/// Eq. (2) solved for the cutting force; the friction line gives the transverse one. Units as in shear_minimised.
/// Needs cot(phi) > Z: at larger angles no force shears the chip.
template <class T>
ToolForces<T> chip_force(double depth, double rake, double shear_angle, const T& yield_stress, const T& toughness,
                         const T& friction, const T& adhesion) {
  const double sin_phi = std::sin(shear_angle);
  const double cos_phi = std::cos(shear_angle);
  const T slope = force_slope(friction, rake);
  const T offset = adhesion_offset(adhesion, friction, rake);
  const T work =
      yield_stress * depth / (2.0 * sin_phi) + toughness * (cos_phi + std::tan(rake) * sin_phi) + offset * sin_phi;
  const T cutting = work / (cos_phi - slope * sin_phi);
  return {cutting, slope * cutting + offset};
}

ClosedForm chip_force_model();

}  // namespace kerf::chip
