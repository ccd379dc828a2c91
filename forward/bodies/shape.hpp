#pragma once

#include <array>
#include <optional>
#include <vector>

namespace kerf::forward::bodies {

struct Place {
  double x, y;  ///< mm
};

/// What a body fills: a rectangle, turned about its lower left corner; with a disc or a slab, what they have in common.
struct Shape {
  double left, bottom, width, height;  ///< mm
  double angle = 0;                    ///< rad, anticlockwise
  struct Disc {
    double x, y, radius;
  };
  std::optional<Disc> disc;
  /// What lies to the left of a line, no further from it than `thickness`; again at every multiple of `period`.
  struct Slab {
    double x, y, angle;        ///< a place on the line, and its direction, mm, rad
    double thickness, period;  ///< mm; infinite where the slab has no other face and comes but once
    bool contains(const Place& at, double margin) const;
  };
  std::optional<Slab> slab;

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
/// Parts that a disc's or a slab's edge cuts keep what lies inside, at its centre, so that the edge is no staircase.
std::vector<Part> divide(const Shape& shape, double spacing_x, double spacing_y);

/// A piece of an edge: its middle, its unit normal, its length, mm.
struct EdgePiece {
  Place at;
  double normal_x, normal_y, length;
};

/// Where two shapes meet, in pieces not longer than `longest`; normals point from a to b.
std::vector<EdgePiece> common_edge(const Shape& a, const Shape& b, double longest);

}  // namespace kerf::forward::bodies
