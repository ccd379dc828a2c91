// The command line as a user meets it: output, messages and exit codes of the program itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "models/base/atomic_file.hpp"

namespace kerf {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Answer {
  int exit_code = -1;
  std::string text;  ///< standard output and error together
};

Answer kerf(const std::string& arguments) {
  Answer answer;
  const std::string command = std::string(KERF_EXECUTABLE) + " " + arguments + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) return answer;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe)) answer.text += buffer.data();
  const int status = ::pclose(pipe);
  answer.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

const std::string data = std::string(KERF_SOURCE_DIR) + "/data/";

TEST(Door, UsageErrorsExitWithTwoAndNameTheNearestCommand) {
  EXPECT_EQ(kerf("--help").exit_code, 0);
  EXPECT_THAT(kerf("--version").text, StartsWith("kerf "));
  EXPECT_EQ(kerf("").exit_code, 2);
  const Answer misspelt = kerf("chekc scene.toml");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.text, HasSubstr("no command \"chekc\"; did you mean \"check\"?"));
  EXPECT_EQ(kerf("list --nonsense").exit_code, 2);
}

TEST(Door, EveryShippedInputIsSound) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    const std::string file = entry.path().string();
    const bool scene_or_job = entry.path().extension() == ".toml";
    const bool curve = entry.path().extension() == ".csv" && file.find("chang2016") == file.npos;
    if (!scene_or_job && !curve) continue;
    const Answer answer = kerf("check " + file);
    EXPECT_EQ(answer.exit_code, 0) << answer.text;
    EXPECT_THAT(answer.text, HasSubstr(": ok, a ")) << file;
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
  const Answer answer = kerf("check " + file);
  std::filesystem::remove(file);
  EXPECT_EQ(answer.exit_code, 3);
  EXPECT_EQ(answer.text,
            file + ":" + std::to_string(line) + ":1: [tool] has no key \"raek\"; did you mean \"rake\"?\n");
}

TEST(Door, ListPrintsTheDeclarations) {
  const Answer everything = kerf("list");
  EXPECT_EQ(everything.exit_code, 0);
  for (const char* word : {"[cohesive.mode_I]", "[[free]]", "yield_stress", "chip_ratio_sd", "toughness"})
    EXPECT_THAT(everything.text, HasSubstr(word));
  const Answer one = kerf("list tool");
  EXPECT_THAT(one.text, HasSubstr("rake"));
  EXPECT_THAT(one.text, ::testing::Not(HasSubstr("yield_stress")));
  const Answer misspelt = kerf("list cohesiv");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.text, HasSubstr("did you mean \"cohesive\"?"));
}

}  // namespace
}  // namespace kerf
