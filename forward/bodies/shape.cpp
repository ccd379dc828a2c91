#include "forward/bodies/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kerf::forward::bodies {

Place Shape::place(double along, double up) const {
  if (angle == 0.0) return {left + along, bottom + up};
  const double c = std::cos(angle), s = std::sin(angle);
  return {left + c * along - s * up, bottom + s * along + c * up};
}

bool Shape::Slab::contains(const Place& at, double margin) const {
  double from = std::cos(angle) * (at.y - y) - std::sin(angle) * (at.x - x);
  const auto within = [&](double d) { return d > margin && d < thickness - margin; };
  if (!std::isfinite(period)) return within(from);
  from -= period * std::floor(from / period);
  return within(from) || within(from - period);
}

bool Shape::contains(const Place& at, double margin) const {
  if (slab && !slab->contains(at, margin)) return false;
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
  const double reach = 0.5 * std::hypot(dx, dy);
  const bool trimmed = shape.disc || shape.slab;
  std::vector<Part> parts;
  for (int j = 0; j < up; ++j)
    for (int i = 0; i < along; ++i) {
      const Place middle = shape.place(dx * (i + 0.5), dy * (j + 0.5));
      if (!trimmed || shape.contains(middle, reach)) {
        parts.push_back({middle, dx * dy});
        continue;
      }
      if (!shape.contains(middle, -reach)) continue;
      constexpr int samples = 32;  // along each side
      int inside = 0;
      Place sum{0, 0};
      for (int n = 0; n < samples; ++n)
        for (int m = 0; m < samples; ++m) {
          const Place at = shape.place(dx * (i + (m + 0.5) / samples), dy * (j + (n + 0.5) / samples));
          if (!shape.contains(at)) continue;
          ++inside;
          sum = {sum.x + at.x, sum.y + at.y};
        }
      if (inside > 0) parts.push_back({{sum.x / inside, sum.y / inside}, dx * dy * inside / (samples * samples)});
    }
  return parts;
}

namespace {

/// Calls visit(begin, end) for every straight side of a shape, which lies to the left.
template <class Visit>
void each_side(const Shape& shape, Visit&& visit) {
  const std::array<Place, 4> corners = shape.corners();
  for (std::size_t k = 0; k < 4; ++k) visit(corners[k], corners[(k + 1) % 4]);
  if (!shape.slab) return;
  const Shape::Slab& slab = *shape.slab;
  const double c = std::cos(slab.angle), s = std::sin(slab.angle);
  const auto above = [&](const Place& at) { return c * (at.y - slab.y) - s * (at.x - slab.x); };
  double least = above(corners[0]), most = least;
  for (const Place& corner : corners) {
    least = std::min(least, above(corner));
    most = std::max(most, above(corner));
  }
  // The part of the line at distance d that lies in the rectangle.
  const auto line = [&](double d, bool lower) {
    std::array<Place, 2> ends{};
    std::size_t found = 0;
    for (std::size_t k = 0; k < 4 && found < 2; ++k) {
      const Place &p = corners[k], &q = corners[(k + 1) % 4];
      const double from = above(p) - d, to = above(q) - d;
      if ((from < 0.0) == (to < 0.0)) continue;
      const double t = from / (from - to);
      ends[found++] = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
    }
    if (found < 2) return;
    const bool along = c * (ends[1].x - ends[0].x) + s * (ends[1].y - ends[0].y) > 0.0;
    visit(ends[along == lower ? 0 : 1], ends[along == lower ? 1 : 0]);
  };
  const bool repeated = std::isfinite(slab.period);
  const int first = repeated ? static_cast<int>(std::floor(least / slab.period)) : 0;
  const int last = repeated ? static_cast<int>(std::ceil(most / slab.period)) : 0;
  for (int k = first; k <= last; ++k) {
    const double d = repeated ? k * slab.period : 0.0;
    line(d, true);
    if (std::isfinite(slab.thickness)) line(d + slab.thickness, false);
  }
}

}  // namespace

std::vector<EdgePiece> common_edge(const Shape& a, const Shape& b, double longest) {
  std::vector<EdgePiece> pieces;
  const double inward = 1e-3 * longest;
  const auto add = [&](const EdgePiece& piece) {
    const auto beside = [&](double d) {
      return Place{piece.at.x + d * piece.normal_x, piece.at.y + d * piece.normal_y};
    };
    if (a.contains(beside(-inward)) && b.contains(beside(inward))) pieces.push_back(piece);
  };
  each_side(a, [&](const Place& begin, const Place& end) {
    const double dx = end.x - begin.x, dy = end.y - begin.y, length = std::hypot(dx, dy);
    const int count = static_cast<int>(std::ceil(length / longest));
    for (int k = 0; k < count; ++k) {
      const double t = (k + 0.5) / count;
      add({{begin.x + t * dx, begin.y + t * dy}, dy / length, -dx / length, length / count});
    }
  });
  if (!a.disc) return pieces;
  const double around = 2.0 * std::numbers::pi;
  const int count = static_cast<int>(std::ceil(around * a.disc->radius / longest));
  for (int k = 0; k < count; ++k) {
    const double phi = around * (k + 0.5) / count, c = std::cos(phi), s = std::sin(phi), r = a.disc->radius;
    add({{a.disc->x + r * c, a.disc->y + r * s}, c, s, around * r / count});
  }
  return pieces;
}

}  // namespace kerf::forward::bodies
