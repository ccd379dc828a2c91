#pragma once

#include <cmath>

#include "models/laws/material_point.hpp"

namespace kerf::laws {

/// One material point driven by velocity gradients, with the work done on it (trapezoid of stress and strain
/// increment).
struct Point {
  double xx = 0, yy = 0, zz = 0, xy = 0, plastic_strain = 0, axis_x = 1, axis_y = 0, work = 0;

  template <class Law>
  bool drive(const Law& law, double l_xx, double l_xy, double l_yx, double l_yy) {
    const double before = rate(l_xx, l_xy, l_yx, l_yy);
    // Seven of the eight lanes rest.
    const StrainIncrement l{Lanes{l_xx}, Lanes{l_xy}, Lanes{l_yx}, Lanes{l_yy}};
    MaterialPoints points{Lanes{xx}, Lanes{yy}, Lanes{zz}, Lanes{xy}, Lanes{plastic_strain}, all_lanes(1.0), Lanes{}};
    points.axis_x[0] = axis_x;
    points.axis_y[0] = axis_y;
    const bool sound = law.update(l, points);
    xx = points.xx[0];
    yy = points.yy[0];
    zz = points.zz[0];
    xy = points.xy[0];
    plastic_strain = points.plastic_strain[0];
    axis_x = points.axis_x[0];
    axis_y = points.axis_y[0];
    work += 0.5 * (before + rate(l_xx, l_xy, l_yx, l_yy));
    return sound;
  }

  /// Pulls along x by d_xx with no stress across: finds the strain along y by secants.
  template <class Law>
  void pull_along_x(const Law& law, double d_xx) {
    const Point start = *this;
    const auto across = [&](double d_yy) {
      *this = start;
      drive(law, d_xx, 0, 0, d_yy);
      return yy;
    };
    double a = -d_xx, b = 0.0, at_a = across(a), at_b = across(b);
    for (int i = 0; i < 100 && std::abs(at_b) > 1e-12; ++i) {
      const double c = b - at_b * (b - a) / (at_b - at_a);
      a = b;
      at_a = at_b;
      b = c;
      at_b = across(b);
    }
  }

  double equivalent() const {
    const double mean = (xx + yy + zz) / 3.0;
    const double a = xx - mean, b = yy - mean, c = zz - mean;
    return std::sqrt(1.5 * (a * a + b * b + c * c + 2.0 * xy * xy));
  }
  StressPoint stress() const { return {.xx = xx, .yy = yy, .zz = zz, .xy = xy, .axis_x = axis_x, .axis_y = axis_y}; }

 private:
  double rate(double l_xx, double l_xy, double l_yx, double l_yy) const {
    return xx * l_xx + yy * l_yy + xy * (l_xy + l_yx);
  }
};

/// Part of the work that is neither stored nor dissipated after a path of uniform steps.
template <class Law>
double unexplained_work(const Law& law, int steps) {
  Point point;
  for (int i = 0; i < steps; ++i) point.drive(law, 0.10 / steps, 0.3 / steps, -0.1 / steps, -0.05 / steps);
  return std::abs(point.work - law.elastic_energy(point.stress()) - law.plastic_work(point.plastic_strain)) /
         point.work;
}

}  // namespace kerf::laws
