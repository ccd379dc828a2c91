#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <set>
#include <thread>

#include "tests/recovery/twin_scene.hpp"
#include "tests/unit/synthetic_cut.hpp"

// The executable itself, killed and interrupted as users and machines do it.
namespace kerf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

pid_t start(const std::vector<std::string>& arguments, const fs::path& output, const fs::path& errors) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  const auto to = [](const fs::path& file, int descriptor) {
    ::dup2(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), descriptor);
  };
  to(output, STDOUT_FILENO);
  to(errors, STDERR_FILENO);
  std::vector<char*> words;
  std::vector<std::string> copies{KERF_EXECUTABLE};
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  for (std::string& word : copies) words.push_back(word.data());
  words.push_back(nullptr);
  ::execv(words[0], words.data());
  ::_exit(127);
}

int exit_of(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::size_t runs_in(const fs::path& folder) {
  std::ifstream journal(folder / "journal.jsonl");
  std::size_t runs = 0;
  for (std::string line; std::getline(journal, line);) runs += line.find("\"run\"") != std::string::npos;
  return runs;
}

/// Waits for the journal to hold `runs`, then sends `signal`; the exit of the process.
int stop_after(std::size_t runs, const fs::path& folder, pid_t child, int signal) {
  for (int i = 0; i < 6000 && runs_in(folder) < runs; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(child, signal);
  return exit_of(child);
}

/// One depth, so that a whole calibration is a dozen short runs.
class TwinResume : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::write_job(folder_, testing::coarse_job,
                       "#: rake = 30 deg\ndepth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm]\n0.5,10.8,0.3,-4.3,0.2\n",
                       testing::coarse_scene);
  }
  int run(const std::vector<std::string>& arguments) { return exit_of(launch(arguments)); }
  pid_t launch(const std::vector<std::string>& arguments) { return start(arguments, folder_ / "out", folder_ / "err"); }
  std::string said() const { return read_file(folder_ / "err"); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  json result(const std::string& name) const { return json::parse(read_file(folder_ / (name + "/result.json"))); }

  testing::TemporaryFolder folder_;
};

TEST_F(TwinResume, AKilledCalibrationGivesTheSameBitsAndRepeatsNothing) {
  ASSERT_EQ(run({"calibrate", path("job.toml"), "-o", path("whole")}), 0) << said();
  const json whole = result("whole");

  EXPECT_EQ(stop_after(3, folder_ / "killed", launch({"calibrate", path("job.toml"), "-o", path("killed")}), SIGKILL),
            -SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "killed/result.json"));
  const std::size_t kept = runs_in(folder_ / "killed");
  EXPECT_LT(kept, whole.at("runs").get<std::size_t>());

  // Ctrl-C on the way, and only the folder is left of the inputs.
  fs::remove(folder_ / "job.toml");
  fs::remove(folder_ / "scene.toml");
  fs::remove(folder_ / "curve.csv");
  EXPECT_EQ(stop_after(kept + 1, folder_ / "killed", launch({"resume", path("killed")}), SIGINT), 130);
  EXPECT_THAT(said(), ::testing::HasSubstr("kerf resume " + path("killed")));
  EXPECT_EQ(result("killed").at("partial"), true);
  EXPECT_EQ(result("killed").at("exit_code"), 130);

  ASSERT_EQ(run({"resume", path("killed"), "--json"}), 0) << said();
  const json resumed = result("killed");
  EXPECT_EQ(resumed.at("parameters").dump(), whole.at("parameters").dump());
  EXPECT_EQ(resumed.at("runs"), whole.at("runs"));
  EXPECT_EQ(json::parse(read_file(folder_ / "out")), resumed);

  std::set<std::string> keys;
  std::ifstream journal(folder_ / "killed/journal.jsonl");
  for (std::string line; std::getline(journal, line);) {
    const json entry = json::parse(line);
    if (!entry.contains("run")) continue;
    EXPECT_TRUE(keys.insert(entry.at("key")).second) << "a run was repeated";
  }
  EXPECT_EQ(keys.size(), whole.at("runs").get<std::size_t>());

  for (const char* file : {"manifest.json", "reduction.json", "cuts/001.h5", "cuts/001.json"})
    EXPECT_TRUE(fs::exists(folder_ / "killed" / file)) << file;
}

TEST_F(TwinResume, AStopFileAndATimeLimitEndItCleanly) {
  const pid_t child = launch({"calibrate", path("job.toml"), "-o", path("stopped")});
  for (int i = 0; i < 6000 && runs_in(folder_ / "stopped") < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  write_atomically(folder_ / "stopped/stop", "");
  EXPECT_EQ(exit_of(child), 130);
  EXPECT_THAT(said(), ::testing::HasSubstr("stopped by the file"));
  EXPECT_THAT(said(), ::testing::HasSubstr("kerf resume " + path("stopped")));
  EXPECT_EQ(result("stopped").at("partial"), true);

  EXPECT_EQ(run({"resume", path("stopped"), "--max-time", "1ms"}), 2);
  EXPECT_EQ(run({"resume", path("stopped"), "--max-time", "0.01s"}), 130);
  EXPECT_THAT(said(), ::testing::HasSubstr("--max-time"));
  EXPECT_EQ(run({"resume", path("stopped")}), 0);
  EXPECT_FALSE(result("stopped").contains("partial"));
}

TEST_F(TwinResume, AFullDiskIsSaidAndLosesNothing) {
  ASSERT_EQ(run({"calibrate", path("job.toml"), "-o", path("whole")}), 0) << said();
  const pid_t child = launch({"calibrate", path("job.toml"), "-o", path("full")});
  for (int i = 0; i < 6000 && runs_in(folder_ / "full") < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const rlimit little{5000, RLIM_INFINITY};  // of bytes: less than the journal has already
  ASSERT_EQ(::prlimit(child, RLIMIT_FSIZE, &little, nullptr), 0);
  EXPECT_EQ(exit_of(child), 3);
  EXPECT_THAT(said(), ::testing::ContainsRegex("full/.*cannot write.*File too large"));
  const std::size_t kept = runs_in(folder_ / "full");
  EXPECT_GE(kept, 2u);

  ASSERT_EQ(run({"resume", path("full")}), 0) << said();
  EXPECT_EQ(result("full").at("parameters"), result("whole").at("parameters"));
  EXPECT_EQ(runs_in(folder_ / "full"), result("whole").at("runs").get<std::size_t>());
}

TEST_F(TwinResume, AFolderThatCannotBeWrittenIsNamed) {
  EXPECT_EQ(run({"calibrate", path("job.toml"), "-o", "/proc/calibration"}), 3);
  EXPECT_THAT(said(), ::testing::HasSubstr("/proc/calibration: cannot create this folder"));
  fs::create_directories(folder_ / "locked");
  fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  if (::access((folder_ / "locked").c_str(), W_OK) != 0) {  // root may write everywhere
    EXPECT_EQ(run({"calibrate", path("job.toml"), "-o", path("locked")}), 3);
    EXPECT_THAT(said(), ::testing::HasSubstr("Permission denied"));
  }
  fs::permissions(folder_ / "locked", fs::perms::owner_all);
}

TEST_F(TwinResume, AFolderBelongsToOneJobAndOneProcess) {
  const pid_t first = launch({"calibrate", path("job.toml"), "-o", path("held")});
  for (int i = 0; i < 3000 && runs_in(folder_ / "held") < 1; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const pid_t second = start({"resume", path("held")}, folder_ / "out2", folder_ / "err2");
  EXPECT_EQ(exit_of(second), 3);
  EXPECT_THAT(read_file(folder_ / "err2"), ::testing::HasSubstr("another process"));
  ::kill(first, SIGKILL);
  exit_of(first);

  write_atomically(folder_ / "job.toml", testing::replaced(testing::coarse_job, "34 MPa", "30 MPa"));
  EXPECT_NE(run({"calibrate", path("job.toml"), "-o", path("held")}), 0);
  EXPECT_THAT(said(), ::testing::HasSubstr("kerf resume"));

  write_atomically(folder_ / "held/inputs/2_curve.csv", "changed");
  EXPECT_EQ(run({"resume", path("held")}), 3);
  EXPECT_THAT(said(), ::testing::HasSubstr("was changed"));

  EXPECT_NE(run({"resume", path("nowhere")}), 0);
  EXPECT_THAT(said(), ::testing::HasSubstr("kerf calibrate"));
}

}  // namespace
}  // namespace kerf
