#pragma once

#include <array>
#include <variant>

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {

/// How a nodal value spreads, along one direction: w_i of the three nodes around a point, f in [0.5, 1.5) cells from
/// the first of them, and dw_i/df. All are hats, w(d) = 1 - |d|, seen through a window: of no width (linear), of the
/// width of a particle (uGIMP, Bardenhagen & Kober 2004), of a cell (quadratic B-spline).
///
/// A shape function is a struct like these, and one line in `ShapeFunction`.
struct QuadraticSpline {
  static constexpr const char* name = "spline";
  static QuadraticSpline of(int) { return {}; }

  void weigh(Lanes f, std::array<Lanes, 3>& weight, std::array<Lanes, 3>& slope) const {
    const Lanes g = f - 1.0, low = 0.5 - g, high = 0.5 + g;
    weight = {0.5 * low * low, 0.75 - g * g, 0.5 * high * high};
    slope = {-low, -2.0 * g, high};
  }
  /// The weights of one point.
  Quad row(double f) const {
    constexpr Quad a{1.125, -0.25, 0.125, 0.0}, b{-1.5, 2.0, -0.5, 0.0}, c{0.5, -1.0, 0.5, 0.0};
    return a + f * (b + f * c);
  }
};

struct Linear {
  static constexpr const char* name = "linear";
  static Linear of(int) { return {}; }

  void weigh(Lanes f, std::array<Lanes, 3>& weight, std::array<Lanes, 3>& slope) const {
    const auto left = f < 1.0, on_node = abs(f - 1.0) < 1e-9;
    const Lanes one = all_lanes(1.0), half = all_lanes(0.5), none{};
    weight = {left ? 1.0 - f : none, left ? f : 2.0 - f, left ? none : f - 1.0};
    // On a node the mean of both sides, as of a window that closes.
    slope = {on_node ? -half
             : left  ? -one
                     : none,
             on_node ? none
             : left  ? one
                     : -one,
             on_node ? half
             : left  ? none
                     : one};
  }
  Quad row(double f) const { return f < 1.0 ? Quad{1.0 - f, f, 0.0, 0.0} : Quad{0.0, 2.0 - f, f - 1.0, 0.0}; }
};

/// Particles keep the width that they start with (uniform GIMP), half of it in cells.
struct Ugimp {
  double half;
  static constexpr const char* name = "uGIMP";
  static Ugimp of(int particles_per_cell_side) { return {0.5 / particles_per_cell_side}; }

  void weigh(Lanes f, std::array<Lanes, 3>& weight, std::array<Lanes, 3>& slope) const {
    const double per = 0.5 / half;
    for (std::size_t i = 0; i < 3; ++i) {
      const Lanes low = f - (static_cast<double>(i) + half), high = f - (static_cast<double>(i) - half);
      weight[i] = per * (integral(high) - integral(low));
      slope[i] = per * (hat(high) - hat(low));
    }
  }
  Quad row(double f) const {
    std::array<Lanes, 3> weight, slope;
    weigh(all_lanes(f), weight, slope);
    return Quad{weight[0][0], weight[1][0], weight[2][0], 0.0};
  }

 private:
  static Lanes hat(Lanes d) {
    const Lanes r = abs(d);
    return r < 1.0 ? 1.0 - r : Lanes{};
  }
  /// Of the hat, from 0 to d.
  static Lanes integral(Lanes d) {
    const Lanes r = abs(d), s = r < 1.0 ? r : all_lanes(1.0), half_area = s - 0.5 * s * s;
    return d < 0.0 ? -half_area : half_area;
  }
};

using ShapeFunction = std::variant<QuadraticSpline,  //
                                   Ugimp,            //
                                   Linear>;

}  // namespace kerf::forward
