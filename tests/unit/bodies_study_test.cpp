// Studies and sweeps of experiments on bodies: the order that was put in comes out, results are held against their
// closed form or the reference, and no run is lost.
#include "inverse/bodies_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/scene_kind.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using inverse::BodiesFindings;
using inverse::RunRecord;
using inverse::Study;
using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

Document bar() {
  return Document::load(KERF_SOURCE_DIR "/data/scenes/vibrating_bar.toml");
}

RunRecord found(double frequency, double error, double seconds) {
  RunRecord record;
  record.accepted = true;
  record.result = {{"results", {{"frequency", frequency}, {"frequency_error", error}}},
                   {"cost", {{"processor_s", seconds}, {"particle_steps", 1e6 * seconds}}}};
  return record;
}

TEST(ObservedOrder, IsThePowerThatWasPutIn) {
  std::vector<inverse::ObservedOrder::Point> points;
  for (const double cell : {0.5, 2.0, 1.0}) points.push_back({0, cell, 0.03 * std::pow(cell, 1.7)});
  points.push_back({1, 0.25, 0.0});
  const inverse::ObservedOrder order = inverse::observed_order(points);
  ASSERT_EQ(order.points.size(), 3U);
  EXPECT_EQ(order.points.front().cell, 2.0);
  for (const double p : order.between) EXPECT_NEAR(p, 1.7, 1e-12);
  EXPECT_NEAR(order.all.value(), 1.7, 1e-12);
  EXPECT_FALSE(inverse::observed_order({{0, 1.0, 0.1}}).all.has_value());
}

TEST(BodiesStudy, TurnsOneKnobAtATime) {
  const Study study = inverse::lay_out_study(
      bar(), {"box.cell=x2,x0.5", "numerics.transfer=PIC,APIC", "box.particles_per_cell_side=1,2"}, {}, "test");
  std::vector<std::string> labels;
  for (const inverse::StudyRun& run : study.runs) labels.push_back(run.label);
  EXPECT_THAT(labels, ElementsAre("reference", "the scene as it is", "cell = 0.625 mm", "cell = 0.15625 mm",
                                  "transfer = PIC", "transfer = APIC", "particles_per_cell_side = 1"));
  EXPECT_THAT(study.resolutions(), ElementsAre(1, 2, 3));
  EXPECT_THAT(study.runs[4].scene.canonical(), HasSubstr("transfer"));
  EXPECT_NEAR(inverse::SceneKind::of(bar()).cell(study.runs[0].scene), 0.15625, 1e-12);
  EXPECT_GT(inverse::lay_out_study(bar(), {}, {}, "test").runs.size(), 10U);
  EXPECT_THROW(inverse::lay_out_study(bar(), {"cut.depth=1mm"}, {}, "test"), InputError);
}

TEST(BodiesStudy, HoldsResultsAgainstTheClosedFormOrTheReference) {
  Study study = inverse::lay_out_study(bar(), {"box.cell=x2,x0.5"}, {"box.cell=x0.25"}, "test");
  const std::vector<std::optional<RunRecord>> records{found(100.0, 0.001, 8), found(101, 0.016, 1),
                                                      found(104, 0.064, 0.25), found(100.25, 0.004, 4)};
  BodiesFindings closed = inverse::bodies_findings(study, records);
  EXPECT_EQ(closed.result, "frequency_error");
  EXPECT_TRUE(closed.closed_form);
  EXPECT_NEAR(closed.precision[2]->error().value, 0.064, 1e-12);
  EXPECT_TRUE(closed.precision[0].has_value());
  EXPECT_NEAR(closed.order.all.value(), 2.0, 1e-12);
  study.result = "frequency";
  const BodiesFindings compared = inverse::bodies_findings(study, records);
  EXPECT_FALSE(compared.closed_form);
  EXPECT_FALSE(compared.precision[0].has_value());
  EXPECT_NEAR(compared.precision[3]->error().value, 0.0025, 1e-12);
  EXPECT_NEAR(compared.precision[2]->result->value, 0.04, 1e-12);
  EXPECT_TRUE(compared.precision[1]->front);
  study.result = "frequencies";
  EXPECT_THROW(inverse::bodies_findings(study, records), InputError);
}

class BodiesCommands : public ::testing::Test {
 protected:
  ProcessOutput kerf(const std::string& arguments) const {
    return run_kerf(arguments, folder_.path(), "KERF_PYTHON=true");
  }
  TemporaryFolder folder_;
};

TEST_F(BodiesCommands, AStudyFindsSecondOrderAndIsNotRepeated) {
  const std::string scene = KERF_SOURCE_DIR "/data/scenes/vibrating_bar.toml",
                    out = (folder_.path() / "study").string();
  const std::string command =
      "study " + scene + " box.cell=x2,x0.5 numerics.transfer=PIC --reference box.courant_number=x0.5 --json -o " + out;
  const ProcessOutput first = kerf(command);
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ordered_json result = ordered_json::parse(first.out);
  EXPECT_EQ(result.at("bodies").at("result"), "frequency_error");
  EXPECT_NEAR(result.at("convergence").at("order").get<double>(), 2.0, 0.15);
  EXPECT_GT(result.at("runs")[4].at("error").at("larger").at("value").get<double>(), 0.0);
  EXPECT_GT(result.at("runs")[4].at("result").at("cost").at("processor_s").get<double>(), 0.0);
  EXPECT_THAT(content_of(fs::path(out) / "study.csv"), HasSubstr("frequency_error"));
  const ProcessOutput again = kerf("resume " + out + " --json");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("0 of 5 runs to simulate"));
  EXPECT_EQ(ordered_json::parse(again.out).at("runs"), result.at("runs"));
  EXPECT_EQ(kerf("study " + scene + " --result frequencies box.cell=x2 -o " + out + "2").exit_code, 2);
}

TEST_F(BodiesCommands, ASweepTellsWhatEveryRunFound) {
  const std::string scene = KERF_SOURCE_DIR "/data/scenes/vibrating_bar.toml",
                    out = (folder_.path() / "sweep").string();
  const ProcessOutput run =
      kerf("sweep " + scene + " box.cell=0.625,0.3125mm numerics.transfer=FLIP,XPIC --json -o " + out);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ordered_json result = ordered_json::parse(run.out);
  EXPECT_TRUE(result.at("bodies").get<bool>());
  ASSERT_EQ(result.at("runs").size(), 4U);
  for (const ordered_json& one : result.at("runs"))
    EXPECT_LT(one.at("result").at("results").at("frequency_error").get<double>(), 0.01);
  const std::string table = content_of(fs::path(out) / "sweep.csv");
  EXPECT_THAT(table, HasSubstr("frequency_error"));
  EXPECT_THAT(table, ::testing::Not(HasSubstr("F_t_over_F_c")));
}

}  // namespace
}  // namespace kerf
