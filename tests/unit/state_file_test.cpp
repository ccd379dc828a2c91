#include "forward/record/state_file.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "forward/run.hpp"
#include "models/base/error.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

namespace fs = std::filesystem;
using testing::shipped;

class StateFile : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// The complaint about a kept state, and about the scene that was to begin with it.
  static std::string complaint(const fs::path& h5, const Scene& scene) {
    try {
      read_state(h5, scene);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  /// A cut of the scene up to this travel, its state kept.
  fs::path keep(Scene scene, double travel) const {
    scene.cut.travel = travel;
    scene.steady_state.tolerance = 0.0;
    State end;
    run(scene, {}, {.from = nullptr, .to = &end});
    write_state(folder_ / "state.h5", end, scene);
    return folder_ / "state.h5";
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / ("kerf_state-" + std::to_string(::getpid()));
};

Scene polymer() {
  return shipped("verification_45", {{"resolution.cells_through_chip", 4}});
}

/// A run that goes on from its own state, beside the one that never stopped.
void expect_same(const fs::path& kept, Scene scene, double first, double second) {
  scene.steady_state.tolerance = 0.0;
  scene.cut.travel = first + second;
  const CutResult whole = run(scene);
  scene.cut.travel = second;
  const State start = read_state(kept, scene);
  const CutResult rest = run(scene, {}, {.from = &start, .to = nullptr});
  ASSERT_TRUE(rest.chained);
  ASSERT_GT(rest.history.size(), 3u);
  const std::size_t before = whole.history.size() - rest.history.size();
  const ForceSample& last = whole.history[before - 1];
  for (std::size_t i = 0; i < rest.history.size(); ++i) {
    const ForceSample &a = whole.history[before + i], &b = rest.history[i];
    EXPECT_EQ(a.F_c, b.F_c) << i;
    EXPECT_EQ(a.F_t, b.F_t) << i;
    EXPECT_EQ(a.crack_lead, b.crack_lead) << i;
    EXPECT_NEAR(a.travel - last.travel, b.travel, 1e-12) << i;
    // Energies count from where the run began.
    const double work = a.ledger.tool_work - last.ledger.tool_work;
    EXPECT_NEAR(b.ledger.tool_work, work, 1e-9 * a.ledger.tool_work);
    EXPECT_NEAR(b.ledger.plastic, a.ledger.plastic - last.ledger.plastic, 1e-9 * a.ledger.tool_work);
    EXPECT_NEAR(b.ledger.elastic, a.ledger.elastic - last.ledger.elastic, 1e-9 * a.ledger.tool_work);
    EXPECT_NEAR(b.ledger.residue(), a.ledger.residue() - last.ledger.residue(), 1e-9 * a.ledger.tool_work);
  }
}

TEST_F(StateFile, ContinuesACutToTheLastBit) {
  expect_same(keep(polymer(), 1.5), polymer(), 1.5, 1.5);
}

TEST_F(StateFile, ContinuesACutWithEveryMemory) {
  Scene scene = shipped("wood_rl", {{"resolution.cells_through_chip", 3}, {"resolution.cell_stretch", 1}});
  scene.friction = {.coefficient = 0.2, .yield_cap = 0.9, .sole = 0.2};
  scene.sole = {.opening = 1.0, .corner_radius = 0.05};
  scene.edge_contact = {.press_in = 0.01, .edge_radius = 0.5, .friction = 0.1};
  scene.face_friction = {.coefficient = 0.1};
  expect_same(keep(scene, 1), scene, 1, 1.5);
}

TEST_F(StateFile, StartsANeighbour) {
  const Scene scene = polymer();
  const fs::path kept = keep(scene, 1.5);
  Scene neighbour = polymer();
  std::get<laws::J2<laws::LinearHardening>>(neighbour.material).hardening.yield_stress *= 1.05;
  neighbour.cut.travel = 1.0;
  const State start = read_state(kept, neighbour);
  EXPECT_EQ(start.particles.size() % lane_count, 0u);
  const CutResult result = run(neighbour, {}, {.from = &start, .to = nullptr});
  ASSERT_FALSE(result.history.empty());
  // It begins at the force that a cut from unbroken material takes half a depth to reach.
  EXPECT_GT(result.history.front().F_c, 0.8 * result.history.back().F_c);
  EXPECT_LT(std::abs(result.ledger.residue()), 0.03 * result.ledger.tool_work);
}

TEST_F(StateFile, RefusesWhatDoesNotFit) {
  const fs::path kept = keep(polymer(), 0.5);
  const auto with = [](const std::function<void(Scene&)>& change) {
    Scene scene = polymer();
    change(scene);
    return scene;
  };
  EXPECT_EQ(complaint(kept, polymer()), "none");
  EXPECT_NE(complaint(kept, with([](Scene& s) { s.cut.depth *= 2; })).find("cut.depth = 0.5, the scene 1"),
            std::string::npos);
  EXPECT_NE(complaint(kept, with([](Scene& s) { s.resolution.cells_through_chip = 5; }))
                .find("resolution.cells_through_chip = 4, the scene 5"),
            std::string::npos);
  EXPECT_NE(complaint(kept, with([](Scene& s) { s.tool.rake = 0.5; })).find("tool.rake"), std::string::npos);
  EXPECT_NE(complaint(kept, with([](Scene& s) { s.material = shipped("wood_rl").material; })).find("material.law"),
            std::string::npos);
  // Friction remembers how far each marker has slid; this state has no such memory.
  EXPECT_NE(complaint(kept, with([](Scene& s) { s.friction = {.coefficient = 0.2, .yield_cap = 0.9}; }))
                .find("upper face slip 0"),
            std::string::npos);
  EXPECT_NE(complaint(kept, with([](Scene& s) { s.thermostat = {.kinetic_share = 0.01, .gain = 0.01}; }))
                .find("[thermostat]"),
            std::string::npos);
  EXPECT_NE(complaint(folder_ / "none.h5", polymer()).find("no such file"), std::string::npos);
}

TEST_F(StateFile, RefusesADamagedFile) {
  const fs::path kept = keep(polymer(), 0.5);
  const hid_t file = H5Fopen(kept.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  ASSERT_GE(H5Ldelete(file, "plastic strain", H5P_DEFAULT), 0);
  H5Fclose(file);
  EXPECT_NE(complaint(kept, polymer()).find("plastic strain"), std::string::npos);
  std::ofstream(folder_ / "text.h5") << "text";
  EXPECT_NE(complaint(folder_ / "text.h5", polymer()).find("not an HDF5 file"), std::string::npos);
}

}  // namespace
}  // namespace kerf::forward
