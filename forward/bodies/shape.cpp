#include "forward/bodies/shape.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::forward::bodies {

Place Shape::place(double along, double up) const {
  if (angle == 0.0) return {left + along, bottom + up};
  const double c = std::cos(angle), s = std::sin(angle);
  return {left + c * along - s * up, bottom + s * along + c * up};
}

bool Shape::contains(const Place& at, double margin) const {
  if (disc && std::hypot(at.x - disc->x, at.y - disc->y) >= disc->radius - margin) return false;
  const double c = std::cos(angle), s = std::sin(angle);
  const double along = c * (at.x - left) + s * (at.y - bottom), up = c * (at.y - bottom) - s * (at.x - left);
  return along > margin && along < width - margin && up > margin && up < height - margin;
}

std::array<Place, 4> Shape::corners() const {
  return {place(0, 0), place(width, 0), place(width, height), place(0, height)};
}

std::vector<Part> divide(const Shape& shape, double spacing_x, double spacing_y) {
  const auto count = [](double size, double spacing) {
    return static_cast<int>(std::max(1L, std::lround(size / spacing)));
  };
  const int along = count(shape.width, spacing_x), up = count(shape.height, spacing_y);
  const double dx = shape.width / along, dy = shape.height / up;
  std::vector<Part> parts;
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < along; ++i) {
      if (!shape.disc) {
        parts.push_back({shape.place(dx * (i + 0.5), dy * (j + 0.5)), dx * dy});
        continue;
      }
      constexpr int samples = 32;  // along each side
      int inside = 0;
      Place sum{0, 0};
      for (int n = 0; n < samples; ++n)
        for (int m = 0; m < samples; ++m) {
          const Place at = shape.place(dx * (i + (m + 0.5) / samples), dy * (j + (n + 0.5) / samples));
          if (std::hypot(at.x - shape.disc->x, at.y - shape.disc->y) >= shape.disc->radius) continue;
          ++inside;
          sum = {sum.x + at.x, sum.y + at.y};
        }
      if (inside > 0) parts.push_back({{sum.x / inside, sum.y / inside}, dx * dy * inside / (samples * samples)});
    }
  return parts;
}

}  // namespace kerf::forward::bodies
