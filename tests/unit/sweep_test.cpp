// Virtual experiments: what the command line means, that nothing is simulated twice, and that no run is lost.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <set>
#include <thread>

#include "forward/scene/scene.hpp"
#include "inverse/sweep.hpp"
#include "inverse/sweep_file.hpp"
#include "inverse/sweep_table.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using inverse::Sweep;
using inverse::SweepAxis;
using inverse::SweepRecords;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

SweepAxis axis(const std::string& text) {
  return inverse::parse_axis(text, forward::scene_blocks(), "sweep");
}

std::vector<double> shown(const SweepAxis& axis) {
  std::vector<double> values;
  for (const auto& value : axis.values) values.push_back(*value.shown);
  return values;
}

Sweep lay_out(const std::vector<std::string>& axes, bool zip = false) {
  return inverse::lay_out_sweep(Document::parse(testing::scene_text, "scene.toml"), axes, zip, "sweep");
}

TEST(SweepAxis, TheLastUnitHoldsForAllThatHaveNone) {
  const SweepAxis depth = axis("cut.depth=0.25, 500um,1mm");
  EXPECT_EQ(depth.unit, "mm");
  EXPECT_THAT(shown(depth), ElementsAre(0.25, 0.5, 1));
  EXPECT_EQ(depth.values[1].number, 0.5);
  EXPECT_EQ(depth.heading(), "cut.depth[mm]");
  EXPECT_EQ(axis("cut.depth=250,500um").values[0].number, 0.25);
  const SweepAxis friction = axis("friction.coefficient=0,0.2");
  EXPECT_EQ(friction.unit, "1");
  EXPECT_EQ(friction.heading(), "friction.coefficient");
}

TEST(SweepAxis, RangesAreEvenlySpacedOrInEqualRatios) {
  EXPECT_THAT(shown(axis("cut.depth=0.1:0.5:5mm")), ElementsAre(0.1, 0.2, 0.3, 0.4, 0.5));
  EXPECT_THAT(shown(axis("cut.depth=0.1:0.3mm:2")), ElementsAre(0.1, 0.3));
  EXPECT_THAT(shown(axis("cut.depth=log:0.1:10:3mm,20mm")), ElementsAre(0.1, 1, 10, 20));
  EXPECT_THAT(shown(axis("tool.rake=-10:30:3deg")), ElementsAre(-10, 10, 30));
}

TEST(SweepAxis, SeveralKeysShareAValueAndAKeyMayBeLeftOut) {
  const SweepAxis strength = axis("cohesive.mode_I.strength+cohesive.mode_II.strength=20,40MPa");
  EXPECT_THAT(strength.paths, ElementsAre("cohesive.mode_I.strength", "cohesive.mode_II.strength"));
  const Sweep sweep = lay_out(
      {"cohesive.mode_I.strength+cohesive.mode_II.strength=20,40MPa", "friction.coefficient=-,0.5", "title=one,two"});
  ASSERT_EQ(sweep.runs.size(), 8u);
  const forward::Scene first = forward::read_scene(sweep.runs[0].scene),
                       last = forward::read_scene(sweep.runs[7].scene);
  EXPECT_EQ(first.cohesive.mode_I->strength(), 20);
  EXPECT_EQ(first.cohesive.mode_II->strength(), 20);
  EXPECT_FALSE(first.friction);  // the table cannot do without its coefficient
  EXPECT_EQ(first.title, "one");
  EXPECT_EQ(last.cohesive.mode_II->strength(), 40);
  EXPECT_EQ(last.friction->coefficient, 0.5);
  EXPECT_EQ(last.title, "two");
  EXPECT_EQ(sweep.runs[0].label, "strength = 20 MPa, no friction, title = one");

  // A table that the scene lacks is added.
  const Sweep damped = lay_out({"pic_damping.rate=0.1"});
  EXPECT_EQ(forward::read_scene(damped.runs[0].scene).pic_damping->rate, 0.1);
}

TEST(SweepAxis, EveryMistakeIsNamed) {
  struct Case {
    const char* text;
    const char* fragment;
  };
  for (const Case& c : {Case{"cut.dept=1mm", "no parameter \"cut.dept\"; did you mean \"cut.depth\"?"},
                        Case{"depth=1mm", "did you mean \"cut.depth\"?"},
                        Case{"cut.depth", "is not PATH=VALUES"},
                        Case{"=1mm", "is not PATH=VALUES"},
                        Case{"cut.depth=", "has no values"},
                        Case{"cut.depth=1,,2mm", "empty value"},
                        Case{"cut.depth=1mm,", "empty value"},
                        Case{"cut.depth=1,2", "has no unit; write for example 1mm"},
                        Case{"cut.depth=1deg", "does not measure this"},
                        Case{"cut.depth=1furlongg", "is not a unit"},
                        Case{"cut.depth=5m", "above 100 mm (allowed: 0.0001 to 100 mm); did you mean mm?"},
                        Case{"cut.depth=1mm,1000um", "twice"},
                        Case{"cut.depth=deep", "does not begin with a number"},
                        Case{"friction.coefficient=0.2mm", "a pure number belongs here"},
                        Case{"cut.depth=1:2mm", "FROM:TO:COUNT"},
                        Case{"cut.depth=1:2:1mm", "2 to 1000"},
                        Case{"cut.depth=1:2:2.5mm", "a whole number"},
                        Case{"cut.depth=1:1:3mm", "begins where it ends"},
                        Case{"cut.depth=1mm:200um:3", "two units"},
                        Case{"cut.depth=log:-1:2:3mm", "positive ends"},
                        Case{"cut.depth+tool.rake=1mm", "measures something else"},
                        Case{"cut.depth+cut.depth=1mm", "names a path twice"},
                        Case{"friction=0.2", "can only be left out: friction=-"},
                        Case{"title=a,a", "twice"}}) {
    try {
      axis(c.text);
      ADD_FAILURE() << c.text << " was read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.fragment)) << c.text;
      EXPECT_EQ(error.code(), ExitCode::usage) << c.text;
    }
  }
}

TEST(Sweep, GridsAndPairs) {
  const std::vector<std::string> axes{"cut.depth=0.25,0.5mm", "tool.rake=15,30,45deg"};
  const Sweep grid = lay_out(axes);
  ASSERT_EQ(grid.runs.size(), 6u);
  EXPECT_THAT(grid.runs[1].choice, ElementsAre(0u, 1u));  // the last axis changes fastest
  EXPECT_EQ(forward::read_scene(grid.runs[3].scene).cut.depth, 0.5);
  EXPECT_THAT(inverse::lines_along(grid, 0),
              ElementsAre(ElementsAre(0u, 3u), ElementsAre(1u, 4u), ElementsAre(2u, 5u)));

  const Sweep pairs = lay_out({"cut.depth=0.25,0.5,1mm", "cut.travel=12,9,9", "tool.rake=20deg"}, true);
  ASSERT_EQ(pairs.runs.size(), 3u);
  EXPECT_EQ(forward::read_scene(pairs.runs[2].scene).cut.travel, 9);
  EXPECT_THAT(pairs.runs[2].choice, ElementsAre(2u, 2u, 0u));  // a single value holds for all
  EXPECT_THAT(inverse::lines_along(pairs, 0), ElementsAre(ElementsAre(0u, 1u, 2u)));
  EXPECT_THAT([&] { lay_out(axes, true); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("cut.depth has 2 and tool.rake has 3")));
  EXPECT_THAT(
      [&] {
        lay_out({"cut.depth=1mm", "cut.depth=2mm"});
      },
      ::testing::ThrowsMessage<InputError>(HasSubstr("\"cut.depth\" is swept twice")));
}

TEST(Sweep, AValueThatNoSceneCanHoldIsAnErrorBeforeTheFirstRun) {
  EXPECT_THAT([] { lay_out({"resolution.cells_through_chip=4,4.5"}); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("4.5 must be a whole number")));
  EXPECT_THAT([] { lay_out({"cohesive.mode_I.law=cubik"}); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("did you mean \"cubic\"?")));
  EXPECT_THAT([] { lay_out({"material.yield_stress=-"}); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("lacks the key \"yield_stress\"")));
}

/// Six depths at two frictions.
std::vector<std::string> some_axes() {
  return {"cut.depth=0.1,0.2,0.3,0.5,0.7,1mm", "friction.coefficient=0.2,0.4"};
}

struct Ran {
  SweepRecords records;
  std::size_t simulated;
};

Ran run(const Sweep& sweep, const fs::path& journal_file, const inverse::Simulator& simulate) {
  inverse::Journal journal(journal_file);
  inverse::RunDatabase database(journal, "test", simulate, 2);
  std::vector<inverse::RunRequest> requests;
  for (std::size_t i = 0; i < sweep.runs.size(); ++i)
    requests.push_back({.scene = sweep.runs[i].scene, .label = sweep.runs[i].label, .cut = i});
  try {
    database.run(requests);
  } catch (const inverse::Interrupted&) {
  }
  Ran ran{.records = {}, .simulated = database.simulated()};
  for (const auto& one : sweep.runs) ran.records.push_back(database.find(one.scene));
  return ran;
}

const inverse::Column& column(const std::vector<inverse::Column>& columns, const std::string& name) {
  for (const auto& candidate : columns)
    if (candidate.name == name) return candidate;
  throw std::logic_error("no column " + name);
}

TEST(Sweep, ResumesWithoutRepeatingARunAndWithTheSameTable) {
  const TemporaryFolder folder;
  const Sweep sweep = lay_out(some_axes());
  const Ran whole = run(sweep, folder / "whole.jsonl", testing::failing(0.3, testing::synthetic_cut));
  EXPECT_EQ(whole.simulated, 12u);

  std::atomic<int> left = 5;
  const auto stopping = [&](const forward::Scene& scene) {
    if (left-- <= 0) throw inverse::Interrupted{};
    return testing::failing(0.3, testing::synthetic_cut)(scene);
  };
  const Ran part = run(sweep, folder / "part.jsonl", stopping);
  EXPECT_EQ(part.simulated, 5u);
  const auto partial = inverse::sweep_columns(sweep, part.records);
  const auto& verdicts = column(partial, "verdict").cells;
  EXPECT_EQ(std::count(verdicts.begin(), verdicts.end(), ordered_json("not run")), 7);
  EXPECT_FALSE(inverse::sweep_json(sweep, part.records, {}, {}, {}).at("complete").get<bool>());

  const Ran rest = run(sweep, folder / "part.jsonl", testing::failing(0.3, testing::synthetic_cut));
  EXPECT_EQ(rest.simulated, 7u);
  EXPECT_EQ(inverse::csv(inverse::sweep_columns(sweep, rest.records)),
            inverse::csv(inverse::sweep_columns(sweep, whole.records)));
}

TEST(Sweep, EveryRunIsARowAndEveryNumberOfAResultAColumn) {
  const TemporaryFolder folder;
  // Without friction its cap has no place: that combination is refused by the reader, the others run.
  const Sweep sweep = lay_out({"friction.coefficient=-,0.2", "friction.yield_cap=-,0.5"});
  ASSERT_EQ(sweep.runs.size(), 4u);
  const auto simulate = [](const forward::Scene& scene) {
    forward::CutResult result;
    result.F_c = {8, 0.02};
    result.F_t = {-4, 0.01};
    result.chip_ratio = {1.5, 0.1};
    result.ledger.tool_work = 10;
    result.ledger.plastic = 9.9;
    result.cost.processor_seconds = 3;
    result.branch = scene.friction ? forward::Branch::touching : forward::Branch::bending;
    result.accepted = !scene.friction || scene.friction->yield_cap != 0.5;
    if (!result.accepted) result.refusals = {"said \"no\", twice", "and again"};
    return result;
  };
  const Ran ran = run(sweep, folder / "journal.jsonl", simulate);
  EXPECT_EQ(ran.simulated, 3u);
  const auto columns = inverse::sweep_columns(sweep, ran.records);
  EXPECT_THAT(column(columns, "verdict").cells, ElementsAre("accepted", "refused", "accepted", "refused"));
  EXPECT_THAT(column(columns, "branch").cells, ElementsAre("bending", nullptr, "touching", "touching"));
  EXPECT_EQ(column(columns, "F_c").unit, "N/m");
  EXPECT_THAT(column(columns, "F_c").cells, ElementsAre(8000.0, nullptr, 8000.0, 8000.0));
  EXPECT_EQ(column(columns, "F_c_se").cells[0], 20.0);
  EXPECT_EQ(column(columns, "F_t_over_F_c").cells[0], -0.5);
  EXPECT_NEAR(column(columns, "residue_share").cells[0].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(column(columns, "core_seconds").cells[2], 3.0);
  EXPECT_THAT(column(columns, "refusals").cells[1].get<std::string>(), HasSubstr("coefficient"));
  // Whatever else the result holds comes along by itself, with its unit.
  EXPECT_EQ(column(columns, "ledger.plastic").heading(), "ledger.plastic[J/m]");
  EXPECT_EQ(column(columns, "deepest_penetration").unit, "cells");

  const std::string csv = inverse::csv(columns);
  EXPECT_THAT(csv, ::testing::StartsWith("run,friction.coefficient,friction.yield_cap,verdict,F_c[N/m],F_c_se[N/m],"));
  EXPECT_THAT(csv, HasSubstr("\n1,,,accepted,8000,20,-4000,10,-0.5,bending,"));
  EXPECT_THAT(csv, HasSubstr("\"said \"\"no\"\", twice; and again\""));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);

  const ordered_json json = inverse::sweep_json(sweep, ran.records, {}, {}, {{"version", "x"}});
  EXPECT_TRUE(json.at("complete").get<bool>());
  EXPECT_EQ(json.at("cost").at("refused"), 2);
  EXPECT_TRUE(json.at("runs").at(1).at("result").is_null());
  EXPECT_EQ(json.at("runs").at(3).at("result").at("F_c").at("value"), 8000.0);
  EXPECT_EQ(json.at("runs").at(0).at("values"), ordered_json::parse("[null,null]"));
  EXPECT_EQ(json.at("manifest").at("version"), "x");

  inverse::write_sweep(folder / "sweep.h5", sweep, columns, std::vector<fs::path>(4, folder / "absent.h5"));
  EXPECT_GT(fs::file_size(folder / "sweep.h5"), 1000u);
}

TEST(Sweep, ExtrapolatesEachLineAgainstTheToughnessOfTheScene) {
  const TemporaryFolder folder;
  const Sweep sweep = lay_out(some_axes());
  const auto refuses_deepest = [](const forward::Scene& scene) {
    forward::CutResult result = testing::synthetic_cut(scene);
    result.accepted = scene.cut.depth < 0.9;
    return result;
  };
  const Ran ran = run(sweep, folder / "journal.jsonl", refuses_deepest);
  const auto lines = inverse::sweep_intercepts(sweep, ran.records);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1].held, "friction = 0.4");
  EXPECT_THAT(lines[0].runs, ElementsAre(0u, 2u, 4u, 6u, 8u));
  EXPECT_EQ(lines[0].line.size(), 6u);
  const auto intercept = [&](const char* method) {
    return lines[0].reduction.find(method)->fit.find("toughness")->value;
  };
  EXPECT_EQ(lines[0].toughness_I, 1.0);
  EXPECT_NEAR(intercept("intercept_model"), 1.0, 1e-3);  // the law that made the forces
  EXPECT_GT(intercept("intercept_linear"), 1.02);
  const ordered_json json = inverse::sweep_json(sweep, ran.records, lines, {}, {});
  EXPECT_EQ(json.at("intercepts").at(0).at("toughness").at("mode_I"), 1000.0);
  EXPECT_TRUE(json.at("intercepts").at(0).at("reduction").at("methods").contains("intercept_quadratic"));

  EXPECT_TRUE(inverse::sweep_intercepts(lay_out({"tool.rake=15,30deg"}), SweepRecords(2)).empty());
  const Sweep two = lay_out({"cut.depth=0.1,0.2mm"});
  EXPECT_THAT(inverse::sweep_intercepts(two, SweepRecords(2)).at(0).not_applied, HasSubstr("two depths"));
}

/// The commands as a user calls them, on cuts so coarse and short that each takes a moment.
class SweepCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string scene = content_of(fs::path(KERF_SOURCE_DIR) / "data/scenes/verification_45.toml");
    scene = testing::replaced(scene, "cells_through_chip = 8", "cells_through_chip = 4");
    scene = testing::replaced(scene, "travel = 9", "travel = 1.5");
    write_atomically(scene_, scene);
  }
  ProcessOutput kerf(const std::string& arguments, const std::string& environment = "KERF_PYTHON=/nonexistent") {
    return run_kerf(arguments, folder_.path(), environment);
  }
  std::string sweep(const std::string& more) { return "sweep " + scene_.string() + " " + more; }

  /// Keys of the runs in the journal; a repeated one would be there twice.
  std::vector<std::string> journaled() {
    std::vector<std::string> keys;
    std::ifstream journal(out_ / "journal.jsonl");
    for (std::string line; std::getline(journal, line);) {
      const auto json = ordered_json::parse(line, nullptr, false);
      if (!json.is_discarded() && json.contains("run")) keys.push_back(json.at("key").get<std::string>());
    }
    return keys;
  }

  /// Starts the sweep on one core and sends `signal` once `enough` runs are in the journal.
  int disturbed(const std::vector<std::string>& axes, std::size_t enough, int signal) {
    std::vector<std::string> arguments{KERF_EXECUTABLE, "sweep", scene_.string()};
    arguments.insert(arguments.end(), axes.begin(), axes.end());
    arguments.insert(arguments.end(), {"-o", out_.string(), "-j", "1"});
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      ::setenv("KERF_PYTHON", "/nonexistent", 1);
      for (const int stream : {1, 2})
        ::dup2(::open((folder_ / (stream == 1 ? "out.txt" : "err.txt")).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
               stream);
      ::execv(KERF_EXECUTABLE, pointers.data());
      ::_exit(99);
    }
    int status = 0;
    while (journaled().size() < enough) {
      if (::waitpid(child, &status, WNOHANG) == child) {
        ADD_FAILURE() << "the sweep ended before it could be disturbed: " << content_of(folder_ / "err.txt");
        return -1;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ::kill(child, signal);
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  TemporaryFolder folder_;
  fs::path scene_ = folder_ / "scene.toml", out_ = folder_ / "sweep";
};

TEST_F(SweepCommand, SurvivesCtrlCAndKill9AndEndsWithItsReport) {
  const std::vector<std::string> axes{"cut.depth=0.25,0.5,1mm", "tool.rake=30,45deg"};
  EXPECT_EQ(disturbed(axes, 1, SIGINT), 130);
  EXPECT_THAT(content_of(folder_ / "err.txt"), HasSubstr("kerf resume " + out_.string()));
  EXPECT_THAT(content_of(folder_ / "out.txt"), HasSubstr("not run"));
  EXPECT_THAT(content_of(out_ / "sweep.csv"), HasSubstr(",not run,"));
  EXPECT_LT(journaled().size(), 6u);
  const std::size_t before = journaled().size();
  if (before < 5) {
    EXPECT_EQ(disturbed(axes, before + 1, SIGKILL), -SIGKILL);
  }

  const ProcessOutput other = kerf(sweep("cut.depth=2mm -o " + out_.string()));
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("holds another sweep"));

  const ProcessOutput resumed = kerf("resume " + out_.string() + " --json", "");
  EXPECT_EQ(resumed.exit_code, 4) << resumed.err;  // so short a cut is never accepted
  const auto json = ordered_json::parse(resumed.out);
  EXPECT_TRUE(json.at("complete").get<bool>());
  EXPECT_EQ(json.at("runs").size(), 6u);
  EXPECT_FALSE(json.at("runs").at(0).at("refusals").empty());
  const std::vector<std::string> keys = journaled();
  EXPECT_EQ(keys.size(), 6u);
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), 6u) << "a run was repeated";
  for (const char* file : {"sweep.csv", "sweep.json", "sweep.h5", "sweep.svg", "report.html", "cuts/006.h5"})
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
  EXPECT_THAT(content_of(out_ / "report.html"), HasSubstr("6 simulated cuts over"));

  fs::remove(out_ / "report.html");
  EXPECT_EQ(kerf("report " + out_.string(), "").exit_code, 0);
  EXPECT_TRUE(fs::exists(out_ / "report.html"));
  const ProcessOutput again = kerf(sweep("cut.depth=0.25,0.5,1mm tool.rake=30,45deg -o " + out_.string()));
  EXPECT_EQ(again.exit_code, 4);
  EXPECT_THAT(again.err, HasSubstr("0 of 6 runs to simulate"));
  EXPECT_THAT(again.err, HasSubstr("kerf report"));  // says how to draw what this Python could not
  EXPECT_EQ(journaled().size(), 6u);
}

TEST_F(SweepCommand, ADryRunTellsTheCostAndLeavesNothing) {
  const ProcessOutput dry = kerf(sweep("cut.depth=0.25,0.5mm tool.rake=30,45deg --dry-run -o " + out_.string()));
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("4 runs, "));
  EXPECT_THAT(dry.out, HasSubstr("particle-steps"));
  EXPECT_FALSE(fs::exists(out_));
  EXPECT_EQ(kerf(sweep("cut.depth=1mm")).exit_code, 2);  // where to?
  EXPECT_EQ(kerf(sweep("cut.dept=1mm -o " + out_.string())).exit_code, 2);
  EXPECT_EQ(kerf(sweep("resolution.cells_through_chip=4.5 -o " + out_.string())).exit_code, 3);
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(SweepCommand, SimulateTakesSingleValuesTheSameWay) {
  const std::string h5 = (folder_ / "cut.h5").string();
  const ProcessOutput run = kerf("simulate --set tool.rake=30deg --set friction.coefficient=0.2 " + scene_.string() +
                                 " -o " + h5 + " --json");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_GT(ordered_json::parse(run.out).at("faces").at("rake_tangential").at("value"), 0.0);
  const auto refused = [&](const std::string& settings) {
    const ProcessOutput answer = kerf("simulate " + scene_.string() + " " + settings);
    EXPECT_EQ(answer.exit_code, 2) << answer.err;
    return answer.err;
  };
  EXPECT_THAT(refused("--set tool.raek=30deg"), HasSubstr("did you mean \"tool.rake\"?"));
  EXPECT_THAT(refused("--set tool.rake=30,45deg"), HasSubstr("one value belongs here"));
  EXPECT_THAT(refused("--set tool.rake=30deg --set tool.rake=45deg"), HasSubstr("is set twice"));
}

}  // namespace
}  // namespace kerf
