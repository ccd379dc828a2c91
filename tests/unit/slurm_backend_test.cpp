#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "inverse/child_runs.hpp"
#include "tests/unit/synthetic_cut.hpp"

// The Slurm backend against an sbatch and a scancel of our own, which stand first on the PATH. What this does not
// prove: that a real Slurm takes the same options; scripts/slurm_test.sh does.
namespace kerf {
namespace {

namespace fs = std::filesystem;
using inverse::ChildRuns;
using inverse::RunRecord;
using ::testing::HasSubstr;

/// Finds in its options what a cluster needs, runs the job in the background and waits for it.
constexpr const char* sbatch = R"(
for option in "$@"; do
  case $option in
    --wrap=*) job=${option#--wrap=} ;;
    --error=*) errors=${option#--error=} ;;
  esac
  echo "$option" >> "$here/options"
done
sh -c "$job" 2> "$errors" & echo $! > "$here/job"
wait $!
)";

class SlurmBackend : public ::testing::Test {
 protected:
  SlurmBackend() : path_(std::getenv("PATH")) {  // NOLINT(concurrency-mt-unsafe)
    fs::create_directories(folder_ / "bin");
    ::setenv("PATH", ((folder_ / "bin").string() + ":" + path_).c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    script("bin/scancel", "echo \"$@\" >> \"$here/cancelled\"\nkill $(cat \"$here/job\")\n");
    script("bin/sbatch", sbatch);
  }
  ~SlurmBackend() override { ::setenv("PATH", path_.c_str(), 1); }  // NOLINT(concurrency-mt-unsafe)

  void script(const std::string& name, const std::string& body) const {
    write_atomically(folder_ / name, "#!/bin/sh\nhere='" + folder_.path().string() + "'\n" + body);
    ::chmod((folder_ / name).c_str(), 0755);
  }
  /// A simulator that does as `body` says; $1 is the scene, $2 the record, $good a record to copy.
  RunRecord run(const std::string& body, const std::function<bool()>& stop = {}) {
    forward::CutResult result;
    result.F_c.value = 10;
    result.accepted = true;
    write_atomically(folder_ / "good.json", inverse::to_json(inverse::summarise(result)).dump());
    script("it's a simulator", "good=$here/good.json\n" + body);  // a name that a shell would trip over
    inverse::Budget budget;
    budget.backend = "slurm";
    budget.first_time_out = budget.shortest_time_out = 0.3;
    ChildRuns runs({(folder_ / "it's a simulator").string()}, folder_ / "scratch", budget, stop);
    return runs({.scene = Document::parse(testing::scene_text, "scene.toml"), .label = {}, .cut = 0}, "key",
                std::nullopt);
  }
  std::string content(const std::string& name) const { return read_file(folder_ / name); }

  testing::TemporaryFolder folder_;
  std::string path_;
};

TEST_F(SlurmBackend, BringsBackTheRecordOfAJob) {
  const RunRecord record = run("cp \"$good\" \"$2\"\n");
  EXPECT_TRUE(record.accepted);
  EXPECT_EQ(record.F_c.value, 10);
  EXPECT_TRUE(record.retried.empty());
  for (const char* option : {"--wait", "--requeue", "--dependency=singleton", "--job-name=kerf-key\n"})
    EXPECT_THAT(content("options"), HasSubstr(option));
  EXPECT_FALSE(fs::exists(folder_ / "cancelled"));
}

TEST_F(SlurmBackend, MakesALostJobAgain) {
  script("bin/sbatch", "if [ ! -e \"$here/lost\" ]; then touch \"$here/lost\"; exit 1; fi\n" + std::string(sbatch));
  const RunRecord record = run("cp \"$good\" \"$2\"\n");
  EXPECT_TRUE(record.accepted);
  EXPECT_THAT(record.retried, HasSubstr("ended with code 1 and without a result"));
  EXPECT_THAT(content("options"), HasSubstr("--job-name=kerf-key-safer"));
}

TEST_F(SlurmBackend, SaysWhatAJobSaidThatIsLostTwice) {
  const RunRecord record = run("echo out of luck >&2\nexit 7\n");
  EXPECT_FALSE(record.accepted);
  EXPECT_TRUE(record.lost);
  EXPECT_THAT(record.refusals, ::testing::ElementsAre(HasSubstr("code 7 and without a result: out of luck")));
}

// A second or more in the queue, against a time-out of 0.3 s that is rounded up on the node.
TEST_F(SlurmBackend, CountsTheTimeOutOnTheNodeAndNotInTheQueue) {
  script("bin/sbatch", "sleep 1.2\n" + std::string(sbatch));
  EXPECT_TRUE(run("cp \"$good\" \"$2\"\n").accepted);
  script("bin/sbatch", sbatch);
  fs::remove_all(folder_ / "scratch");  // whose record would be taken
  const RunRecord hung = run("sleep 60\n");
  EXPECT_TRUE(hung.lost);
}

TEST_F(SlurmBackend, CancelsTheJobOnTheWishToStop) {
  EXPECT_THROW(run("exec sleep 60\n", [&] { return fs::exists(folder_ / "job"); }), inverse::Interrupted);
  EXPECT_EQ(content("cancelled"), "--quiet --name=kerf-key\n");
}

TEST_F(SlurmBackend, WithoutSbatchIsAnErrorOfTheUser) {
  fs::remove(folder_ / "bin/sbatch");
  ::setenv("PATH", (folder_ / "bin").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_THAT([&] { run("exit 0\n"); }, ::testing::ThrowsMessage<InputError>(HasSubstr("sbatch: cannot be executed")));
}

}  // namespace
}  // namespace kerf
