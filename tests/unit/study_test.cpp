// What accuracy costs: orders of convergence that were put in come out, the front is the front, a knob turns nothing
// else, and no run is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "forward/scene/preset.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/convergence.hpp"
#include "inverse/study.hpp"
#include "inverse/study_table.hpp"
#include "inverse/sweep_axis.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using inverse::Convergence;
using inverse::ForceAtCell;
using inverse::Study;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

constexpr double limit = 7.5, amplitude = 0.4;

/// F_0 + C h^p at 1/n of the depth, disturbed by normal errors of a given size (also the one that is claimed).
std::vector<ForceAtCell> forces_of_order(double order, const std::vector<int>& cells, double error, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<ForceAtCell> forces;
  for (const int n : cells)
    forces.push_back({1.0 / n, {limit + amplitude * std::pow(4.0 / n, order) + error * normal(random), error}});
  return forces;
}

TEST(Convergence, RecoversOrderAndLimitWithoutNoise) {
  for (const double order : {0.7, 1.0, 2.0, 3.0}) {
    const Convergence found = inverse::convergence(forces_of_order(order, {4, 6, 8, 12}, 1e-9, 1));
    EXPECT_EQ(found.not_resolved, "") << order;
    EXPECT_NEAR(found.order.value, order, 1e-5);
    EXPECT_NEAR(found.limit.value, limit, 1e-6);
    EXPECT_NEAR(found.amplitude, amplitude, 1e-6);
  }
}

TEST(Convergence, ThreeCellSizesGiveTheRichardsonValueAndItsPropagatedError) {
  // 2 : 1 : 1/2, where order and limit are known in closed form: p = log2((F_1 - F_2) / (F_2 - F_3)).
  const double error = 1e-3, coarse = 8.0, middle = 7.7, fine = 7.6;
  const Convergence found = inverse::convergence({{4, {coarse, error}}, {2, {middle, error}}, {1, {fine, error}}});
  const double ratio = (coarse - middle) / (middle - fine);
  EXPECT_NEAR(found.order.value, std::log2(ratio), 1e-6);
  EXPECT_NEAR(found.limit.value, fine - (middle - fine) / (ratio - 1), 1e-6);
  const double step = middle - fine, slope = 1 / std::log(2.0);
  const double order_error = slope * error *
                             std::sqrt(std::pow(1 / (coarse - middle), 2) +
                                       std::pow(1 / (coarse - middle) + 1 / step, 2) + std::pow(1 / step, 2));
  EXPECT_NEAR(found.order.standard_error, order_error, 1e-3 * order_error);
  EXPECT_EQ(found.freedom, 0);
}

TEST(Convergence, ItsIntervalsHoldTheTruthAsOftenAsTheySay) {
  int order_held = 0, limit_held = 0, resolved = 0;
  const int seeds = 200;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const Convergence found = inverse::convergence(forces_of_order(2, {4, 5, 6, 8, 10, 12}, 0.004, seed));
    if (!found.not_resolved.empty()) continue;
    ++resolved;
    order_held += found.order_lower <= 2 && 2 <= found.order_upper;
    limit_held += found.limit_lower <= limit && limit <= found.limit_upper;
  }
  EXPECT_EQ(resolved, seeds);
  // 95 % of 200, binomial standard deviation 3; a fit that is rejected by chance is widened, which holds more.
  EXPECT_GE(order_held, 181);
  EXPECT_GE(limit_held, 181);
  EXPECT_LE(order_held, 199);
}

TEST(Convergence, SaysWhenNoiseHidesTheOrder) {
  int silent = 0;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Convergence found = inverse::convergence(forces_of_order(2, {4, 6, 8, 10}, 1.0, seed));
    silent += !found.not_resolved.empty();
    EXPECT_LT(std::abs(found.limit.value - limit), 5.0);
  }
  EXPECT_GE(silent, 48);
  const Convergence flat = inverse::convergence({{4, {7.5, 0.1}}, {3, {7.6, 0.1}}, {2, {7.45, 0.1}}});
  EXPECT_THAT(flat.not_resolved, HasSubstr("agree within their standard errors"));
  EXPECT_NEAR(flat.limit.value, (7.5 + 7.6 + 7.45) / 3, 1e-12);
  EXPECT_NEAR(flat.limit.standard_error, 0.1 / std::sqrt(3), 1e-12);
}

TEST(Convergence, ForcesThatFollowNoPowerLawAreSaidToBeSo) {
  // Up and down by far more than the errors: nothing converges.
  const Convergence found =
      inverse::convergence({{6, {7.0, 0.01}}, {5, {8.0, 0.01}}, {4, {7.1, 0.01}}, {3, {7.9, 0.01}}, {2, {7.2, 0.01}}});
  EXPECT_NE(found.not_resolved, "");
  EXPECT_GT(found.scatter, 10);
  EXPECT_THAT(inverse::convergence({{4, {7.5, 0.1}}, {2, {7.6, 0.1}}, {2, {7.6, 0.1}}}).not_resolved,
              HasSubstr("2 accepted cell sizes"));
}

TEST(ParetoFront, IsWhatNoOtherPointBeats) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> count(0, 30), value(1, 8);  // few values, so that there are equals
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<inverse::CostAndError> points;
    for (int n = count(random); n > 0; --n) points.push_back({1.0 * value(random), 1.0 * value(random)});
    const std::vector<bool> front = inverse::pareto_front(points);
    ASSERT_EQ(front.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool beaten = std::any_of(points.begin(), points.end(), [&](const auto& other) {
        return other.cost <= points[i].cost && other.error <= points[i].error &&
               (other.cost < points[i].cost || other.error < points[i].error);
      });
      EXPECT_EQ(front[i], !beaten);
    }
  }
}

Document scene() {
  return Document::parse(testing::scene_text, "scene.toml");
}

Study lay_out(const std::vector<std::string>& knobs, const std::vector<std::string>& reference = {},
              const Document& of = scene()) {
  return inverse::lay_out_study(of, knobs, reference, "kerf study");
}

std::vector<std::string> labels(const Study& study) {
  std::vector<std::string> all;
  for (const inverse::StudyRun& run : study.runs) all.push_back(run.label);
  return all;
}

TEST(Study, TurnsOneKnobAtATime) {
  const Study study = lay_out({"resolution.cells_through_chip=x0.5,x1,x1.3", "cut.speed=5,10,20m/s", "preset=draft"},
                              {"resolution.cells_through_chip=x2", "cut.speed=1m/s"});
  EXPECT_THAT(labels(study),
              ElementsAre("reference", "the scene as it is", "cells_through_chip = 2", "cells_through_chip = 5",
                          "speed = 5 m/s", "speed = 20 m/s", "preset = draft"));
  const auto read = [&](std::size_t run) { return forward::read_scene(study.runs[run].scene); };
  EXPECT_EQ(read(0).resolution.cells_through_chip, 8);
  EXPECT_EQ(read(0).cut.speed, 1000);
  EXPECT_EQ(study.runs[1].scene.canonical(), scene().canonical());
  EXPECT_EQ(read(2).cut.speed, 10000);
  EXPECT_EQ(read(3).resolution.cells_through_chip, 5);  // 4 x 1.3, rounded
  EXPECT_EQ(read(4).resolution.cells_through_chip, 4);
  EXPECT_EQ(*study.runs[4].number, 5);
  EXPECT_THAT(study.resolutions(), ElementsAre(1u, 2u, 3u));
}

TEST(Study, OneFactorTurnsSeveralKeysEachFromItsOwnValue) {
  const Study study = lay_out({"window.ahead+window.behind=x2", "pic_damping.rate=0,0.1"});
  EXPECT_EQ(study.knobs[0].short_name, "window");
  EXPECT_EQ(study.runs[2].label, "window x 2");
  const forward::Scene wide = forward::read_scene(study.runs[2].scene), own = forward::read_scene(scene());
  EXPECT_EQ(wide.window.ahead, 2 * own.window.ahead);
  EXPECT_EQ(wide.window.behind, 2 * own.window.behind);
  EXPECT_EQ(wide.window.below, own.window.below);
  EXPECT_EQ(forward::read_scene(study.runs[4].scene).pic_damping->rate, 0.1);  // a table that the scene lacks
}

TEST(Study, ByDefaultLooksAtEveryKnobThatTheSceneHas) {
  std::set<std::string> names;
  for (const inverse::StudyKnob& knob : lay_out({}).knobs) names.insert(knob.short_name);
  EXPECT_EQ(names.count("rate"), 0u);  // this scene is not damped
  for (const char* name : {"cells_through_chip", "speed", "courant_number", "window", "preset"})
    EXPECT_EQ(names.count(name), 1u) << name;
  for (const auto& file : fs::directory_iterator(KERF_SOURCE_DIR "/data/scenes")) {
    const Document shipped = Document::load(file.path());
    if (shipped.has("grips") || shipped.has("body")) continue;
    const Study study = lay_out({}, {}, shipped);
    EXPECT_EQ(study.knobs.size(), inverse::default_knobs(shipped).size()) << file.path();
    std::set<std::string> scenes;
    for (std::size_t run = Study::as_it_is; run < study.runs.size(); ++run)
      if (!study.runs[run].label.starts_with("preset")) scenes.insert(study.runs[run].scene.canonical());
    EXPECT_EQ(scenes.size() + 1 + forward::preset_count, study.runs.size()) << "a run twice in " << file.path();
  }
}

TEST(Study, NamesEveryMistake) {
  struct Case {
    std::vector<std::string> knobs, reference;
    const char* fragment;
    ExitCode code;
  };
  for (const Case& c : {Case{{"cut.sped=x2"}, {}, "did you mean \"cut.speed\"?", ExitCode::usage},
                        Case{{"cut.speed"}, {}, "is not PATH=VALUES", ExitCode::usage},
                        Case{{"cut.speed=x2,10m/s"}, {}, "mixes factors and values", ExitCode::usage},
                        Case{{"cut.speed=xfast"}, {}, "write for example x0.5", ExitCode::usage},
                        Case{{"cut.speed=x2mm"}, {}, "a pure number", ExitCode::usage},
                        Case{{"cut.speed=x-2"}, {}, "is negative", ExitCode::usage},
                        Case{{"material.law=x2"}, {}, "numeric parameter", ExitCode::usage},
                        Case{{"pic_damping.rate=x2"}, {}, "the scene has no pic_damping.rate", ExitCode::usage},
                        Case{{"cut.speed=x2", "cut.speed=1m/s"}, {}, "studied twice", ExitCode::usage},
                        Case{{"cut.speed=x2"}, {"cut.speed=1,2m/s"}, "one value belongs here", ExitCode::usage},
                        Case{{"cut.speed=x2"}, {"cut.speed=x2", "cut.speed=x3"}, "set twice", ExitCode::usage},
                        Case{{"preset=fine"}, {}, "there is no preset \"fine\"", ExitCode::usage},
                        Case{{"resolution.cells_through_chip=4.5"}, {}, "whole number", ExitCode::bad_data},
                        Case{{"resolution.cells_through_chip=x0.1"}, {}, "below 2", ExitCode::bad_data}}) {
    try {
      lay_out(c.knobs, c.reference);
      ADD_FAILURE() << c.knobs.front() << " was read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.fragment));
      EXPECT_EQ(error.code(), c.code) << error.what();
    }
  }
}

/// Second order in the cell size, dearer with the third power of the cells; the fastest cut is refused.
forward::CutResult made_up(const forward::Scene& scene) {
  forward::CutResult result;
  const double cells = scene.resolution.cells_through_chip;
  result.F_c = {limit + amplitude * std::pow(4 / cells, 2) + 1e-5 * scene.cut.speed, 1e-4};
  result.F_t = {-result.F_c.value / 2, 1e-4};
  result.cost.processor_seconds = std::pow(cells, 3) / scene.cut.speed;
  result.cost.particle_steps = static_cast<std::int64_t>(1e6 * std::pow(cells, 3));
  result.accepted = scene.cut.speed < 30000;
  if (!result.accepted) result.refusals = {"too fast"};
  return result;
}

inverse::StudyFindings findings_of(const Study& study, const inverse::Simulator& simulate) {
  const TemporaryFolder folder;
  inverse::Journal journal(folder / "journal.jsonl");
  inverse::RunDatabase database(journal, "test", simulate, 2);
  database.run(inverse::requests_of(study));
  std::vector<std::optional<inverse::RunRecord>> records;
  for (const inverse::StudyRun& run : study.runs) records.push_back(database.find(run.scene));
  return inverse::study_findings(study, std::move(records));
}

TEST(Study, ComparesEveryAcceptedRunWithTheReferenceAndFindsTheOrder) {
  const Study study = lay_out({"resolution.cells_through_chip=6,8,12", "cut.speed=5,40m/s"},
                              {"resolution.cells_through_chip=32", "cut.speed=1m/s"});
  const inverse::StudyFindings findings = findings_of(study, made_up);
  EXPECT_FALSE(findings.precision[Study::reference]);
  EXPECT_FALSE(findings.precision[6]);  // refused
  const double exact = limit + amplitude / 64 + 0.01;
  EXPECT_NEAR(findings.precision[Study::as_it_is]->F_c.value, (limit + amplitude + 0.1 - exact) / exact, 1e-12);
  EXPECT_NEAR(findings.precision[Study::as_it_is]->F_c.standard_error, 1e-4 * std::sqrt(2) / exact, 1e-12);
  EXPECT_NEAR(findings.F_c.order.value, 2, 1e-3);
  EXPECT_NEAR(findings.F_c.limit.value, limit + 0.1, 1e-3);
  EXPECT_EQ(findings.F_c.not_resolved, "");

  const auto columns = inverse::study_columns(study, findings);
  const std::string csv = inverse::csv(columns);
  EXPECT_THAT(csv, ::testing::StartsWith("run,knob,value,unit,verdict,F_c[N/m],"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 8);
  EXPECT_THAT(csv, HasSubstr("speed,40,m/s,refused,"));
  EXPECT_THAT(csv, HasSubstr("too fast"));
  const ordered_json json = inverse::study_json(study, findings, 1, {{"version", "x"}});
  EXPECT_TRUE(json.at("complete").get<bool>());
  EXPECT_EQ(json.at("cost").at("refused"), 1);
  EXPECT_TRUE(json.at("runs").at(6).at("error").is_null());
  EXPECT_NEAR(json.at("convergence").at("F_c").at("limit").at("value").get<double>(), 1e3 * (limit + 0.1), 1);

  // Without a reference nothing can be compared, and that is no crash.
  const auto refused = [](const forward::Scene& scene) {
    forward::CutResult result = made_up(scene);
    result.accepted = scene.resolution.cells_through_chip != 32;
    return result;
  };
  for (const auto& precision : findings_of(study, refused).precision) EXPECT_FALSE(precision);
}

TEST(Study, ALuckyErrorIsNoPrecision) {
  inverse::WorkPrecision precision;
  precision.F_c = {1e-6, 0.02};
  precision.F_t = {-0.01, 0.005};
  EXPECT_EQ(precision.error().value, 0.02);
  EXPECT_FALSE(precision.resolved());
  precision.F_t = {-0.05, 0.005};
  EXPECT_EQ(precision.error().value, 0.05);
  EXPECT_TRUE(precision.resolved());
}

/// The command as a user calls it, on cuts so coarse that each takes a moment.
class StudyCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string text = content_of(fs::path(KERF_SOURCE_DIR) / "data/scenes/verification_45.toml");
    text = testing::replaced(text, "cells_through_chip = 8", "cells_through_chip = 3");
    text = testing::replaced(text, "speed = \"10 m/s\"", "speed = \"20 m/s\"");
    write_atomically(scene_, text);
  }
  ProcessOutput kerf(const std::string& arguments, const std::string& environment = "") {
    return run_kerf(arguments, folder_.path(), environment);
  }

  TemporaryFolder folder_;
  fs::path scene_ = folder_ / "scene.toml", out_ = folder_ / "study";
};

TEST_F(StudyCommand, RunsReportsAndResumesWithoutRepeatingARun) {
  const std::string study = "study " + scene_.string() +
                            " resolution.cells_through_chip=4,5 resolution.particles_per_cell_side=1 "
                            "--reference resolution.cells_through_chip=x2 -o " +
                            out_.string();
  const ProcessOutput first = kerf(study + " --json");
  ASSERT_TRUE(first.exit_code == 0 || first.exit_code == 4) << first.err;
  const auto json = ordered_json::parse(first.out);
  EXPECT_TRUE(json.at("complete").get<bool>());
  EXPECT_EQ(json.at("runs").size(), 5u);
  EXPECT_GT(json.at("runs").at(0).at("result").at("cost").at("processor_s"), 0.0);
  EXPECT_EQ(json.at("runs").at(0).at("verdict"), "accepted");
  EXPECT_FALSE(json.at("runs").at(1).at("error").is_null());
  for (const char* file : {"study.csv", "study.json", "study.svg", "report.html"})
    EXPECT_TRUE(fs::exists(out_ / file)) << file;
  EXPECT_FALSE(fs::exists(out_ / "cuts"));
  EXPECT_THAT(content_of(out_ / "report.html"), HasSubstr("Convergence in the cell size"));

  const std::string table = content_of(out_ / "study.csv");
  const ProcessOutput again = kerf("resume " + out_.string(), "KERF_PYTHON=/nonexistent");
  EXPECT_EQ(again.exit_code, first.exit_code);
  EXPECT_THAT(again.err, HasSubstr("0 of 5 runs to simulate"));
  EXPECT_EQ(content_of(out_ / "study.csv"), table);
  EXPECT_THAT(again.out, HasSubstr("convergence in the cell size"));

  const ProcessOutput other = kerf("study " + scene_.string() + " cut.speed=x2 -o " + out_.string());
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("holds another study"));
  EXPECT_THAT(kerf("sweep " + scene_.string() + " cut.speed=1m/s -o " + out_.string()).err,
              HasSubstr("holds another study"));
}

/// Cuts so short that all are refused: every calibration gives up, and the study tells that and what it cost.
TEST_F(StudyCommand, OfAJobRunsItAtEveryPresetInAFolderOfItsOwn) {
  std::string scene = testing::replaced(testing::scene_text, "travel = 6", "travel = 0.6");
  scene = testing::replaced(scene, "speed = \"10 m/s\"", "speed = \"40 m/s\"");
  testing::write_job(folder_, testing::job_text, testing::curve_text({}, {0.2, 0.4}), scene);
  const ProcessOutput study = kerf("study " + (folder_ / "job.toml").string() + " -o " + out_.string() + " --json");
  EXPECT_EQ(study.exit_code, 5) << study.err;
  const auto json = ordered_json::parse(study.out);
  ASSERT_EQ(json.at("presets").size(), forward::preset_count);
  for (std::size_t k = 0; k < forward::preset_count; ++k) {
    const auto& preset = json.at("presets").at(k);
    EXPECT_EQ(preset.at("preset"), forward::preset_names[k]);
    EXPECT_GT(preset.at("core_s"), 0.0);
    EXPECT_THAT(preset.at("reason").get<std::string>(), HasSubstr("fail"));
    EXPECT_TRUE(fs::exists(out_ / forward::preset_names[k] / "result.json"));
  }
  EXPECT_THAT(content_of(out_ / "report.html"), HasSubstr("One calibration at every preset"));

  const std::string table = content_of(out_ / "study.csv");
  EXPECT_EQ(kerf("resume " + out_.string(), "KERF_PYTHON=/nonexistent").exit_code, 5);
  EXPECT_EQ(content_of(out_ / "study.csv"), table);
  EXPECT_EQ(kerf("study " + (folder_ / "job.toml").string() + " cut.speed=x2 -o " + out_.string()).exit_code, 2);
}

TEST_F(StudyCommand, ADryRunTellsTheCostAndMistakesLeaveNothing) {
  const ProcessOutput dry = kerf("study " + scene_.string() + " --dry-run -o " + out_.string());
  EXPECT_EQ(dry.exit_code, 0) << dry.err;
  EXPECT_THAT(dry.out, HasSubstr("particle-steps"));
  EXPECT_THAT(dry.out, HasSubstr("preset = draft"));
  EXPECT_EQ(kerf("study " + scene_.string() + " cut.speed=x2").exit_code, 2);  // where to?
  EXPECT_EQ(kerf("study " + scene_.string() + " cut.sped=x2 -o " + out_.string()).exit_code, 2);
  EXPECT_EQ(kerf("study " + scene_.string() + " --reference cut.speed=1,2m/s -o " + out_.string()).exit_code, 2);
  EXPECT_EQ(kerf("study " KERF_SOURCE_DIR "/data/scenes/dcb_rcurve.toml -o " + out_.string()).exit_code, 2);
  EXPECT_FALSE(fs::exists(out_));
}

}  // namespace
}  // namespace kerf
