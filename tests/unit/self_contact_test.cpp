#include "forward/effects/self_contact.hpp"

#include <gtest/gtest.h>

#include "forward/mpm/crack.hpp"
#include "forward/mpm/transfer.hpp"
#include "forward/mpm/window.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

/// The layer at rest, with one marker of the chip's cut face brought to a height below (negative) the outer surface.
struct Touching {
  State state;
  double force_x = 0, force_y = 0;  ///< on the marker
  double back_x = 0, back_y = 0;    ///< on the outer surface

  Touching(double height, double tilt = 0.0) {
    Scene scene = kerf::testing::shipped("verification_45");
    scene.self_contact = SelfContact{.reach = 0.4 * scene.cut.depth};
    state = lay_out(scene);
    project_velocity(state);
    move_markers(state);
    for (std::size_t j = 0; j < state.top.size(); ++j) state.top.y[j] += tilt * state.top.x[j];
    Face& cut = state.crack.face[above];
    const std::size_t k = cut.size() / 2;
    cut.x[k] = 1.3 * scene.cut.depth;
    cut.y[k] = scene.cut.depth + tilt * cut.x[k] + height;
    touch_itself(state, 1000.0, scene.self_contact->reach);
    force_x = cut.force_x[k];
    force_y = cut.force_y[k];
    for (std::size_t j = 0; j < state.top.size(); ++j) {
      back_x += state.top.force_x[j];
      back_y += state.top.force_y[j];
    }
  }
};

TEST(SelfContact, PushesOutWithThePenaltyAndKeepsMomentum) {
  const Touching flat(-0.01);
  const double length = flat.state.crack.spacing;
  EXPECT_NEAR(flat.force_y, 1000.0 * 0.01 * length, 1e-12);
  EXPECT_NEAR(flat.force_x, 0.0, 1e-15);
  EXPECT_NEAR(flat.back_y, -flat.force_y, 1e-15);
  EXPECT_NEAR(flat.state.contact_energy, 0.5 * 1000.0 * 0.01 * 0.01 * length, 1e-15);
}

TEST(SelfContact, FollowsTheSurfacesSlope) {
  const Touching sloped(-0.01, 0.2);
  EXPECT_NEAR(sloped.force_x / sloped.force_y, -0.2, 1e-9);
  EXPECT_NEAR(sloped.back_x, -sloped.force_x, 1e-15);
  EXPECT_NEAR(sloped.back_y, -sloped.force_y, 1e-15);
}

TEST(SelfContact, LeavesAloneWhatIsOutsideAndWhatIsTheChipItself) {
  EXPECT_EQ(Touching(0.01).force_y, 0.0);
  EXPECT_EQ(Touching(-0.21).force_y, 0.0);  // beyond the reach of 0.2 mm
  EXPECT_GT(Touching(-0.19).force_y, 0.0);
}

}  // namespace
}  // namespace kerf::forward
