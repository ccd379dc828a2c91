#include "forward/mpm/outline.hpp"

#include <cassert>
#include <cmath>

namespace kerf::forward {

void Outline::add_plane(double x, double y, double normal_x, double normal_y, ToolFace face) {
  assert(plane_count_ < most);
  planes_[plane_count_++] = {normal_x, normal_y, x * normal_x + y * normal_y, face};
}

void Outline::add_round(double centre_x, double centre_y, double radius, ToolFace face) {
  assert(plane_count_ > 0 && round_count_ < most);
  rounds_[round_count_++] = {plane_count_ - 1, centre_x, centre_y, radius, face};
}

Touch Outline::touch(double x, double y) const {
  if (x > end_) return {1e300, 0.0, 0.0, ToolFace::rake};
  for (std::size_t i = 0; i < round_count_; ++i) {
    const Round& round = rounds_[i];
    const Plane &before = planes_[round.after], &after = planes_[round.after + 1];
    const double dx = x - round.x, dy = y - round.y;
    // The arc answers for the directions between the normals of its neighbours.
    const double turn = before.normal_x * after.normal_y - before.normal_y * after.normal_x;
    const double from = before.normal_x * dy - before.normal_y * dx, to = dx * after.normal_y - dy * after.normal_x;
    const double r = std::hypot(dx, dy);
    if (turn * from >= 0.0 && turn * to >= 0.0 && r > 0.0) return {r - round.radius, dx / r, dy / r, round.face};
  }
  Touch nearest{-1e300, 0.0, 0.0, ToolFace::rake};
  for (std::size_t i = 0; i < plane_count_; ++i) {
    const Plane& plane = planes_[i];
    const double distance = x * plane.normal_x + y * plane.normal_y - plane.offset;
    if (distance > nearest.distance) nearest = {distance, plane.normal_x, plane.normal_y, plane.face};
  }
  return nearest;
}

}  // namespace kerf::forward
