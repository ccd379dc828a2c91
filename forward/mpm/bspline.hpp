#pragma once

#include "models/laws/lanes.hpp"

namespace kerf::forward {

/// Four doubles: the masses of a row of three nodes and one over-read.
using Quad = double __attribute__((vector_size(32)));
inline void add_row(double* to, Quad values) {
  using Unaligned = double __attribute__((vector_size(32), aligned(8), may_alias));
  *reinterpret_cast<Unaligned*>(to) += values;
}
inline Lanes pairs(double x, double y) {
  return Lanes{x, y, x, y, x, y, 0.0, 0.0};
}

/// Quadratic B-spline over the three nodes next to a point. With f in [0.5, 1.5) the distance from the first of them:
///     w_0 = (3/2 - f)^2 / 2,   w_1 = 3/4 - (f - 1)^2,   w_2 = (f - 1/2)^2 / 2
/// Each w_i is a polynomial a + f (b + f c), so one expression fills all lanes.
struct Spline {
  int base;  ///< first of the three nodes
  double f;

  explicit Spline(double grid_coordinate)
      : base(static_cast<int>(grid_coordinate - 0.5)), f(grid_coordinate - static_cast<double>(base)) {}
  Spline(int first_node, double offset) : base(first_node), f(offset) {}

  /// Weights of three nodes with two interleaved components each: {w0, w0, w1, w1, w2, w2, 0, 0}.
  Lanes row_weights() const {
    constexpr Lanes a{1.125, 1.125, -0.25, -0.25, 0.125, 0.125, 0.0, 0.0};
    constexpr Lanes b{-1.5, -1.5, 2.0, 2.0, -0.5, -0.5, 0.0, 0.0};
    constexpr Lanes c{0.5, 0.5, -1.0, -1.0, 0.5, 0.5, 0.0, 0.0};
    return a + f * (b + f * c);
  }
  double weight(int node) const {
    const double g = f - 1.0;
    return node == 0 ? 0.5 * (0.5 - g) * (0.5 - g) : node == 1 ? 0.75 - g * g : 0.5 * (0.5 + g) * (0.5 + g);
  }
  double slope(int node) const { return node == 0 ? f - 1.5 : node == 1 ? 2.0 - 2.0 * f : f - 0.5; }
};

/// Sum over the three nodes of a row product: component 0 or 1.
inline double sum_x(Lanes row) {
  return row[0] + row[2] + row[4];
}
inline double sum_y(Lanes row) {
  return row[1] + row[3] + row[5];
}

}  // namespace kerf::forward
