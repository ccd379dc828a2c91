// What `kerf explain` says that a cut will cost, against what it then costs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

/// The grain of a wooden chip turns until fast waves run across the flat cells, which takes shorter steps than the
/// first ones.
TEST(ExpectedCost, OfWoodIsWhatTheCutThenCosts) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path scene = folder.path() / "wood.toml";
  std::string text = content_of(std::string(KERF_SOURCE_DIR) + "/data/scenes/wood_rl.toml");
  text = testing::replaced(text, "travel = 50", "travel = 20");
  text = testing::replaced(text, "not_before = 30", "not_before = 20");
  text = testing::replaced(text, "cells_through_chip = 4", "cells_through_chip = 3\nsingle_particle_below = 1");
  std::ofstream(scene) << text;
  const std::string file = " '" + scene.string() + "' --json";
  const auto expected = nlohmann::json::parse(run_kerf("explain" + file, folder.path()).out).at("expected");
  const auto cost = nlohmann::json::parse(run_kerf("simulate" + file, folder.path()).out).at("cost");
  for (const char* what : {"steps", "particle_steps"}) {
    EXPECT_GE(cost.at(what).get<double>(), expected.at(what).at(0).get<double>()) << what;
    EXPECT_LE(cost.at(what).get<double>(), expected.at(what).at(1).get<double>()) << what;
  }
}

}  // namespace
}  // namespace kerf
