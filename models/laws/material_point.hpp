#pragma once

#include "models/laws/lanes.hpp"

namespace kerf::laws {

/// Velocity gradient times the time step, l_ij = dt d v_i / d x_j, of eight material points.
struct StrainIncrement {
  Lanes xx, xy, yx, yy;
};

/// What the material laws update: Kirchhoff stress (MPa) in the frame of the grid, the equivalent plastic strain, and
/// the unit vector of the material's x axis, of eight material points. Laws without axes never look at the last two.
struct MaterialPoints {
  Lanes xx, yy, zz, xy, plastic_strain, axis_x, axis_y;
};

/// Stress of one point in the frame of the grid, with the material's x axis.
struct StressPoint {
  double xx, yy, zz, xy;
  double axis_x = 1.0, axis_y = 0.0;
};

/// A symmetric tensor in the plane, of eight material points: half the trace, half of xx - yy, and xy. A turn leaves
/// the first alone and turns the other two by twice its angle.
struct InPlane {
  Lanes mean, half, shear;

  static InPlane of(Lanes xx, Lanes yy, Lanes xy) { return {0.5 * (xx + yy), 0.5 * (xx - yy), xy}; }
  Lanes xx() const { return mean + half; }
  Lanes yy() const { return mean - half; }
  /// Its components along axes turned by the angle of the unit vector (c, s).
  InPlane seen_from(Lanes c, Lanes s) const {
    const Lanes cos = c * c - s * s, sin = 2.0 * c * s;
    return {mean, cos * half + sin * shear, cos * shear - sin * half};
  }
};

/// The rotation of one step: c and s of the spin (l_yx - l_xy)/2 by the half-angle tangent, so c^2 + s^2 = 1 exactly in
/// real arithmetic whatever the step, and the angle is right to the third order.
struct StepRotation {
  Lanes c, s;
};
inline StepRotation step_rotation(Lanes l_xy, Lanes l_yx) {
  const Lanes half_spin = 0.25 * (l_yx - l_xy);
  const Lanes scale = reciprocal(1.0 + half_spin * half_spin);
  return {.c = (1.0 - half_spin * half_spin) * scale, .s = 2.0 * half_spin * scale};
}

}  // namespace kerf::laws
