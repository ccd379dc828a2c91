#pragma once

#include <array>
#include <optional>
#include <vector>

namespace kerf::forward::bodies {

struct Place {
  double x, y;  ///< mm
};

/// What a body fills: a rectangle, turned about its lower left corner; with a disc, what both have in common.
struct Shape {
  double left, bottom, width, height;  ///< mm
  double angle = 0;                    ///< rad, anticlockwise
  struct Disc {
    double x, y, radius;
  };
  std::optional<Disc> disc;

  /// Of a place in the rectangle's own frame, which begins at its lower left corner.
  Place place(double along, double up) const;
  /// Is this place inside, by more than `margin`?
  bool contains(const Place& at, double margin = 0) const;
  std::array<Place, 4> corners() const;
  /// Of the disc, or of the rectangle.
  Place middle() const { return disc ? Place{disc->x, disc->y} : place(0.5 * width, 0.5 * height); }
};

/// A part of a body: where its centre lies, and its volume per unit width, mm^2.
struct Part {
  Place at;
  double volume;
};

/// Divides a shape by a lattice of its own whose spacing divides the rectangle's sides and is next to the given one.
/// Parts that the disc's edge cuts keep what lies inside, at its centre, so that the edge is no staircase.
std::vector<Part> divide(const Shape& shape, double spacing_x, double spacing_y);

}  // namespace kerf::forward::bodies
