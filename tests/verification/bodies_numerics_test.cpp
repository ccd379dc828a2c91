// What the options of [numerics] do to problems whose answers are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tuple>

#include "forward/mpm/stencil.hpp"
#include "tests/verification/bodies_result.hpp"
#include "tests/verification/bodies_trial.hpp"

namespace kerf::forward::bodies {
namespace {

std::string numerics(const std::string& key, const std::string& value, const std::string& more = "") {
  return fmt::format("[numerics]\n{} = \"{}\"\n{}\n", key, value, more);
}
std::string xpic(int order) {
  return numerics("transfer", "XPIC", fmt::format("xpic_order = {}", order));
}
double order(double coarse, double fine) {
  return std::log2(std::abs(coarse / fine));
}
/// c k over the frequency of a bar of 10 mm with a free end, less one, where waves are slowed by (k h)^2 times this.
double slowing(double factor, int cells) {
  return -factor * std::pow(std::numbers::pi / 2 / cells, 2);
}

template <class Shape>
void expect_shape_function(const Shape& shape) {
  const Lanes f{0.51, 0.62, 0.77, 0.93, 1.04, 1.18, 1.33, 1.49}, small = all_lanes(1e-6);
  std::array<Lanes, 3> weight, slope, above, below, unused;
  shape.weigh(f, weight, slope);
  shape.weigh(f + small, above, unused);
  shape.weigh(f - small, below, unused);
  for (std::size_t p = 0; p < lane_count; ++p) {
    const Quad row = shape.row(f[p]);
    double sum = 0, moment = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += weight[i][p];
      moment += weight[i][p] * (static_cast<double>(i) - f[p]);
      EXPECT_NEAR(slope[i][p], (above[i][p] - below[i][p]) / 2e-6, 1e-6) << Shape::name << " node " << i;
      EXPECT_NEAR(row[i], weight[i][p], 1e-15);
    }
    EXPECT_NEAR(sum, 1, 1e-14) << Shape::name;
    EXPECT_NEAR(moment, 0, 1e-14) << Shape::name;
  }
}
TEST(BodiesNumerics, ShapeFunctionsReproduceLinearFields) {
  expect_shape_function(QuadraticSpline{});
  expect_shape_function(Linear{});
  for (int particles = 1; particles <= 4; ++particles) expect_shape_function(Ugimp::of(particles));
}

TEST(BodiesNumerics, EveryShapeFunctionFindsAManufacturedSolution) {
  for (const auto& [shape, least] : {std::pair{"spline", 1.7}, {"uGIMP", 1.3}, {"linear", 1.3}}) {
    const std::string with = numerics("shape", shape);
    const double coarse = manufactured_error(8, with, 3), middle = manufactured_error(16, with, 3),
                 fine = manufactured_error(32, with, 3);
    std::printf("%-6s displacements off by %.2e, %.2e, %.2e with 8, 16, 32 cells: order %.2f, %.2f\n", shape, coarse,
                middle, fine, order(coarse, middle), order(middle, fine));
    EXPECT_LT(fine, 2e-2) << shape;
    EXPECT_GT(order(coarse, middle), least) << shape;
    EXPECT_GT(order(middle, fine), least) << shape;
  }
  // A particle as wide as its cell sees a hat as a quadratic spline.
  EXPECT_NEAR(manufactured_error(8, numerics("shape", "uGIMP"), 1) / manufactured_error(8, "", 1), 1, 1e-9);
}

TEST(BodiesNumerics, EveryTransferAndStressUpdateFindsAManufacturedSolution) {
  for (const std::string& with : {numerics("transfer", "APIC"), xpic(2), xpic(5), numerics("stress_update", "USL"),
                                  numerics("stress_update", "MUSL"), numerics("stress_update", "USAVG")}) {
    const double coarse = manufactured_error(16, with), fine = manufactured_error(32, with);
    std::printf("displacements off by %.2e, %.2e with 16, 32 cells: order %.2f  %s", coarse, fine, order(coarse, fine),
                with.c_str() + 11);
    EXPECT_LT(fine, 2e-2) << with;
    EXPECT_GT(order(coarse, fine), 1.7) << with;
  }
}

// Nodes gather from FLIP's points what a spline has spread twice, so that waves are slowed by (k h)^2/4; gradients, and
// XPIC's filter, give back what the second spreading took.
TEST(BodiesNumerics, TransfersSlowWavesAsTheyShould) {
  for (const auto& [with, factor] : {std::pair{numerics("transfer", "FLIP"), 0.25},
                                     {numerics("transfer", "APIC"), 0.125},
                                     {xpic(2), 0.125},
                                     {xpic(5), 0.125}})
    EXPECT_NEAR(vibrate(32, true, with).frequency_error / slowing(factor, 32), 1, 0.1) << with;
}

TEST(BodiesNumerics, StressUpdatesKeepEnergyEachInItsWay) {
  std::array<Vibration, 4> coarse, fine;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string with = numerics("stress_update", stress_update_names[k]);
    coarse[k] = vibrate(16, true, with);
    fine[k] = vibrate(32, true, with);
    std::printf("%-6s energy kept over 20 periods %.6f, %.6f, swings by %.1e, %.1e with 16, 32 cells\n",
                stress_update_names[k], coarse[k].energy_kept, fine[k].energy_kept, coarse[k].energy_swing,
                fine[k].energy_swing);
    EXPECT_NEAR(fine[k].frequency_error / slowing(0.25, 32), 1, 0.1);
  }
  const auto& [usf, usl, musl, usavg] = fine;
  for (const Vibration* keeps : {&usf, &musl, &usavg}) EXPECT_NEAR(keeps->energy_kept, 1, 1e-4);
  EXPECT_LT(usl.energy_kept, 1 - 1e-3);
  // Of velocities and stresses half a step apart the energy swings with the first order of the step.
  EXPECT_NEAR(order(coarse[0].energy_swing, usf.energy_swing), 1, 0.2);
  EXPECT_NEAR(order(coarse[3].energy_swing, usavg.energy_swing), 2, 0.3);
  EXPECT_LT(usavg.energy_swing, 0.05 * usf.energy_swing);
}

TEST(BodiesNumerics, XpicDampsTheLessTheHigherItsOrder) {
  const double pic = 1 - vibrate(16, true, numerics("transfer", "PIC")).energy_kept;
  double before = 1 - vibrate(16, true, xpic(1)).energy_kept;
  EXPECT_NEAR(before, pic, 1e-12);
  for (const int m : {2, 3, 5, 8}) {
    const double lost = 1 - vibrate(16, true, xpic(m)).energy_kept;
    std::printf("XPIC(%d) loses %.2e of the energy in 20 periods\n", m, lost);
    EXPECT_LT(lost, 0.8 * before) << m;
    EXPECT_GT(lost, 0) << m;
    before = lost;
  }
}

TEST(BodiesNumerics, ApicKeepsAngularMomentum) {
  const auto turn = [](const char* frame, const char* transfer) {
    const Rotation r = rotate(8, numerics("frame", frame, fmt::format("transfer = \"{}\"", transfer)));
    std::printf("%-9s %-4s angular momentum %+.1e, energy %+.1e, stress %.2f rho v^2, place %.1e\n", frame, transfer,
                r.angular_momentum, r.energy, r.stress, r.placed);
    return r;
  };
  // The moments of nodal forces and momenta about the nodes' places are exact where the grid lies.
  const Rotation current = turn("current", "APIC"), flip = turn("current", "FLIP");
  EXPECT_NEAR(current.angular_momentum, 0, 1e-11);
  EXPECT_GT(std::abs(flip.angular_momentum), 1e-3);
  const Rotation reference = turn("reference", "APIC");
  EXPECT_NEAR(reference.angular_momentum, 0, 1e-3);
  for (const Rotation& r : {current, reference}) {
    EXPECT_LT(r.stress, 3);  // what is suddenly turned pulls up to twice as hard as it does steadily
    EXPECT_LT(r.placed, 2e-2);
  }
}

TEST(BodiesNumerics, LedgersClose) {
  const auto end_of = [](const std::string& with) {
    return result_of(trial_scene(10, 4, 0.5, "", "velocity_x = \"0.1 m/s\"\nwavelength = \"20 mm\"", with))
        .history.back();
  };
  const std::string average = "stress_update = \"USAVG\"\n";
  // By what a run accepts, on a bar as coarse as this.
  for (const char* more : {"transfer = \"PIC\"", "transfer = \"APIC\"", "transfer = \"XPIC\"",
                           "transfer = \"XPIC\"\nxpic_order = 5", "shape = \"uGIMP\"", "shape = \"linear\""}) {
    const Reading end = end_of("[numerics]\n" + average + more + "\n");
    std::printf("residue %+.2e, damping %.3f of the energy at the start: %s\n", end.residue() / end.start_kinetic,
                end.damping / end.start_kinetic, more);
    EXPECT_LT(std::abs(end.residue()), 1e-2 * end.start_kinetic) << more;
  }
  // What USL loses nobody takes.
  const Reading usl = end_of(numerics("stress_update", "USL"));
  EXPECT_GT(usl.residue(), 5e-3 * usl.start_kinetic);
}

/// A free square that turns, begun askew on the grid, for half a millisecond.
BodiesResult turn_askew(const std::string& with, const char* velocity = "spin = \"1400 rad/s\"") {
  std::string text = trial_scene(
      20, 20, 1.25, "left = \"open\"\nbottom = \"open\"\ntop = \"open\"",
      fmt::format("left = \"5 mm\"\nbottom = \"5 mm\"\nwidth = \"10 mm\"\nheight = \"10 mm\"\nangle = \"3 deg\"\n{}",
                  velocity),
      with, 0.3);
  return result_of(text.replace(text.find("1 ms"), 4, "0.5 ms"));
}

TEST(BodiesNumerics, WhatATransferTakesOfATurningSquareIsBooked) {
  for (const std::string& with : {numerics("transfer", "PIC"), xpic(2), xpic(5)}) {
    const BodiesResult result = turn_askew(with);
    const Reading& end = result.history.back();
    std::printf("residue %+.2e, damping %.3f of the energy at the start\n", end.residue() / end.start_kinetic,
                end.damping / end.start_kinetic);
    EXPECT_TRUE(result.accepted) << with << result.refusals[0];
  }
}

// A node that a point has just reached has all of its force, because the slope of a hat does not vanish there, and
// hardly any mass. Who looks at velocities gathered from points never sees how fast it becomes; APIC and USL do.
TEST(BodiesNumerics, NodesOfHardlyAnyMassEndInATypedFailure) {
  using ::testing::HasSubstr;
  for (const char* with : {"transfer = \"APIC\"", "stress_update = \"USL\""}) {
    const BodiesResult result = turn_askew(fmt::format("[numerics]\nshape = \"linear\"\n{}\n", with));
    ASSERT_FALSE(result.accepted) << with;
    ASSERT_EQ(result.refusals.size(), 1U) << with;
    EXPECT_THAT(result.refusals[0], ::testing::AllOf(HasSubstr("broke down after"), HasSubstr("hardly any mass")));
    EXPECT_TRUE(result.measures.is_null());
    for (const Reading& reading : result.history) EXPECT_TRUE(std::isfinite(reading.residue())) << with;
  }
  for (const char* transfer : {"FLIP", "PIC", "XPIC"}) {
    const BodiesResult result =
        turn_askew(fmt::format("[numerics]\nshape = \"linear\"\nframe = \"current\"\ntransfer = \"{}\"\n", transfer));
    for (const std::string& refusal : result.refusals) EXPECT_THAT(refusal, Not(HasSubstr("broke down"))) << transfer;
    EXPECT_TRUE(std::isfinite(result.history.back().residue())) << transfer;
  }
}

TEST(BodiesNumerics, ABodyThatLeavesTheBoxEndsTheRun) {
  const BodiesResult result = turn_askew(numerics("frame", "current"), "velocity_x = \"100 m/s\"");
  ASSERT_FALSE(result.accepted);
  EXPECT_THAT(result.refusals[0], ::testing::HasSubstr("left the box"));
}

// What the README's table says of error and seconds; nothing is asserted of time.
TEST(BodiesNumerics, WhatAccuracyCosts) {
  for (const auto& [name, with, particles] : {std::tuple{"spline, FLIP, USF", std::string(), 2},
                                              {"... 1 particle per side", std::string(), 1},
                                              {"... 3 particles per side", std::string(), 3},
                                              {"uGIMP, 3 per side", numerics("shape", "uGIMP"), 3},
                                              {"linear", numerics("shape", "linear"), 2},
                                              {"PIC", numerics("transfer", "PIC"), 2},
                                              {"APIC", numerics("transfer", "APIC"), 2},
                                              {"XPIC(2)", xpic(2), 2},
                                              {"XPIC(5)", xpic(5), 2},
                                              {"USL", numerics("stress_update", "USL"), 2},
                                              {"MUSL", numerics("stress_update", "MUSL"), 2},
                                              {"USAVG", numerics("stress_update", "USAVG"), 2}}) {
    std::printf("%-24s", name);
    double last = 1e300;
    for (const int cells : {8, 16, 32}) {
      const Manufactured found = manufacture(cells, with, particles);
      std::printf("  %.4f in %.3f s", found.error, found.seconds);
      EXPECT_LT(found.error, last) << name;
      last = found.error;
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace kerf::forward::bodies
