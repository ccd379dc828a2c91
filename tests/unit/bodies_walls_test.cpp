// Mirror images at the walls of a box of bodies.
#include "forward/bodies/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/shipped_scene.hpp"

namespace kerf::forward::bodies {
namespace {

using kerf::testing::shipped_text;

struct Box {
  Scene scene = read_scene(Document::parse(shipped_text("interface_bar"), "box.toml"));
  State state = lay_out(scene);

  template <class Visit>
  void each_node(Visit&& visit) const {
    const Grid& grid = state.grid;
    for (int j = 0; j < grid.rows; ++j)
      for (int i = 0; i < grid.columns; ++i)
        visit(grid.node(i, j), grid.origin_x + i * grid.cell_x, grid.origin_y + j * grid.cell_y,
              i >= 2 && j >= 2 && i < grid.columns - 2 && j < grid.rows - 2);
  }
  /// Odd about the walls along their normal, even along them, as a motion without friction is.
  std::array<double, 2> smooth(double x, double y) const {
    const double p = std::numbers::pi * x / scene.length, q = std::numbers::pi * y / scene.height;
    return {std::sin(p) * std::cos(q), std::cos(p) * std::sin(q)};
  }
};

TEST(BodiesWalls, ImagesContinueASmoothMotion) {
  Box box;
  box.state.piston.speed = 3.0;
  VelocityField& field = box.state.bodies[0].field;
  // A piston moves what is before it in proportion.
  const auto velocity = [&](double x, double y) {
    std::array<double, 2> v = box.smooth(x, y);
    v[0] += box.state.piston.speed * x / box.scene.length;
    return v;
  };
  box.each_node([&](std::size_t node, double x, double y, bool inside) {
    for (std::size_t k = 0; k < 2; ++k) {
      field.change[2 * node + k] = inside ? box.smooth(x, y)[k] : 1e9;
      field.velocity[2 * node + k] = inside ? velocity(x, y)[k] : 1e9;
    }
  });
  mirror_change(box.state, box.scene, field);
  mirror_velocity(box.state, box.scene, field);
  box.each_node([&](std::size_t node, double x, double y, bool) {
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(field.change[2 * node + k], box.smooth(x, y)[k], 1e-12) << x << ' ' << y;
      EXPECT_NEAR(field.velocity[2 * node + k], velocity(x, y)[k], 1e-12) << x << ' ' << y;
    }
  });
}

TEST(BodiesWalls, FoldedForcesDoTheWorkOfAllForces) {
  Box box;
  VelocityField& field = box.state.bodies[0].field;
  box.each_node([&](std::size_t node, double x, double y, bool) {
    field.mass[node] = 1.0;
    for (std::size_t k = 0; k < 2; ++k) {
      field.velocity[2 * node + k] = box.smooth(x, y)[k];
      field.force[2 * node + k] = std::sin(static_cast<double>(7 * node + 3 * k));
    }
  });
  double all = 0, folded = 0;
  box.each_node([&](std::size_t node, double, double, bool) {
    for (std::size_t k = 0; k < 2; ++k) all += field.force[2 * node + k] * field.velocity[2 * node + k];
  });
  fold_force(box.state, box.scene, field);
  box.each_node([&](std::size_t node, double, double, bool inside) {
    for (std::size_t k = 0; inside && k < 2; ++k) folded += field.force[2 * node + k] * field.velocity[2 * node + k];
  });
  EXPECT_NEAR(folded / all, 1.0, 1e-12);
}

}  // namespace
}  // namespace kerf::forward::bodies
