// The rigid parts of the tool against brute force: distances to a boundary that is drawn here, segment by segment, from
// the scene's numbers alone.
#include "forward/mpm/outline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "forward/mpm/tool.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using std::numbers::pi;

struct Point {
  double x, y;
};

/// A boundary with the body on its left, as short straight segments.
class Drawn {
 public:
  explicit Drawn(Point start) : points_{start} {}
  Drawn& line(Point to) {
    points_.push_back(to);
    return *this;
  }
  /// From one angle (of the radius, ccw from +x) to another, in pieces that stay within `sagitta` of the arc.
  Drawn& arc(Point centre, double radius, double from, double to) {
    constexpr int pieces = 4000;
    for (int i = 0; i <= pieces; ++i) {
      const double angle = from + (to - from) * i / pieces;
      points_.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
    }
    const double step = (to - from) / pieces;
    sagitta_ = std::max(sagitta_, radius * step * step / 8);
    return *this;
  }
  double sagitta() const { return sagitta_; }

  /// Negative inside.
  double distance(Point p) const {
    double least = std::numeric_limits<double>::infinity(), sign = 1;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      const Point a = points_[i], b = points_[i + 1];
      const double ux = b.x - a.x, uy = b.y - a.y, length2 = ux * ux + uy * uy;
      if (length2 == 0) continue;
      const double t = std::clamp(((p.x - a.x) * ux + (p.y - a.y) * uy) / length2, 0.0, 1.0);
      const double d = std::hypot(p.x - a.x - t * ux, p.y - a.y - t * uy);
      if (d >= least) continue;
      least = d;
      // Nearest to a corner of a convex body are points outside only, and every segment there says so.
      sign = ux * (p.y - a.y) - uy * (p.x - a.x) > 0 ? -1 : 1;
    }
    return sign * least;
  }

 private:
  std::vector<Point> points_;
  double sagitta_ = 1e-12;
};

/// One rigid part with its boundary and the corner that it turns around.
struct Body {
  std::string name;
  Outline outline;
  Drawn boundary;
  Point corner;
  double radius;
};

Outline outline_of(const Scene& scene, const std::string& contact, double tip_radius = 0) {
  for (const Contact& c : contacts(scene))
    if (c.name == contact) return c.outline(scene, tip_radius);
  throw std::out_of_range("this tool has no " + contact);
}

constexpr double far = 50;

Body round_rake() {
  Scene scene = kerf::testing::shipped("verification_45");  // rake 45 deg
  scene.tool.separation = 0;  // the arc as a whole; the wall before a dead zone has a test of its own
  const double r = 0.3, a = pi / 4;
  // The circle touches the plane y = 0 and the rake plane x cos a + y sin a = 0: the centre is at height r and at
  // distance r behind the rake plane.
  const Point c{-r * (1 + std::sin(a)) / std::cos(a), r};
  const Point up{-std::sin(a), std::cos(a)};
  const Point high{c.x + r * std::cos(a) + far * up.x, c.y + r * std::sin(a) + far * up.y};
  return {"rake with round tip", outline_of(scene, "rake face", r),
          Drawn({c.x - far, 0}).line({c.x, 0}).arc(c, r, -pi / 2, a).line(high), c, r};
}

Body tip_with_dead_zone() {
  Scene scene = kerf::testing::shipped("verification_45");
  scene.tool.separation = 115 * pi / 180;
  const double r = 0.3, a = pi / 4, from = -pi / 2 + scene.tool.separation;
  const Point c{-r * (1 + std::sin(a)) / std::cos(a), r};
  const Point low{c.x + r * std::cos(from) + far * std::sin(from), c.y + r * std::sin(from) - far * std::cos(from)};
  const Point high{c.x + r * std::cos(a) - far * std::sin(a), c.y + r * std::sin(a) + far * std::cos(a)};
  return {"round tip with a dead zone", outline_of(scene, "rake face", r), Drawn(low).arc(c, r, from, a).line(high), c,
          r};
}

Body round_underside() {
  const Scene scene = kerf::testing::shipped("verification_45");  // clearance 12 deg
  const double r = 0.3, a = pi / 4, clearance = 12 * pi / 180;
  const Point c{-r * (1 + std::sin(a)) / std::cos(a), r};
  const double from = -pi / 2 - clearance, to = -pi / 6;  // 60 deg ahead of straight down
  const Point start{c.x + r * std::cos(from) - far * std::cos(clearance),
                    c.y + r * std::sin(from) + far * std::sin(clearance)};
  const Point end{c.x + r * std::cos(to) + far * 0.5, c.y + r * std::sin(to) + far * std::sqrt(0.75)};
  return {"underside of a round tip", outline_of(scene, "underside", r), Drawn(start).arc(c, r, from, to).line(end), c,
          r};
}

Body underside_with_lead_in() {
  Scene scene = kerf::testing::shipped("verification_45");
  const double clearance = scene.tool.clearance, lead_in = 20 * pi / 180;
  scene.tool.lead_in = lead_in;
  const Point tip{0, 0}, start{-far * std::cos(clearance), far * std::sin(clearance)};
  const Point end{far * std::cos(lead_in), far * std::sin(lead_in)};
  return {"underside with a lead-in", outline_of(scene, "underside"), Drawn(start).line(tip).line(end), tip, 0};
}

Body worn_edge() {
  Scene scene = kerf::testing::shipped("verification_45");
  const double r = 0.5, press_in = 0.02, clearance = scene.tool.clearance;
  scene.edge_contact = EdgeContact{.press_in = press_in, .edge_radius = r, .friction = 0};
  // Lowest point `press_in` below the tip's height, and the arc passes through the tip at the separation angle.
  const double separation = std::acos(1 - press_in / r);
  const Point c{-std::sqrt(r * r - (r - press_in) * (r - press_in)), r - press_in};
  const double from = -pi / 2 - clearance, to = -pi / 2 + separation;
  const Point start{c.x + r * std::cos(from) - far * std::cos(clearance),
                    c.y + r * std::sin(from) + far * std::sin(clearance)};
  const Point end{far * std::cos(separation), far * std::sin(separation)};  // the tangent at the tip
  return {"worn edge", outline_of(scene, "edge"), Drawn(start).arc(c, r, from, to).line(end), c, r};
}

Body breaker() {
  Scene scene = kerf::testing::shipped("plane_breaker");
  scene.chip_breaker = ChipBreaker{.distance = 1.5, .angle = -10 * pi / 180, .land = 0.7};
  const double a = scene.tool.rake, b = -10 * pi / 180;
  const Point foot{-1.5 * std::sin(a), 1.5 * std::cos(a)};
  const Point face{-std::sin(b), std::cos(b)};  // up the breaker
  const Point end{foot.x + 0.7 * face.x, foot.y + 0.7 * face.y};
  return {"chip breaker", outline_of(scene, "chip breaker"),
          Drawn({foot.x - far * face.x, foot.y - far * face.y})
              .line(end)
              .line({end.x - far * std::cos(b), end.y - far * std::sin(b)}),
          end, 0};
}

Body sole() {
  Scene scene = kerf::testing::shipped("plane_breaker");
  scene.sole = Sole{.opening = 1.2, .corner_radius = 0.1};
  const double h = scene.cut.depth;
  const Point c{1.3, h + 0.1};
  return {"sole", outline_of(scene, "sole"),
          Drawn({1.2, far}).line({1.2, c.y}).arc(c, 0.1, -pi, -pi / 2).line({far, h}), c, 0.1};
}

Body nose_bar() {
  Scene scene = kerf::testing::shipped("plane_breaker");
  scene.nose_bar = NoseBar{.lead = 0.8, .radius = 0.4, .compression = 0.03};
  const Point c{0.8, scene.cut.depth - 0.03 + 0.4};
  return {"nose bar", outline_of(scene, "nose bar"),
          Drawn({0.4, far}).line({0.4, c.y}).arc(c, 0.4, -pi, 0).line({1.2, far}), c, 0.4};
}

std::vector<Body> bodies() {
  return {
      round_rake(), tip_with_dead_zone(), round_underside(), underside_with_lead_in(), worn_edge(), breaker(), sole(),
      nose_bar()};
}

/// Points around the corner, out to 1 mm from its surface and in to where the body is not hollowed out yet.
template <class Visit>
void each_point(const Body& body, Visit&& visit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> at(-1 - body.radius, 1 + body.radius);
  for (int i = 0; i < 400; ++i) visit(Point{body.corner.x + at(random), body.corner.y + at(random)});
}

TEST(Outline, DistanceIsThatToTheNearestPointOfTheSurface) {
  for (const Body& body : bodies())
    each_point(body, [&](Point p) {
      EXPECT_NEAR(body.outline.touch(p.x, p.y).distance, body.boundary.distance(p), 2 * body.boundary.sagitta() + 1e-9)
          << body.name << " at " << p.x << ", " << p.y;
    });
}

TEST(Outline, NormalIsAUnitVectorAndTheGradientOfTheDistance) {
  constexpr double e = 1e-6;
  for (const Body& body : bodies()) {
    int told = 0;
    each_point(body, [&](Point p) {
      const Touch touch = body.outline.touch(p.x, p.y);
      EXPECT_NEAR(std::hypot(touch.normal_x, touch.normal_y), 1, 1e-14) << body.name;
      const Touch right = body.outline.touch(p.x + e, p.y), left = body.outline.touch(p.x - e, p.y);
      const Touch up = body.outline.touch(p.x, p.y + e), down = body.outline.touch(p.x, p.y - e);
      for (const Touch& near : {right, left, up, down})  // deep inside, where two faces are equally far, it jumps
        if (std::hypot(near.normal_x - touch.normal_x, near.normal_y - touch.normal_y) > 1e-3) return;
      // Central differences: e^2/6 of the third derivative, at most 3/r^2 at r > 1 um around a sharp corner.
      EXPECT_NEAR((right.distance - left.distance) / (2 * e), touch.normal_x, 1e-6) << body.name;
      EXPECT_NEAR((up.distance - down.distance) / (2 * e), touch.normal_y, 1e-6) << body.name;
      ++told;
    });
    EXPECT_GT(told, 390) << body.name;
  }
}

/// On a circle around the corner, outside of the arc, distance changes by at most the way walked and the normal turns
/// no faster than the circle: neither jumps where an arc ends.
TEST(Outline, PassesContinuouslyOverTheEndsOfAnArc) {
  constexpr int steps = 20000;
  constexpr double step = 2 * pi / steps;
  for (const Body& body : bodies()) {
    const double around = body.radius > 0 ? 1.1 * body.radius : 0.05;
    const auto at = [&](int i) {
      return body.outline.touch(body.corner.x + around * std::cos(i * step),
                                body.corner.y + around * std::sin(i * step));
    };
    double turned = 0;
    for (int i = 0; i < steps; ++i) {
      const Touch here = at(i), next = at(i + 1);
      if (here.distance < 0 || next.distance < 0) continue;
      EXPECT_LE(std::abs(next.distance - here.distance), around * step * (1 + 1e-9)) << body.name << " " << i;
      const double turn = std::hypot(next.normal_x - here.normal_x, next.normal_y - here.normal_y);
      EXPECT_LE(turn, step * (1 + 1e-9)) << body.name << " " << i;
      turned += turn;
    }
    EXPECT_GT(turned, 0.1) << body.name;  // the arc was met
  }
}

TEST(Outline, NamesTheFaceThatIsTouched) {
  const Outline rake = round_rake().outline;
  EXPECT_EQ(rake.touch(-2, 2.1).face, ToolFace::rake);
  EXPECT_EQ(rake.touch(-0.3, 0.01).face, ToolFace::tip);
  EXPECT_EQ(rake.touch(-2, -0.1).face, ToolFace::tip);  // the plane behind the lowest point belongs to the round tip
  const Outline under = round_underside().outline;
  EXPECT_EQ(under.touch(-2, -0.1).face, ToolFace::bottom);
  EXPECT_EQ(under.touch(-0.6, -0.1).face, ToolFace::tip);
  const Outline lead_in = underside_with_lead_in().outline;
  EXPECT_EQ(lead_in.touch(-0.5, 0.2).face, ToolFace::bottom);
  EXPECT_EQ(lead_in.touch(0.5, 0.2).face, ToolFace::lead_in);
}

/// Ahead of a sharp tip there is no tool: a clearance plane that went on would press down the material before it.
TEST(Outline, ASharpUndersideExistsBehindTheTipOnly) {
  const Scene scene = kerf::testing::shipped("verification_45");
  const Outline under = outline_of(scene, "underside");
  const double c = 12 * pi / 180;
  for (double x = -1; x <= 0; x += 0.05)
    for (double y = -0.5; y <= 0.5; y += 0.05) {
      const Touch touch = under.touch(x, y);
      EXPECT_NEAR(touch.distance, -x * std::sin(c) - y * std::cos(c), 1e-14);
      EXPECT_EQ(touch.face, ToolFace::bottom);
    }
  for (const double y : {-0.5, 0.0, 1e-6, 0.5}) EXPECT_GT(under.touch(1e-9, y).distance, 1e100) << y;
}

}  // namespace
}  // namespace kerf::forward
