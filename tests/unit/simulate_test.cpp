#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "forward/scene/scene.hpp"
#include "tests/unit/run_kerf.hpp"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The commands as a user calls them, on a cut so coarse and short that it takes a moment.
class CutCommands : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::string scene = content_of(fs::path(KERF_SOURCE_DIR) / "data/scenes/verification_45.toml");
    replace(scene, "cells_through_chip = 8", "cells_through_chip = 4");
    replace(scene, "travel = 9", "travel = 1.5");
    std::ofstream(scene_) << scene;
  }
  void TearDown() override { fs::remove_all(folder_); }
  static void replace(std::string& text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  }
  ProcessOutput kerf(const std::string& arguments) { return run_kerf(arguments, folder_); }

  fs::path folder_ = fs::path(testing::TempDir()) /
                     ("kerf_commands_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
  fs::path scene_ = folder_ / "scene.toml";
};

TEST_F(CutCommands, SimulateKeepsTheCutAndSaysWhyItWasTooShort) {
  const fs::path h5 = folder_ / "out" / "cut.h5";
  const ProcessOutput run = kerf("simulate '" + scene_.string() + "' -o '" + h5.string() + "' --json");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.err, HasSubstr("not accepted: "));
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_FALSE(json["accepted"].get<bool>());
  EXPECT_FALSE(json["refusals"].empty());
  EXPECT_EQ(json["F_c"]["unit"], "N/m");
  EXPECT_GT(json["cost"]["particle_steps"].get<double>(), 0);
  EXPECT_TRUE(fs::exists(h5));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "cut.xdmf"));
}

TEST_F(CutCommands, SimulateRefusesAPlaceItCannotWriteBeforeItRuns) {
  std::ofstream(folder_ / "file") << "in the way";
  // Of the last one permissions say nothing to a user who may do everything, but no file can be made there.
  for (const fs::path& place : {folder_ / "file/cut.h5", folder_ / "cut.hdf", folder_, fs::path("/proc/self/cut.h5")}) {
    const ProcessOutput run = kerf("simulate '" + scene_.string() + "' -o '" + place.string() + "'");
    EXPECT_EQ(run.exit_code, 2) << place << ": " << run.err;
    EXPECT_TRUE(run.out.empty()) << place;
    EXPECT_FALSE(run.err.empty()) << place;
  }
}

TEST_F(CutCommands, SimulateGoesOnFromAKeptState) {
  const std::string simulate = "simulate '" + scene_.string() + "' --json", state = (folder_ / "state.h5").string();
  const auto cold = nlohmann::json::parse(kerf(simulate + " --save-state '" + state + "'").out);
  EXPECT_FALSE(cold.contains("chained"));
  const ProcessOutput run = kerf(simulate + " --start-from '" + state + "'");
  EXPECT_TRUE(nlohmann::json::parse(run.out)["chained"].get<bool>()) << run.err;

  const ProcessOutput deeper = kerf(simulate + " --start-from '" + state + "' --set cut.depth=0.7mm");
  EXPECT_EQ(deeper.exit_code, 3);
  EXPECT_THAT(deeper.err, HasSubstr("cut.depth"));
  EXPECT_EQ(kerf(simulate + " --start-from '" + scene_.string() + "'").exit_code, 3);
}

TEST_F(CutCommands, SimulateLeavesNothingBehindForABadScene) {
  std::ofstream(scene_, std::ios::app) << "\n[tooool]\nrake = \"45 deg\"\n";
  const ProcessOutput run = kerf("simulate '" + scene_.string() + "' -o '" + (folder_ / "cut.h5").string() + "'");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("tooool"));
  EXPECT_FALSE(fs::exists(folder_ / "cut.h5"));
}

TEST_F(CutCommands, ExplainSaysWhatIsAndWhatIsNotSimulated) {
  const ProcessOutput frictionless = kerf("explain '" + scene_.string() + "'");
  ASSERT_EQ(frictionless.exit_code, 0) << frictionless.err;
  EXPECT_THAT(frictionless.out, HasSubstr("4 through the chip, 2 x 2 particles each"));
  EXPECT_THAT(frictionless.out, HasSubstr("[friction]"));
  EXPECT_THAT(frictionless.out, HasSubstr("Expected cost"));

  std::ofstream(scene_, std::ios::app) << "\n[friction]\ncoefficient = 0.2\n";
  const ProcessOutput rubbing = kerf("explain '" + scene_.string() + "'");
  ASSERT_EQ(rubbing.exit_code, 0) << rubbing.err;
  EXPECT_THAT(rubbing.out, testing::Not(HasSubstr("[friction]")));
}

TEST_F(CutCommands, ExplainNamesEveryBlockThatIsNotThere) {
  const ProcessOutput run = kerf("explain '" + scene_.string() + "' --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  std::set<std::string> absent, expected;
  for (const auto& one : json["not_simulated"]) absent.insert(one["block"].get<std::string>());
  for (const Block& block : forward::scene_blocks())
    if (!block.required && !block.path.starts_with("material")) expected.insert(block.path);
  for (const char* there : {"tool", "pic_damping"}) expected.erase(there);
  EXPECT_EQ(absent, expected);
  EXPECT_EQ(json["bytes_per_particle"], 80);
  double shares = 0;
  for (const auto& stage : json["step"]) shares += stage["share"].get<double>();
  EXPECT_NEAR(shares, 1.0, 1e-9);
}

TEST_F(CutCommands, ExplainShowsWhereTheTimeOfARunWent) {
  const fs::path h5 = folder_ / "cut.h5";
  ASSERT_EQ(kerf("simulate '" + scene_.string() + "' -o '" + h5.string() + "'").exit_code, 4);
  const ProcessOutput run = kerf("explain '" + h5.string() + "' --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["shares"], "of the run");
  EXPECT_EQ(json["step"].back()["stage"], "between steps");
  EXPECT_EQ(json["step"].size(), json["run"]["stages"].size());
  double shares = 0;
  for (const auto& stage : json["step"]) {
    EXPECT_GT(stage["share"].get<double>(), 0.0) << stage["stage"];
    shares += stage["share"].get<double>();
  }
  EXPECT_NEAR(shares, 1.0, 1e-9);

  std::ofstream(h5) << "no cut";
  const ProcessOutput broken = kerf("explain '" + h5.string() + "'");
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("cut.h5: is not the file of a cut"));
  EXPECT_TRUE(broken.out.empty());
}

TEST_F(CutCommands, TheShippedScenesAreReadable) {
  for (const char* name : {"verification_45", "verification_30", "verification_15", "hyperelastic_45"}) {
    const ProcessOutput run =
        kerf("explain '" + (fs::path(KERF_SOURCE_DIR) / "data/scenes" / name).string() + ".toml'");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("7680 particles")) << name;
  }
}

}  // namespace
}  // namespace kerf
