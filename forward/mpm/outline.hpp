#pragma once

#include <array>
#include <cstddef>

#include "forward/scene/tool_face.hpp"

namespace kerf::forward {

/// Where a point stands to a rigid body: signed distance (negative inside) with the outward normal there.
struct Touch {
  double distance, normal_x, normal_y;
  ToolFace face;
};

/// A convex rigid body: the intersection of half-planes whose corners may be rounded. Distance and normal are exact for
/// points inside and near the surface. A tool with hollow corners, such as rake face and chip breaker, is several
/// bodies: a point in the corner feels both.
class Outline {
 public:
  /// Half-plane through a point with this outward normal, in the order in which the outline is walked.
  void add_plane(double x, double y, double normal_x, double normal_y, ToolFace face);
  /// Rounds the corner between the last plane and the one to be added next.
  void add_round(double centre_x, double centre_y, double radius, ToolFace face);
  /// The body does not exist ahead of this x.
  void end_at(double x) { end_ = x; }

  Touch touch(double x, double y) const;

 private:
  struct Plane {
    double normal_x, normal_y, offset;
    ToolFace face;
  };
  struct Round {
    std::size_t after;  ///< the plane before it
    double x, y, radius;
    ToolFace face;
  };
  static constexpr std::size_t most = 4;
  std::array<Plane, most> planes_{};
  std::array<Round, most> rounds_{};
  std::size_t plane_count_ = 0, round_count_ = 0;
  double end_ = 1e300;
};

}  // namespace kerf::forward
