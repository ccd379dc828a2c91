// Where the ledger's residue goes: the stages of a cut are taken one by one, and each is asked what it did to the
// books.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "forward/mpm/crack.hpp"
#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "forward/record/recorder.hpp"
#include "forward/run.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

/// Who may lose energy (positive), or make it.
enum Part { transfer, stress, contact, cohesion, window };
constexpr std::size_t part_count = 5;

Part part_of(const std::string& stage) {
  if (stage == "stress") return stress;
  if (stage == "cohesion" || stage == "cut bonds") return cohesion;
  if (stage == "project" || stage == "accelerate" || stage == "filter" || stage == "advance" || stage == "thermostat")
    return transfer;
  return contact;
}

using NodalForces = std::array<Array, 2>;

/// Nodal forces of stresses and markers so far; before the stage that spreads them.
NodalForces forces_so_far(State& state) {
  const NodalForces of_stress{state.grid.side[0].force, state.grid.side[1].force};
  spread_marker_forces(state);
  NodalForces all;
  for (std::size_t side = 0; side < 2; ++side) {
    all[side] = state.grid.side[side].force;
    state.grid.side[side].force = of_stress[side];
  }
  return all;
}

/// Work on the grid in this step, with the velocity that strained the particles and moved the markers and the mean of
/// the forces before and after that.
double work(const State& state, const NodalForces& before, const NodalForces& after,
            const std::array<Array, 2>& velocity) {
  double sum = 0.0;
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t k = 0; k < 2 * state.grid.nodes(); ++k)
      sum += 0.5 * (before[side][k] + after[side][k]) * velocity[side][k];
  return state.step * sum;
}

/// The grid has moved on by a column of nodes.
void shift(NodalForces& forces) {
  for (Array& force : forces) {
    force.erase(force.begin(), force.begin() + 2);
    force.insert(force.end(), 2, 0.0);
  }
}

/// Energy that the springs of the rake face get because their stiffness changes while they are pressed: the time step
/// can follow no stiffer ones than the mass around a marker allows, and that mass changes as it passes the nodes.
class Stiffening {
 public:
  explicit Stiffening(const Scene& scene)
      : scene_(scene),
        stiffness_(scene.resolution.contact_stiffness * 2.0 * laws::plane_strain_modulus(scene.material) /
                   scene.cell()) {}

  /// After the rake face has pressed on the upper face, whose forces until then are given.
  void follow(const State& state, const std::vector<double>& force_x, const std::vector<double>& force_y) {
    const Face& face = state.crack.face[above];
    last_.resize(face.size(), {0.0, 0.0});
    for (std::size_t k = 0; k < face.size(); ++k) {
      const double pressure =
          std::hypot(face.force_x[k] - force_x[k], face.force_y[k] - force_y[k]) / state.crack.spacing;
      Spring now{0.0, 0.0};
      if (pressure > 0.0) now.stiffness = std::min(stiffness_, stiffest_spring(state, face.moved_mass[k]));
      if (pressure > 0.0) now.overlap = pressure / now.stiffness;
      const Spring& before = last_[k];
      if (before.overlap > 0.0 && now.overlap > 0.0)
        energy += 0.25 * (now.stiffness - before.stiffness) *
                  (now.overlap * now.overlap + before.overlap * before.overlap) * state.crack.spacing;
      last_[k] = now;
    }
  }
  /// After the window has moved and left some markers behind.
  void shift(const State& state) {
    const std::size_t size = last_.size() + static_cast<std::size_t>(scene_.resolution.markers_per_cell);
    last_.erase(last_.begin(), last_.begin() + static_cast<std::ptrdiff_t>(size - state.crack.size()));
  }
  double energy = 0;

 private:
  struct Spring {
    double stiffness, overlap;
  };
  const Scene& scene_;
  double stiffness_;
  std::vector<Spring> last_;
};

/// Energies, N mm/mm.
struct Losses {
  std::array<double, part_count> part{};
  double stiffening = 0, residue = 0, tool_work = 0;
};

/// The cut of a scene, by stages. What a stage changes in the books is its own doing, but for the work that its forces
/// do on the grid: that goes on to the particles, and the transfer answers for it.
Losses cut(const Scene& scene) {
  State state = lay_out(scene);
  const std::vector<Stage> stages = plan(scene);
  Losses losses;
  const auto book = [&](Part part) {
    const Ledger ledger = take_stock(state, scene.material);
    losses.part[part] += ledger.residue() - losses.residue;
    losses.residue = ledger.residue();
    losses.tool_work = ledger.tool_work;
  };
  const Array none(state.grid.side[0].force.size(), 0.0);
  std::array<NodalForces, part_count> last;
  last.fill({none, none});
  Stiffening stiffening(scene);
  double next_crossing = scene.cell_length();
  while (state.tool.x < scene.cut.travel * scene.cut.depth) {
    std::array<NodalForces, part_count> now;
    now.fill({none, none});
    NodalForces so_far{none, none};
    std::array<Array, 2> velocity;  // projected
    bool acting = false;            // between the first forces and their spreading
    for (const Stage& stage : stages) {
      const std::vector<double> force_x = state.crack.face[above].force_x, force_y = state.crack.face[above].force_y;
      stage.apply(state);
      if (stage.name == "rake face") stiffening.follow(state, force_x, force_y);
      const Part part = part_of(stage.name);
      book(part);
      if (stage.name == "project") velocity = {state.grid.side[0].velocity, state.grid.side[1].velocity};
      if (stage.name == "stress") acting = true;
      if (stage.name == "spread") acting = false;
      if (!acting) continue;
      NodalForces all = forces_so_far(state);
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t k = 0; k < none.size(); ++k) now[part][side][k] += all[side][k] - so_far[side][k];
      so_far = std::move(all);
    }
    for (const Part part : {stress, contact, cohesion}) {
      const double passed_on = work(state, last[part], now[part], velocity);
      losses.part[part] -= passed_on;
      losses.part[transfer] += passed_on;
    }
    last = std::move(now);
    state.time += state.step;
    if (state.tool.x < next_crossing) continue;
    next_crossing += scene.cell_length();
    shift_window(state, scene);
    for (NodalForces& forces : last) shift(forces);
    stiffening.shift(state);
    book(window);
  }
  losses.stiffening = stiffening.energy;
  return losses;
}

Scene scene_of(double courant_number, int cells, bool damped) {
  Scene scene = kerf::testing::shipped(
      "verification_45",
      {{"resolution.cells_through_chip", cells}, {"resolution.courant_number", courant_number}, {"cut.travel", 4}});
  if (!damped) scene.pic_damping.reset();
  return scene;
}

/// Per cent of the tool's work, printed as it is measured.
Losses measure(double courant_number, int cells, bool damped) {
  Losses losses = cut(scene_of(courant_number, cells, damped));
  for (double* of : {&losses.part[transfer], &losses.part[stress], &losses.part[contact], &losses.part[cohesion],
                     &losses.part[window], &losses.stiffening, &losses.residue})
    *of *= 100 / losses.tool_work;
  fmt::print(
      "{} cells, Courant number {}, {}: transfer {:.3f}, stress {:.3f}, contact {:.3f}, of which stiffening "
      "{:.3f}, cohesion {:.3f}, residue {:.3f} %\n",
      cells, courant_number, damped ? "PIC" : "FLIP", losses.part[transfer], losses.part[stress], losses.part[contact],
      losses.stiffening, losses.part[cohesion], losses.residue);
  return losses;
}

/// The parts are all there is, and moving the window costs nothing.
TEST(Residue, IsTheSumOfItsParts) {
  const Losses losses = measure(0.6, 4, true);
  double sum = 0;
  for (const double part : losses.part) sum += part;
  EXPECT_NEAR(sum, losses.residue, 1e-10);
  EXPECT_NEAR(losses.part[window], 0, 1e-10);
  const Ledger ledger = run(scene_of(0.6, 4, true)).ledger;
  EXPECT_NEAR(losses.residue, 100 * ledger.residue() / ledger.tool_work, 1e-10) << "the cut was another one";
}

/// At small steps it is the transfer: what the particles' velocities lose as they pass to a grid that they have moved
/// against. It hardly depends on step or cell, and PIC, whose loss is booked, leaves little to it.
TEST(Residue, AtSmallStepsIsTheTransfers) {
  const Losses fine = measure(0.2, 4, false), coarse = measure(0.4, 4, false), cells = measure(0.4, 6, false);
  for (const Losses& losses : {fine, coarse, cells}) {
    EXPECT_GT(losses.part[transfer], 0);
    EXPECT_NEAR(losses.part[transfer], losses.residue, 0.25 * losses.residue);
    EXPECT_NEAR(losses.part[transfer], fine.part[transfer], 0.25 * fine.part[transfer]);
  }
  EXPECT_LT(measure(0.4, 4, true).part[transfer], 0.4 * coarse.part[transfer]);
  // Stresses lose and bonds gain in proportion to the step: next to nothing together.
  EXPECT_NEAR(coarse.part[stress], 2 * fine.part[stress], 0.1 * coarse.part[stress]);
  EXPECT_NEAR(coarse.part[cohesion], 2 * fine.part[cohesion], 0.1 * std::abs(coarse.part[cohesion]));
  EXPECT_LT(std::abs(coarse.part[stress] + coarse.part[cohesion]), 0.2 * coarse.part[transfer]);
}

/// At large ones it is the contact's, which makes energy: springs get stiffer while they are pressed, because the time
/// step can follow no stiffer ones than the mass around a marker allows and that mass changes as it passes the nodes.
TEST(Residue, AtLargeStepsIsTheSpringsThatStiffen) {
  const Losses losses = measure(0.8, 4, false);
  EXPECT_LT(losses.residue, 0);
  EXPECT_LT(losses.part[contact], -3 * losses.part[transfer]);
  EXPECT_NEAR(losses.part[contact], -losses.stiffening, 0.15 * losses.stiffening);
}

}  // namespace
}  // namespace kerf::forward
