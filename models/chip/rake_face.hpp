#pragma once

#include <cmath>

namespace kerf::chip {

// Forces between tool and chip, per width of cut in N/mm (theory: geometry and signs).
//
// The rake face leans by the rake angle alpha from the normal of the crack plane; its normal into the chip is
// (cos alpha, sin alpha). N presses on the chip, T = G_a + mu N drags along the face:
//
//     F_c = N cos alpha + T sin alpha        F_t = T cos alpha - N sin alpha
//
// F_t is positive when the work pushes the tool away. Templates, so that a fit can differentiate them.

/// False when friction locks the chip to the face: no normal force can then move the tool forward.
template <class T>
bool chip_can_slide(const T& friction, double rake) {
  return std::cos(rake) + friction * std::sin(rake) > 0.0;
}

/// Z in F_t = Z F_c + G_a / (cos alpha + mu sin alpha), Eq. (3): tan(beta - alpha) with tan beta = mu.
template <class T>
T force_slope(const T& friction, double rake) {
  const double tan_rake = std::tan(rake);
  return (friction - tan_rake) / (1.0 + friction * tan_rake);
}

/// The inverse of force_slope: the coefficient of friction behind a measured slope F_t against F_c.
inline double friction_from_slope(double slope, double rake) {
  const double tan_rake = std::tan(rake);
  return (slope + tan_rake) / (1.0 - slope * tan_rake);
}

/// Intercept G_a / (cos alpha + mu sin alpha) of the friction line, Eq. (3).
template <class T>
T adhesion_offset(const T& adhesion, const T& friction, double rake) {
  return adhesion / (std::cos(rake) + friction * std::sin(rake));
}

/// Cutting and transverse force per width, N/mm.
template <class T>
struct ToolForces {
  T F_c;
  T F_t;
};

/// Adds a force F_b on the tool's bottom, normal to the crack plane, with the same Coulomb friction there: Eq. (1).
template <class T>
ToolForces<T> with_bottom_force(const ToolForces<T>& rake_face, const T& bottom_force, const T& friction) {
  return {rake_face.F_c + friction * bottom_force, rake_face.F_t + bottom_force};
}

}  // namespace kerf::chip
