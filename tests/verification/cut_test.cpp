#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "forward/record/acceptance.hpp"
#include "forward/run.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using kerf::testing::shipped;

void expect_accepted(const CutResult& result) {
  EXPECT_TRUE(result.accepted);
  for (const std::string& reason : result.refusals) ADD_FAILURE() << reason;
}

TEST(VerificationCut, AtFortyFiveDegrees) {
  const CutResult result = run(shipped("verification_45"));
  expect_accepted(result);
  EXPECT_GT(result.F_c.value, 7.3);
  EXPECT_LT(result.F_c.value, 7.9);
  EXPECT_LT(result.F_c.standard_error, 0.005 * result.F_c.value);
  EXPECT_NEAR(result.F_t.value / result.F_c.value, -1.0, 0.01);
  EXPECT_NEAR(result.fracture_energy_ratio, 1.0, 0.02);
  EXPECT_LT(std::abs(result.ledger.residue()), 0.02 * result.ledger.tool_work);
  EXPECT_EQ(result.branch, Branch::touching);
  EXPECT_LE(result.steady_from, (1.0 + 2.0) * 0.5);  // the notch and two depths of cutting
}

TEST(VerificationCut, UndampedClosesItsLedgerTwiceAsTightly) {
  Scene scene = shipped("verification_45", {{"resolution.cells_through_chip", 6}});
  scene.pic_damping.reset();
  const CutResult result = run(scene);
  expect_accepted(result);
  EXPECT_EQ(result.ledger.damping, 0.0);
  EXPECT_LT(std::abs(result.ledger.residue()), 0.01 * result.ledger.tool_work);
}

/// Whatever calms the chip says what it takes: the ledger closes to 1 % at each crossing once the cut is under way, and
/// the force is the undamped one within 3 %. The thermostat's target lies above what the moving chip carries, 0.42 of
/// the elastic energy at this speed: below it, the thermostat would brake the chip and the tool have to push it.
TEST(VerificationCut, EveryDampingIsBooked) {
  Scene plain = shipped("verification_45", {{"resolution.cells_through_chip", 4}, {"cut.travel", 6}});
  plain.pic_damping.reset();
  plain.steady_state.not_before = 100;
  const auto mean_force = [](const CutResult& result) {
    double sum = 0, count = 0;
    for (const ForceSample& sample : result.history)
      if (sample.travel > 1.5) {
        sum += sample.F_c;
        count += 1;
      }
    return sum / count;
  };
  const double undamped = mean_force(run(plain));
  Scene pic = plain, xpic = plain, thermostat = plain;
  pic.pic_damping = PicDamping{.rate = 0.025};
  xpic.xpic_damping = XpicDamping{.rate = 0.025, .order = 2};
  thermostat.thermostat = Thermostat{.kinetic_share = 0.6, .gain = 0.002};
  for (const Scene& scene : {pic, xpic, thermostat}) {
    const CutResult result = run(scene);
    double last = 0;
    for (const ForceSample& sample : result.history) {
      EXPECT_GE(sample.ledger.damping, last);
      last = sample.ledger.damping;
      if (sample.travel < 1) continue;
      EXPECT_LT(std::abs(sample.ledger.residue()), 0.01 * sample.ledger.tool_work) << sample.travel;
    }
    EXPECT_GT(last, 0.0);
    EXPECT_NEAR(mean_force(result), undamped, 0.03 * undamped);
  }
}

TEST(VerificationCut, SmallerRakesAreSteadyToo) {
  for (const char* name : {"verification_30", "verification_15"}) {
    const Scene scene = shipped(name, {{"resolution.cells_through_chip", 6}});
    const CutResult result = run(scene);
    expect_accepted(result);
    EXPECT_NEAR(result.F_t.value / result.F_c.value, -std::tan(scene.tool.rake), 0.01) << name;
    EXPECT_NEAR(result.fracture_energy_ratio, 1.0, 0.02) << name;
    EXPECT_LT(std::abs(result.ledger.residue()), 0.02 * result.ledger.tool_work) << name;
  }
}

/// The elastic strains of this solid are small, however far it flows: both laws see the same cut, though not to the
/// last digit.
TEST(VerificationCut, AHyperelasticSolidTakesTheSameForces) {
  const CutResult hypoelastic = run(shipped("verification_45", {{"resolution.cells_through_chip", 4}}));
  const CutResult hyperelastic = run(shipped("hyperelastic_45", {{"resolution.cells_through_chip", 4}}));
  expect_accepted(hyperelastic);
  EXPECT_NEAR(hyperelastic.F_c.value, hypoelastic.F_c.value, 1e-3 * hypoelastic.F_c.value);
  EXPECT_NEAR(hyperelastic.F_t.value, hypoelastic.F_t.value, 1e-3 * hypoelastic.F_c.value);
  EXPECT_NE(hyperelastic.F_c.value, hypoelastic.F_c.value);
  EXPECT_LT(std::abs(hyperelastic.ledger.residue()), 0.01 * hyperelastic.ledger.tool_work);
}

/// Frictionless, Eq. (4) is a straight line that meets zero depth at G_c. At 6 cells through the chip the simulated
/// line does so within 3 %; the value of the thickest cut still grows by 1 % from there to 8 cells, and the line turns
/// with it.
TEST(VerificationCut, ForcesExtrapolateToTheToughness) {
  const std::array<double, 3> depths{0.25, 0.5, 1.0};
  double sum_h = 0, sum_F = 0, sum_hh = 0, sum_hF = 0;
  for (const double h : depths) {
    const CutResult result = run(shipped("verification_45", {{"cut.depth", h}, {"resolution.cells_through_chip", 6}}));
    expect_accepted(result);
    sum_h += h;
    sum_F += result.F_c.value;
    sum_hh += h * h;
    sum_hF += h * result.F_c.value;
  }
  const double slope = (3 * sum_hF - sum_h * sum_F) / (3 * sum_hh - sum_h * sum_h);
  EXPECT_NEAR((sum_F - slope * sum_h) / 3, 2.0, 0.05 * 2.0);
}

TEST(Friction, TurnsTheForceByTheFrictionAngle) {
  Scene scene = shipped("verification_45", {{"resolution.cells_through_chip", 4}});
  scene.friction = Friction{.coefficient = 0.3, .yield_cap = 0.9};
  const CutResult result = run(scene);
  expect_accepted(result);
  const double Z = std::tan(std::atan(0.3) - scene.tool.rake);  // theory, section 1
  EXPECT_NEAR(result.F_t.value / result.F_c.value, Z, 0.01);
  EXPECT_GT(result.ledger.friction, 0.1 * result.ledger.tool_work);
}

TEST(Friction, NeverExceedsTheShearYieldOfTheChip) {
  Scene scene = shipped("verification_45", {{"resolution.cells_through_chip", 4}});
  scene.friction = Friction{.coefficient = 1.5, .yield_cap = 0.2};
  const CutResult result = run(scene);
  const double contact_length = 1.5 * scene.cut.depth;  // more than the chip ever touches here
  EXPECT_LT(result.face(ToolFace::rake).tangential.value, 0.2 * laws::shear_yield(scene.material) * contact_length);
  EXPECT_GT(result.face(ToolFace::rake).tangential.value, 0.0);
}

TEST(Cut, DependsOnDensityAndSpeedOnlyThroughInertia) {
  const std::vector<std::pair<std::string, double>> coarse{{"resolution.cells_through_chip", 4}, {"cut.travel", 4}};
  const Scene scene = shipped("verification_45", coarse);
  Scene slow = scene;  // four times the density at half the speed: the same non-dimensional problem
  std::get<laws::J2<laws::LinearHardening>>(slow.material).density *= 4.0;
  slow.cut.speed *= 0.5;
  slow.cut.ramp *= 2.0;
  const CutResult a = run(scene), b = run(slow);
  ASSERT_EQ(a.history.size(), b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i)
    EXPECT_NEAR(a.history[i].F_c, b.history[i].F_c, 1e-3 * a.history.back().F_c);
}

TEST(Cut, IsDeterministic) {
  const Scene scene = shipped("verification_45", {{"resolution.cells_through_chip", 4}, {"cut.travel", 2}});
  const CutResult a = run(scene), b = run(scene);
  ASSERT_EQ(a.history.size(), b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i) {
    EXPECT_EQ(a.history[i].F_c, b.history[i].F_c);
    EXPECT_EQ(a.history[i].ledger.plastic, b.history[i].ledger.plastic);
  }
}

TEST(Cut, AWornEdgePressesOnTheBaseAndASharpOneDoesNot) {
  Scene scene = shipped("verification_45", {{"resolution.cells_through_chip", 4}});
  const CutResult sharp = run(scene);
  EXPECT_EQ(sharp.face(ToolFace::bottom).normal.value, 0.0);
  scene.edge_contact = EdgeContact{.press_in = 0.01 * 0.5, .edge_radius = 0.5, .friction = 0.0};
  CutResult worn = run(scene);
  expect_accepted(worn);
  EXPECT_GT(worn.face(ToolFace::bottom).normal.value, 0.5);
  EXPECT_NEAR(worn.F_c.value, sharp.F_c.value, 0.02 * sharp.F_c.value);
  // The push on the base lifts the tool: F_t = Z F_c + F_b.
  EXPECT_NEAR(worn.F_t.value, -worn.F_c.value + worn.face(ToolFace::bottom).normal.value, 0.03 * worn.F_c.value);
  // Under a tool that is meant to be sharp the same push would come from a layer that flows past the tip.
  scene.edge_contact.reset();
  judge(worn, scene);
  EXPECT_FALSE(worn.accepted);
  ASSERT_EQ(worn.refusals.size(), 1U);
  EXPECT_NE(worn.refusals.front().find("sharp tool"), std::string::npos);
}

/// What one particle in a cell of the base costs, a twentieth of a standard error, and saves, four tenths of the
/// particle-steps.
TEST(Cut, OneParticleInACellOfTheBaseIsEnough) {
  const CutResult all = run(shipped("verification_45"));
  CutResult fewer = run(shipped("verification_45", {{"resolution.single_particle_below", 1}}));
  expect_accepted(fewer);
  EXPECT_NEAR(fewer.F_c.value, all.F_c.value, 0.0005 * all.F_c.value);
  EXPECT_NEAR(fewer.ledger.residue(), all.ledger.residue(), 0.001 * all.ledger.tool_work);
  EXPECT_LT(static_cast<double>(fewer.cost.particle_steps), 0.6 * static_cast<double>(all.cost.particle_steps));
  EXPECT_EQ(fewer.coarse_strain, 0.0);
  EXPECT_EQ(all.coarse_strain, 0.0);
}

/// A blunt edge that the base flows under: where that reaches cells of one particle, the run says so.
TEST(Cut, RefusesACoarseBaseThatFlows) {
  Scene scene =
      shipped("verification_45",
              {{"resolution.cells_through_chip", 6}, {"resolution.single_particle_below", 0.5}, {"cut.travel", 6}});
  scene.edge_contact = EdgeContact{.press_in = 0.2 * 0.5, .edge_radius = 0.5, .friction = 0.0};
  const CutResult result = run(scene);
  EXPECT_GT(result.coarse_strain, 0.01);
  EXPECT_TRUE(std::any_of(result.refusals.begin(), result.refusals.end(), [](const std::string& reason) {
    return reason.find("single_particle_below") != std::string::npos;
  }));
}

/// The lower face rises ahead of the tip by less than a lead-in does, and without friction nothing pushes it up.
TEST(Cut, ALeadInBeforeASharpTipCarriesNothing) {
  Scene scene =
      shipped("verification_45", {{"resolution.cells_through_chip", 4}, {"cut.travel", 6}, {"cut.notch", 0.5}});
  const CutResult plain = run(scene);
  scene.tool.lead_in = 20 * std::numbers::pi / 180;
  const CutResult led = run(scene);
  EXPECT_NEAR(led.F_c.value, plain.F_c.value, 0.002 * plain.F_c.value);
  EXPECT_LT(led.face(ToolFace::lead_in).normal.value, 0.002 * plain.F_c.value);
}

TEST(Acceptance, RefusesAGridTooCoarseForTheCohesiveLaw) {
  const CutResult result =
      run(shipped("verification_45", {{"cut.depth", 1.5}, {"resolution.cells_through_chip", 4}, {"cut.travel", 4}}));
  EXPECT_FALSE(result.accepted);
  ASSERT_FALSE(result.refusals.empty());
  EXPECT_NE(result.refusals.front().find("too coarse"), std::string::npos);
}

TEST(Acceptance, RefusesAToolThatIsTooFastForAQuasiStaticForce) {
  // rho d v^2 = 1e-9 t/mm^3 * 0.5 mm * (40 m/s)^2 = 0.8 N/mm, of about 8 N/mm.
  const CutResult result =
      run(shipped("verification_45", {{"cut.speed", 40e3}, {"resolution.cells_through_chip", 4}, {"cut.travel", 6}}));
  EXPECT_NEAR(result.inertia_share, 0.8 / result.F_c.value, 1e-9);
  EXPECT_TRUE(std::any_of(result.refusals.begin(), result.refusals.end(),
                          [](const std::string& reason) { return reason.find("in motion") != std::string::npos; }));
}

TEST(Acceptance, AStoppedRunIsAValueThatSaysSo) {
  const CutResult result = run(shipped("verification_45"), [](const Progress&) { return false; });
  EXPECT_FALSE(result.accepted);
  EXPECT_EQ(result.refusals.front(), "interrupted");
}

}  // namespace
}  // namespace kerf::forward
