#pragma once

#include <vector>

#include "models/chip/plastic_bending.hpp"

namespace kerf::chip {

/// The bent chip between crack tip and tool, from the elastica: at the angle x, C(k(x)) = N A(theta - x), Eq. (6) taken
/// from any section instead of the root, and ds = dx / (k kappa_y). The root's section turns about the crack tip.
struct ChipShape {
  struct Point {
    double x, y;  ///< mm, crack tip at the origin, tool behind it at negative x
  };
  std::vector<Point> lower_face;  ///< the face that slides on the tool, from the crack tip to the contact
  double contact_length;          ///< arc of the axis from crack tip to contact, mm
  double tip_gap;                 ///< how far the crack tip runs ahead of the tool's tip, mm
  double curl_radius;             ///< of the chip's axis after elastic unloading, mm; infinite when nothing yielded
  bool touching;                  ///< the contact is nearer to the crack tip than half the chip's height, the least
                                  ///< length a beam can resolve: the tool works at the crack tip itself
};

/// `k` is root_curvature(chip). `sections` points are laid along the lower face.
ChipShape chip_shape(const BendingChip<double>& chip, double k, int sections = 48);

}  // namespace kerf::chip
