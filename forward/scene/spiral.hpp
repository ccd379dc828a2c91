#pragma once

#include <cmath>
#include <numbers>

namespace kerf::forward {

/// Where the log stands: it rolls under the tool as a wheel on a rail above it, so that the material that meets the
/// tip is at rest, as in a straight cut, and the axis keeps pace with the tool. Turning is counter-clockwise.
struct Roll {
  double x, y;              ///< its axis, mm
  double speed_x, speed_y;  ///< of the axis, mm/s
  double turn, spin;        ///< angle so far (rad) and angular velocity (rad/s)
  double velocity_x(double at_y) const { return speed_x - spin * (at_y - y); }
  double velocity_y(double at_x) const { return speed_y + spin * (at_x - x); }
};

/// The path of a crack that peels a log: the spiral of Archimedes r = R - h theta / 2 pi, one depth of cut h further in
/// after every turn. The length s along it, which the tool has travelled when it gets there, is that of the area
/// between the turns, h s = pi (R^2 - r^2); ds = r dtheta (1 + O(h^2/r^2)).
class Spiral {
 public:
  /// `radius` R at the start, below the layer, `depth` h; mm.
  Spiral(double radius, double depth) : radius_(radius), depth_(depth) {}

  double radius() const { return radius_; }
  double radius_at(double s) const { return std::sqrt(radius_ * radius_ - depth_ * s / std::numbers::pi); }
  /// Clockwise from the start, rad.
  double angle_at(double s) const { return 2.0 * std::numbers::pi / depth_ * (radius_ - radius_at(s)); }
  double turn_length() const { return std::numbers::pi * (2.0 * radius_ - depth_); }

  /// The log when the tool has travelled s: the path's point s is at (s, 0).
  Roll roll(double s, double speed) const {
    const double r = radius_at(s);
    return {s, -r, speed, speed * depth_ / (2.0 * std::numbers::pi * r), angle_at(s), speed / r};
  }
  struct Direction {
    double x, y;
  };
  /// The path's normal at s, out of the log, when the tool has travelled `travel`.
  Direction normal(double s, double travel) const {
    const double tilt = depth_ / (2.0 * std::numbers::pi * radius_at(s));
    const double angle = angle_at(s) - angle_at(travel) + tilt;
    return {std::sin(angle), std::cos(angle)};
  }

 private:
  double radius_, depth_;
};

}  // namespace kerf::forward
