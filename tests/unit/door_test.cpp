// The command line as a user meets it: output, messages and exit codes of the program itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "models/base/atomic_file.hpp"
#include "tests/unit/run_kerf.hpp"

namespace kerf {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Tests run at the same time, each with a folder of its own.
ProcessOutput kerf(const std::string& arguments) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / ("kerf_door_" + test);
  std::filesystem::create_directories(folder);
  ProcessOutput output = run_kerf(arguments, folder);
  std::filesystem::remove_all(folder);
  return output;
}

const std::string data = std::string(KERF_SOURCE_DIR) + "/data/";

TEST(Door, UsageErrorsExitWithTwoAndNameTheNearestCommand) {
  EXPECT_EQ(kerf("--help").exit_code, 0);
  EXPECT_THAT(kerf("--version").out, StartsWith("kerf "));
  EXPECT_EQ(kerf("").exit_code, 2);
  const ProcessOutput misspelt = kerf("chekc scene.toml");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("no command \"chekc\"; did you mean \"check\"?"));
  EXPECT_EQ(kerf("list --nonsense").exit_code, 2);
}

TEST(Door, EveryShippedInputIsSound) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const std::string file = entry.path().string();
    const bool scene_or_job = entry.path().extension() == ".toml";
    const bool curve = entry.path().extension() == ".csv" && file.find("chang2016") == file.npos;
    if (!scene_or_job && !curve) continue;
    const ProcessOutput answer = kerf("check " + file);
    EXPECT_EQ(answer.exit_code, 0) << answer.err;
    EXPECT_THAT(answer.out, HasSubstr(": ok, a ")) << file;
  }
}

TEST(Door, BadDataExitsWithThreeAndItsPlace) {
  EXPECT_EQ(kerf("check no/such/file.toml").exit_code, 3);
  const std::string sound = read_file(data + "scenes/verification_45.toml");
  const std::size_t at = sound.find("rake =");
  ASSERT_NE(at, sound.npos);
  const auto line = 1 + std::count(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  std::string broken = sound;
  broken.replace(at, 4, "raek");
  const std::string file = ::testing::TempDir() + "kerf_door_broken.toml";
  write_atomically(file, broken);
  const ProcessOutput answer = kerf("check " + file);
  std::filesystem::remove(file);
  EXPECT_EQ(answer.exit_code, 3);
  EXPECT_EQ(answer.err, file + ":" + std::to_string(line) + ":1: [tool] has no key \"raek\"; did you mean \"rake\"?\n");
}

TEST(Door, AFileOfAnotherKindIsNamed) {
  const std::string scene = data + "scenes/verification_45.toml", job = data + "jobs/ti6al4v.toml";
  const auto refused = [](const std::string& arguments) {
    const ProcessOutput answer = kerf(arguments);
    EXPECT_EQ(answer.exit_code, 3) << arguments;
    return answer.err;
  };
  EXPECT_THAT(refused("calibrate " + scene + " -o no_such_folder"), HasSubstr("is a scene; a job names one"));
  EXPECT_FALSE(std::filesystem::exists("no_such_folder"));
  EXPECT_THAT(refused("explain " + job), HasSubstr("is a job; `kerf check` reads it"));
  EXPECT_THAT(refused("coverage " + data + "scenes"), HasSubstr("holds no calibration"));
  EXPECT_THAT(refused("simulate " + job), HasSubstr("is a job; `kerf calibrate` runs it"));
  const std::string cut = ::testing::TempDir() + "kerf_door_cut.h5";
  write_atomically(cut, "\x89HDF");
  EXPECT_THAT(refused("check " + cut), HasSubstr("is a simulated cut"));
  std::filesystem::remove(cut);
}

TEST(Door, TheClosedFormAnswersOnlyForCutsThatItDescribes) {
  const auto refused = [](const std::string& arguments) {
    const ProcessOutput answer = kerf(arguments);
    EXPECT_EQ(answer.exit_code, 3) << arguments;
    EXPECT_EQ(answer.out, "") << arguments;
    return answer.err;
  };
  for (const char* command : {"next-cut ", "coverage "}) {
    EXPECT_THAT(refused(command + data + "jobs/wood_tl.toml"), HasSubstr("does not describe these cuts (chi2 = "));
    EXPECT_THAT(refused(command + data + "jobs/wood_tl_r_curve.toml"), HasSubstr("knows no R-curve"));
  }
  const ProcessOutput held = kerf("coverage " + data + "jobs/ti6al4v.toml");
  EXPECT_EQ(held.exit_code, 0) << held.err;
  const ProcessOutput next = kerf("next-cut " + data + "jobs/ti6al4v.toml");
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_THAT(next.out, HasSubstr("x 0."));
}

TEST(Door, ListPrintsTheDeclarations) {
  const ProcessOutput everything = kerf("list");
  EXPECT_EQ(everything.exit_code, 0);
  for (const char* word : {"[cohesive.mode_I]", "[[free]]", "yield_stress", "chip_ratio_sd", "toughness"})
    EXPECT_THAT(everything.out, HasSubstr(word));
  const ProcessOutput one = kerf("list tool");
  EXPECT_THAT(one.out, HasSubstr("rake"));
  EXPECT_THAT(one.out, ::testing::Not(HasSubstr("yield_stress")));
  const ProcessOutput misspelt = kerf("list cohesiv");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("did you mean \"cohesive\"?"));
}

}  // namespace
}  // namespace kerf
