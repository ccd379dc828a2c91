#include "inverse/child_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <bit>

#include "tests/unit/synthetic_cut.hpp"

// Runs in processes of their own: the executable itself, and scripts in its place that fail in every way.
namespace kerf {
namespace {

namespace fs = std::filesystem;
using inverse::ChildRuns;
using inverse::RunRecord;
using ::testing::HasSubstr;

inverse::RunRequest request() {
  std::string scene = testing::replaced(testing::scene_text, "travel = 6", "travel = 2");
  scene = testing::replaced(scene, "speed = \"10 m/s\"", "speed = \"40 m/s\"");
  return {.scene = Document::parse(scene, "scene.toml"), .label = "a cut", .cut = 0};
}

inverse::Budget quick_to_give_up() {
  inverse::Budget budget;
  budget.shortest_time_out = budget.first_time_out = 0.3;
  return budget;
}

/// An accepted cut as `kerf run` would write it.
std::string good_record() {
  forward::CutResult result;
  result.F_c.value = 10;
  result.F_t.value = -1;
  result.accepted = true;
  result.cost.wall_seconds = 0.01;
  return inverse::to_json(inverse::summarise(result)).dump();
}

/// A simulator that does as `body` says; $1 is the scene, $2 the record.
class Script : public ::testing::Test {
 protected:
  RunRecord run(const std::string& body, const std::function<bool()>& stop = {}) {
    write_atomically(folder_ / "good.json", good_record());
    write_atomically(folder_ / "simulator", "#!/bin/sh\ngood=" + (folder_ / "good.json").string() +
                                                "\nseen=" + (folder_ / "seen").string() + "\n" + body);
    ::chmod((folder_ / "simulator").c_str(), 0755);
    ChildRuns runs({(folder_ / "simulator").string()}, folder_ / "scratch", quick_to_give_up(), stop);
    return runs(request(), "key", std::nullopt);
  }
  testing::TemporaryFolder folder_;
};

TEST(ChildRuns, GiveTheBitsOfASimulationInThisProcess) {
  const testing::TemporaryFolder folder;
  ChildRuns runs({KERF_EXECUTABLE, "run"}, folder / "scratch", {}, {});
  const RunRecord there = runs(request(), "key", std::nullopt);
  const RunRecord here = inverse::summarise(forward::run(forward::read_scene(request().scene)));
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  EXPECT_EQ(bits(there.F_c.value), bits(here.F_c.value));
  EXPECT_EQ(bits(there.F_t.standard_error), bits(here.F_t.standard_error));
  EXPECT_EQ(bits(there.ledger.plastic), bits(here.ledger.plastic));
  EXPECT_EQ(there.refusals, here.refusals);
  EXPECT_TRUE(there.retried.empty());
  EXPECT_TRUE(fs::exists(runs.cut_file("key").value()));
  runs.journaled("key");
  EXPECT_FALSE(fs::exists(folder / "scratch/key.json"));
  EXPECT_TRUE(runs.cut_file("key").has_value());
}

TEST(ChildRuns, TakeWhatAProcessLeftBehind) {
  const testing::TemporaryFolder folder;
  write_atomically(folder / "scratch/key.json", good_record());
  ChildRuns runs({"/bin/false"}, folder / "scratch", {}, {});
  EXPECT_EQ(runs(request(), "key", std::nullopt).F_c.value, 10);
}

TEST_F(Script, ACrashIsRetriedWithASmallerStep) {
  const RunRecord record =
      run("if [ ! -e $seen ]; then touch $seen; kill -SEGV $$; fi\ngrep courant_number $1 > $seen\ncp $good $2\n");
  EXPECT_TRUE(record.accepted);
  EXPECT_FALSE(record.lost);
  EXPECT_THAT(record.retried, HasSubstr("crashed: Segmentation fault; again with resolution.courant_number = "));
  const double before = forward::read_scene(request().scene).resolution.courant_number;
  const std::string name = "courant_number = ", written = read_file(folder_ / "seen");
  EXPECT_DOUBLE_EQ(std::stod(written.substr(written.find(name) + name.size())), before / 2);
}

TEST_F(Script, ARunThatWorksIsNotHungForBeingSlow) {
  const RunRecord record = run("for i in 1 2 3 4 5 6 7 8; do n=$i; sleep 0.15; done\ncp $good $2\n");
  EXPECT_TRUE(record.accepted) << "four times its time by the clock, next to nothing of the processor's";
  EXPECT_TRUE(record.retried.empty()) << record.retried;
}

TEST_F(Script, ARunThatKeepsTheProcessorTooLongIsHung) {
  const RunRecord record = run("while :; do :; done\n");
  EXPECT_TRUE(record.lost);
  EXPECT_THAT(record.retried, HasSubstr("hung"));
}

TEST_F(Script, ARunThatHangsTwiceIsLost) {
  const RunRecord record = run("sleep 60 & wait\n");
  EXPECT_FALSE(record.accepted);
  EXPECT_TRUE(record.lost);
  EXPECT_THAT(record.retried, HasSubstr("hung: it was given 0.3 s of a processor"));
  EXPECT_THAT(record.refusals, ::testing::ElementsAre(HasSubstr("hung")));
  const RunRecord back = inverse::record_from_json(inverse::to_json(record));
  EXPECT_EQ(back.retried, record.retried);
  EXPECT_TRUE(back.lost);
}

TEST_F(Script, ForcesThatAreNotNumbersAreNotBelieved) {
  const RunRecord record = run("sed 's/\"F_c\":\\[10.0/\"F_c\":[\"nan\"/' $good > $2\n");
  EXPECT_TRUE(std::isnan(record.F_c.value));
  EXPECT_FALSE(record.accepted);
  EXPECT_THAT(record.retried, HasSubstr("not finite"));
}

TEST_F(Script, AnExitWithoutAResultSaysWhatTheProcessSaid) {
  EXPECT_THAT(run("echo out of luck >&2; exit 7\n").refusals.front(), HasSubstr("ended with code 7 and without a"));
  EXPECT_THAT(run("echo out of luck >&2; exit 7\n").refusals.front(), HasSubstr("out of luck"));
}

TEST_F(Script, AFullDiskIsNotTheFaultOfTheRun) {
  EXPECT_THAT([&] { run("echo '/x/key.json: cannot write: No space left on device' >&2; exit 3\n"); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("No space left")));
}

TEST_F(Script, TheWishToStopEndsTheProcessAndItsChildren) {
  EXPECT_THROW(run("(sleep 1; touch $seen) & wait\n", [&] { return fs::exists(folder_ / "scratch/key.toml"); }),
               inverse::Interrupted);
  std::this_thread::sleep_for(std::chrono::milliseconds(1300));
  EXPECT_FALSE(fs::exists(folder_ / "seen"));
}

TEST(ChildRuns, NoCommandIsAnErrorOfTheUser) {
  const testing::TemporaryFolder folder;
  ChildRuns runs({"/nowhere/kerf"}, folder / "scratch", {}, {});
  EXPECT_THAT([&] { runs(request(), "key", std::nullopt); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("/nowhere/kerf: cannot be executed")));
}

TEST(ChildRuns, GetATimeOutFromTheMedianOfTheirCut) {
  const testing::TemporaryFolder folder;
  const inverse::Job job = testing::write_job(folder);
  inverse::Journal journal(folder / "journal.jsonl");
  std::vector<std::optional<double>> medians;
  const auto runner = [&](const inverse::RunRequest&, const std::string&, std::optional<double> median) {
    medians.push_back(median);
    RunRecord record;
    record.wall_seconds = static_cast<double>(medians.size());
    record.lost = medians.size() == 2;
    return record;
  };
  inverse::RunDatabase database(journal, "test", runner, 1);
  Document scene = request().scene;
  for (const double depth : {0.1, 0.2, 0.3, 0.4, 0.5}) {
    scene.set_number("cut.depth", depth, forward::scene_blocks());
    database.run({{.scene = scene, .label = {}, .cut = 0}});
  }
  // The second took 2 s and is not counted, because it was lost.
  EXPECT_THAT(medians, ::testing::ElementsAre(std::nullopt, 1, 1, 3, 3));
}

}  // namespace
}  // namespace kerf
