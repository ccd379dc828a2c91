// Bonds driven by hand: pairs of markers without any grid, opened along prescribed ways.
#include "forward/mpm/crack.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "forward/effects/bridging.hpp"
#include "forward/effects/face_friction.hpp"
#include "models/laws/sawtooth.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

constexpr double spacing = 0.01;  // mm

State pairs(int count) {
  State state;
  state.step = 1e-7;
  state.crack.spacing = spacing;
  for (int k = 0; k < count; ++k) {
    for (Face& face : state.crack.face) {
      face.add(spacing * k, 0.0);
      face.inverse_mass.back() = 1.0;  // there is material around it
    }
    Crack& crack = state.crack;
    crack.reference_x.push_back(spacing * k);
    crack.intact.push_back(1);
    for (auto* values : crack.memory()) values->push_back(0.0);
  }
  return state;
}

/// Moves the upper marker of pair 0 to these openings within a step and pulls.
void open(State& state, const Cohesive& law, double normal, double shear) {
  Face &upper = state.crack.face[above], &lower = state.crack.face[below];
  upper.velocity_x[0] = (shear - (upper.x[0] - lower.x[0])) / state.step;
  upper.velocity_y[0] = (normal - (upper.y[0] - lower.y[0])) / state.step;
  upper.x[0] = lower.x[0] + shear;
  upper.y[0] = lower.y[0] + normal;
  for (Face& face : state.crack.face) face.force_x[0] = face.force_y[0] = 0.0;
  pull_faces(state, law);
}

// Mode I: sigma = 4 MPa, peak at 0.01, zero at 0.1 mm. Mode II: 5 MPa, 0.024, 0.24 mm.
constexpr double G_I = 0.2, G_II = 0.6, peak_I = 0.01, peak_II = 0.024, end_I = 0.1, end_II = 0.24;

Cohesive sawtooth(MixedMode reading) {
  return {.mode_I = std::make_shared<laws::Sawtooth>(4.0, G_I, 0.1),
          .mode_II = std::make_shared<laws::Sawtooth>(5.0, G_II, 0.1),
          .exponent_n = 1,
          .exponent_m = 1,
          .mixed_mode = reading};
}

constexpr double stride = 1e-5;  // mm of opening in a step

/// The opening at which a pair fails that is opened straight on, `angle` from pure opening towards shear.
struct Failure {
  double opening;
  State state;
};
Failure fail(const Cohesive& law, double angle) {
  State state = pairs(1);
  for (int i = 1; i < 40000; ++i) {
    open(state, law, i * stride * std::cos(angle), i * stride * std::sin(angle));
    if (!state.crack.intact[0]) return {i * stride, std::move(state)};
  }
  return {0.0, std::move(state)};
}

constexpr double quarter = std::numbers::pi / 4;

TEST(Bond, InPureModesFailsWhereItsLawEndsInEveryReading) {
  for (const MixedMode reading : {MixedMode::areas, MixedMode::dissipated, MixedMode::coupled}) {
    EXPECT_NEAR(fail(sawtooth(reading), 0).opening, end_I, 1.01 * stride);
    EXPECT_NEAR(fail(sawtooth(reading), 2 * quarter).opening, end_II, 1.01 * stride);
  }
}

/// Equal openings d in both modes, beyond both peaks. The area that is left is
///     G - area(d) = G (d_c - d)^2 / (d_c (d_c - d_1)),
/// so G_I/G_Ic + G_II/G_IIc = 1 is the quadratic a (d_Ic - d)^2 + b (d_IIc - d)^2 = 1.
TEST(Bond, UnderEqualOpeningsFailsWhereTheAreasAddUp) {
  const double a = 1 / (end_I * (end_I - peak_I)), b = 1 / (end_II * (end_II - peak_II));
  const double half = a * end_I + b * end_II, rest = a * end_I * end_I + b * end_II * end_II - 1;
  const double d = (half - std::sqrt(half * half - (a + b) * rest)) / (a + b);
  EXPECT_NEAR(d, 0.04861, 1e-5);  // by hand; between the peaks and the shorter law's end
  EXPECT_NEAR(fail(sawtooth(MixedMode::areas), quarter).opening / std::numbers::sqrt2, d, stride);
}

/// What unloading would not give back grows linearly beyond the peak: G (d - d_1) / (d_c - d_1).
TEST(Bond, UnderEqualOpeningsFailsWhereTheDissipatedPartsAddUp) {
  const double a = 1 / (end_I - peak_I), b = 1 / (end_II - peak_II);
  const double d = (1 + a * peak_I + b * peak_II) / (a + b);
  EXPECT_NEAR(d, 0.07765, 1e-5);
  EXPECT_NEAR(fail(sawtooth(MixedMode::dissipated), quarter).opening / std::numbers::sqrt2, d, stride);
}

/// One common share of the critical openings: an ellipse.
TEST(Bond, UnderEqualOpeningsFailsOnTheEllipseWhenCoupled) {
  const double d = 1 / std::hypot(1 / end_I, 1 / end_II);
  EXPECT_NEAR(d, 0.09231, 1e-5);
  EXPECT_NEAR(fail(sawtooth(MixedMode::coupled), quarter).opening / std::numbers::sqrt2, d, stride);
}

/// Exponents bend the criterion but leave the pure modes alone.
TEST(Bond, ExponentsOnlyCountInMixedMode) {
  Cohesive law = sawtooth(MixedMode::areas);
  law.exponent_n = law.exponent_m = 2;
  EXPECT_NEAR(fail(law, 0).opening, end_I, 1.01 * stride);
  EXPECT_NEAR(fail(law, 2 * quarter).opening, end_II, 1.01 * stride);
  const Failure mixed = fail(law, quarter);
  const double d = mixed.opening / std::numbers::sqrt2;
  const double share_I = law.mode_I->area(d) / G_I, share_II = law.mode_II->area(d) / G_II;
  // One step adds at most 2 T stride / G to either square.
  EXPECT_NEAR(share_I * share_I + share_II * share_II, 1, 2 * stride * (4 / G_I + 5 / G_II));
  EXPECT_GT(d, fail(sawtooth(MixedMode::areas), quarter).opening / std::numbers::sqrt2);
}

/// The work of the tractions is what the pair is said to have taken when it breaks. The trapezoids of the steps are
/// exact on straight laws, but for the steps with a kink in them: less than T stride.
TEST(Bond, BooksAsBrokenWhatItsTractionsDid) {
  for (const MixedMode reading : {MixedMode::areas, MixedMode::dissipated, MixedMode::coupled})
    for (const double angle : {0.0, 0.5 * quarter, quarter, 1.5 * quarter, 2 * quarter}) {
      const Failure failure = fail(sawtooth(reading), angle);
      const Work& work = failure.state.work;
      EXPECT_NEAR(work.mode_I + work.mode_II, work.broken_energy, 10 * stride * spacing)
          << "reading " << static_cast<int>(reading) << ", angle " << angle;
      EXPECT_NEAR(work.broken_length, spacing, 1e-15);
    }
}

TEST(Bond, InPureModesTakesItsToughness) {
  for (const MixedMode reading : {MixedMode::areas, MixedMode::dissipated, MixedMode::coupled}) {
    EXPECT_NEAR(fail(sawtooth(reading), 0).state.work.mode_I, G_I * spacing, 10 * stride * spacing);
    EXPECT_NEAR(fail(sawtooth(reading), 2 * quarter).state.work.mode_II, G_II * spacing, 10 * stride * spacing);
  }
}

/// Along a straight way coupled laws take the share cos^2 of one toughness and sin^2 of the other, the angle measured
/// in critical openings.
TEST(Bond, CoupledTakesAMixOfTheToughnesses) {
  const double c = 1 / end_I / std::hypot(1 / end_I, 1 / end_II);
  const Work work = fail(sawtooth(MixedMode::coupled), quarter).state.work;
  EXPECT_NEAR(work.mode_I, c * c * G_I * spacing, 10 * stride * spacing);
  EXPECT_NEAR(work.mode_II, (1 - c * c) * G_II * spacing, 10 * stride * spacing);
}

/// Nor does it matter to coupled laws in which order the modes were opened: 0.9 of the one and then, closed, 0.9 of the
/// other never reaches the common share of 1.
TEST(Bond, CoupledRemembersTheLargestShareAndNotTheLargestOpenings) {
  const Cohesive law = sawtooth(MixedMode::coupled);
  State state = pairs(1);
  open(state, law, 0.9 * end_I, 0);
  open(state, law, 0, 0);
  open(state, law, 0, 0.9 * end_II);
  EXPECT_TRUE(state.crack.intact[0]);
  EXPECT_NEAR(-state.crack.face[above].force_x[0], law.mode_II->traction(0.9 * end_II) * spacing, 1e-12);
  open(state, law, 0, end_II);
  EXPECT_FALSE(state.crack.intact[0]);
}

/// Closing goes straight to the origin and gives back T d/2; opening again goes the same way; what is left over is the
/// dissipated part. Shear does it on both sides of its origin.
TEST(Bond, ClosesElasticallyToTheOrigin) {
  const Cohesive law = sawtooth(MixedMode::areas);
  constexpr double d = 0.05;
  for (const bool slides : {false, true}) {
    State state = pairs(1);
    const laws::TractionLaw& mode = slides ? *law.mode_II : *law.mode_I;
    const auto go = [&](double from, double to) {
      constexpr int steps = 5000;
      for (int i = 1; i <= steps; ++i) {
        const double at = from + (to - from) * i / steps;
        slides ? open(state, law, 0, at) : open(state, law, at, 0);
      }
      return (state.work.mode_I + state.work.mode_II) / spacing;
    };
    const double tolerance = 10 * stride;
    EXPECT_NEAR(go(0, d), mode.area(d), tolerance);
    EXPECT_NEAR(go(d, 0.5 * d), mode.area(d) - 0.375 * mode.traction(d) * d, tolerance);
    const Face& upper = state.crack.face[above];
    EXPECT_NEAR(slides ? -upper.force_x[0] : -upper.force_y[0], 0.5 * mode.traction(d) * spacing, 1e-9);
    EXPECT_NEAR(go(0.5 * d, 0), mode.dissipated(d), tolerance);
    EXPECT_NEAR(go(0, slides ? -d : d), mode.area(d), tolerance);
    EXPECT_TRUE(state.crack.intact[0]);
  }
}

/// A bond cut half closed has taken the area up to its largest opening, less what it gave back on the way.
TEST(Bond, CutHalfClosedHasTakenWhatItsTractionsDid) {
  const Cohesive law = sawtooth(MixedMode::areas);
  State state = pairs(1);
  for (int i = 1; i <= 5000; ++i) open(state, law, stride * i, 0.5 * stride * i);
  for (int i = 5000; i >= 2000; --i) open(state, law, stride * i, 0.5 * stride * i);
  break_bond(state, law, 0);
  EXPECT_NEAR(state.work.broken_energy, state.work.mode_I + state.work.mode_II, 20 * stride * spacing);
  const double d = 0.05, kept = 0.4;  // of the largest openings
  const double I = law.mode_I->area(d) - 0.5 * law.mode_I->traction(d) * d * (1 - kept * kept);
  const double II = law.mode_II->area(d / 2) - 0.25 * law.mode_II->traction(d / 2) * d * (1 - kept * kept);
  EXPECT_NEAR(state.work.broken_energy, (I + II) * spacing, 1e-12);
}

TEST(Bond, DoesNotPullWhenPressedNorOnceBroken) {
  const Cohesive law = sawtooth(MixedMode::areas);
  State state = pairs(1);
  open(state, law, -0.01, 0);
  EXPECT_EQ(state.crack.face[above].force_y[0], 0.0);
  open(state, law, 0.2, 0);
  EXPECT_FALSE(state.crack.intact[0]);
  open(state, law, 0.02, 0.01);
  EXPECT_EQ(state.crack.face[above].force_y[0], 0.0);
  EXPECT_EQ(state.crack.face[above].force_x[0], 0.0);
}

/// Tractions act equal and opposite on the faces, against the opening.
TEST(Bond, PullsTheFacesTogether) {
  const Cohesive law = sawtooth(MixedMode::areas);
  State state = pairs(1);
  open(state, law, 0.02, -0.05);
  const Face &upper = state.crack.face[above], &lower = state.crack.face[below];
  EXPECT_NEAR(upper.force_y[0], -law.mode_I->traction(0.02) * spacing, 1e-15);
  EXPECT_NEAR(upper.force_x[0], law.mode_II->traction(0.05) * spacing, 1e-15);
  EXPECT_EQ(lower.force_x[0], -upper.force_x[0]);
  EXPECT_EQ(lower.force_y[0], -upper.force_y[0]);
}

constexpr double stiffness = 1000;  // MPa/mm

/// Faces without bonds, the upper one `depth` inside the lower one, both at a slope.
State pressed(double depth, double slope, int count = 40) {
  State state = pairs(count);
  state.grid.cell_y = 1;
  Crack& crack = state.crack;
  crack.face[above].slip.emplace_back(crack.size(), 0.0);
  for (const std::size_t end : {std::size_t{0}, crack.size() - 1})  // not to slide off the lower face
    crack.face[above].inverse_mass[end] = 0.0;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    crack.intact[k] = 0;
    for (Face& face : crack.face) face.y[k] = slope * face.x[k];
    crack.face[above].y[k] -= depth;
  }
  return state;
}

/// Slides the upper face along the lower one by `way` (measured along it) in equal steps; the work done on the way
/// against both faces' forces, trapezoids of each step.
double slide(State& state, double coefficient, double slope, double way, int steps) {
  Face &upper = state.crack.face[above], &lower = state.crack.face[below];
  const double step_x = way / steps / std::hypot(1, slope), step_y = slope * step_x;
  double work = 0;
  const auto power = [&] {
    double sum = 0;
    for (std::size_t k = 0; k < upper.size(); ++k) sum -= upper.force_x[k] * step_x + upper.force_y[k] * step_y;
    return sum;
  };
  for (int i = 0; i < steps; ++i) {
    work += 0.5 * power();
    for (std::size_t k = 0; k < upper.size(); ++k) {
      upper.x[k] += step_x;
      upper.y[k] += step_y;
      upper.velocity_x[k] = step_x / state.step;
      upper.velocity_y[k] = step_y / state.step;
      for (Face* face : {&upper, &lower}) face->force_x[k] = face->force_y[k] = 0;
    }
    state.contact_energy = 0;
    close_faces(state, stiffness);
    rub_faces(state, coefficient, stiffness);
    work += 0.5 * power();
  }
  return work;
}

double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

/// Force on the upper face across and along the lower one, N/mm.
struct Force {
  double normal, along;
};
Force of_upper(const State& state, double slope) {
  const Face& upper = state.crack.face[above];
  const double x = total(upper.force_x), y = total(upper.force_y), length = std::hypot(1, slope);
  return {(y - slope * x) / length, (x + slope * y) / length};
}

/// Sticks as a spring up to the slip limit, then slides at mu times the pressure; back again it does the same.
TEST(FaceFriction, SticksUpToTheSlipLimitAndThenSlides) {
  constexpr double mu = 0.4, depth = 1e-4;
  for (const double slope : {0.0, 0.3}) {
    State state = pressed(depth, slope);
    const double limit = mu * depth * std::hypot(1, slope);  // mm: where k slip is mu p
    slide(state, mu, slope, 0.5 * limit, 10);
    Force now = of_upper(state, slope);
    EXPECT_NEAR(now.along, -0.5 * mu * now.normal, 1e-12 * now.normal);
    EXPECT_EQ(state.work.friction, 0.0);
    slide(state, mu, slope, 4.5 * limit, 90);
    now = of_upper(state, slope);
    EXPECT_NEAR(now.along, -mu * now.normal, 1e-12 * now.normal);
    EXPECT_GT(now.normal, 0);
    slide(state, mu, slope, -5 * limit, 100);
    now = of_upper(state, slope);
    EXPECT_NEAR(now.along, mu * now.normal, 1e-12 * now.normal);
    // What acts on one face acts back on the other.
    EXPECT_NEAR(total(state.crack.face[above].force_x), -total(state.crack.face[below].force_x), 1e-14);
    EXPECT_NEAR(total(state.crack.face[above].force_y), -total(state.crack.face[below].force_y), 1e-14);
  }
}

/// The work is mu p times the slip, the springs' stretch not counted, and it is what the sliding cost: stretch first,
/// slip after.
TEST(FaceFriction, BooksWhatItDissipates) {
  constexpr double mu = 0.4, depth = 1e-4;
  for (const double slope : {0.0, 0.3}) {
    State state = pressed(depth, slope);
    const double limit = mu * depth * std::hypot(1, slope), way = 20 * limit;
    const double cost = slide(state, mu, slope, way, 2000);
    const double pressed_by = of_upper(state, slope).normal;
    EXPECT_NEAR(state.work.friction, mu * pressed_by * (way - limit), 1e-9 * cost);
    const double in_springs = 0.5 * mu * pressed_by * limit;
    // The kinks of all springs fall into one step: less than mu p times a step.
    EXPECT_NEAR(cost, state.work.friction + in_springs, mu * pressed_by * way / 2000);
  }
}

TEST(FaceFriction, NeedsFacesThatTouchAndHaveNoBonds) {
  State state = pressed(1e-4, 0);
  state.crack.intact.assign(state.crack.size(), 1);
  slide(state, 0.4, 0, 1e-3, 100);
  EXPECT_EQ(total(state.crack.face[above].force_x), 0.0);
  EXPECT_GT(total(state.crack.face[above].force_y), 0.0);
  State open = pressed(-1e-4, 0);
  slide(open, 0.4, 0, 1e-3, 100);
  EXPECT_EQ(total(open.crack.face[above].force_x), 0.0);
  EXPECT_EQ(open.work.friction, 0.0);
  EXPECT_EQ(open.contact_energy, 0.0);
}

TEST(CutBonds, ASharpEdgeTakesThoseBehindIt) {
  const Scene scene = kerf::testing::shipped("verification_45");
  State state = pairs(20);
  state.tool.x = 0.1149;  // between pairs 11 and 12
  state.tool.y = 0.003;
  cut_bonds(state, scene);
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(state.crack.intact[k], k > 11) << k;
  EXPECT_NEAR(state.work.broken_length, 12 * spacing, 1e-14);
  EXPECT_EQ(state.work.broken_energy, 0.0);  // they had not been opened
  EXPECT_NEAR(state.crack.front, 0.11, 1e-15);
  cut_bonds(state, scene);
  EXPECT_NEAR(state.work.broken_length, 12 * spacing, 1e-14);  // once
}

/// A bond is cut when its upper end's height on the arc lies ahead of its lower end; above the arc's foremost point it
/// is the foremost point that counts.
TEST(CutBonds, ARoundTipTakesThoseBehindItsArc) {
  Scene scene = kerf::testing::shipped("verification_45");
  constexpr double r = 0.08;
  State state = pairs(30);
  state.tool.x = 0.35;
  state.tool.y = -0.004;
  state.tool.tip_radius = r;
  Face& upper = state.crack.face[above];
  for (std::size_t k = 0; k < 30; ++k) upper.y[k] = 0.15 - 0.006 * static_cast<double>(k);
  cut_bonds(state, scene);
  const double centre = 0.35 - r * std::tan(3 * std::numbers::pi / 8);  // r (1 + sin 45)/cos 45
  int cut = 0;
  for (std::size_t k = 0; k < 30; ++k) {
    const double x = state.crack.face[below].x[k], height = upper.y[k] + 0.004;  // above the tool's lowest point
    bool inside;  // behind the arc's front at that height, found as the circle's equation says
    if (height >= r)
      inside = x < centre + r;
    else if (height <= 0)
      inside = x < centre;
    else
      inside = x < centre || (x - centre) * (x - centre) + (height - r) * (height - r) < r * r;
    EXPECT_EQ(!state.crack.intact[k], inside) << k << " at height " << height;
    cut += inside;
  }
  EXPECT_GT(cut, 15);
  EXPECT_LT(cut, 25);
}

/// Markers that have left the window are not the edge's.
TEST(CutBonds, LeavesAloneWhatHasNoMaterialAround) {
  const Scene scene = kerf::testing::shipped("verification_45");
  State state = pairs(5);
  state.tool.x = 1;
  state.crack.face[below].inverse_mass[2] = 0.0;
  cut_bonds(state, scene);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(state.crack.intact[k], k == 2) << k;
}

}  // namespace
}  // namespace kerf::forward
