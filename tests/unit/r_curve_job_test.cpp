// R-curves in a calibration: one pull of a specimen answers for all points of the curve, alone or beside planing cuts.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/calibration_json.hpp"
#include "inverse/folder.hpp"
#include "models/laws/trilinear.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using testing::replaced;
using testing::TemporaryFolder;
using testing::Truth;

constexpr double zone = 12, longest = 20;               // mm: when bridging is developed, how far the specimen cracks
constexpr double initiation = 0.215, bridging = 0.405;  // N/mm

double resistance_at(double extension, double G_init, double G_b) {
  return G_init + G_b * std::min(1.0, extension / zone);
}

/// Specimens show a ramp, planing cuts a force that goes with G_init alone.
forward::CutResult wooden(const forward::Scene& scene) {
  const auto* law = dynamic_cast<const laws::Trilinear*>(scene.cohesive.mode_I.get());
  const laws::Trilinear::Shape& s = law->shape();  // see bridged_arms.hpp
  const double G_b = s.bridging_stress * s.critical_opening / 2;
  const double G_init = s.knee_opening * (s.strength - s.peak_opening / s.knee_opening * s.bridging_stress) / 2;
  forward::CutResult result;
  result.accepted = result.steady = true;
  if (scene.grips) {
    result.is_specimen = true;
    for (double crack = 0; crack <= longest; crack += 0.5) {
      forward::ForceSample sample{};
      sample.extension = {.opening = crack, .crack = crack, .release = resistance_at(crack, G_init, G_b)};
      result.history.push_back(sample);
    }
    return result;
  }
  result.F_c.value = G_init + 10 * scene.cut.depth;
  result.F_t.value = -result.F_c.value;
  result.chip_ratio.value = 1;
  return result;
}

const std::string law = R"([cohesive.mode_I]
law = "trilinear"
strength = "4 MPa"
peak = 0.1
bridging_stress = "0.8 MPa"
initiation_toughness = "300 J/m^2"
bridging_toughness = "300 J/m^2"
)";
const std::string old_law = R"([cohesive.mode_I]
law = "cubic"
strength = "40 MPa"
toughness = "1000 J/m^2"
)";
const std::string specimen =
    replaced(replaced(replaced(testing::scene_text, old_law, law), "[tool]\nrake = \"30 deg\"\n", ""),
             "[friction]\ncoefficient = 0.2\n", "[grips]\narms = \"both\"\n");
const std::string plane = replaced(testing::scene_text, old_law, law);

const std::string free_toughnesses = R"([[free]]
path = "cohesive.mode_I.initiation_toughness"
lower = "50 J/m^2"
upper = "900 J/m^2"
start = "400 J/m^2"
[[free]]
path = "cohesive.mode_I.bridging_toughness"
lower = "50 J/m^2"
upper = "2000 J/m^2"
start = "200 J/m^2"
)";
const std::string r_curve = "[[curve]]\nfile = \"r_curve.csv\"\nscene = \"specimen.toml\"\n";
const std::string head = "title = \"wood\"\nscene = \"scene.toml\"\nobservables = [\"F_c\"]\n";
const std::string alone = replaced(head, "\"F_c\"", "\"G_R\"");

std::string measured_r_curve(double error = 0.01) {
  std::string text = "crack_extension[mm],G[J/m^2],G_sd[J/m^2]\n";
  for (const double extension : {0.75, 2.0, 4.0, 7.0, 10.0, 14.0, 18.0}) {
    const double G = 1e3 * resistance_at(extension, initiation, bridging);
    text += fmt::format("{},{:.12g},{:.12g}\n", extension, G, error * G);
  }
  return text;
}

inverse::Job job_of(const TemporaryFolder& folder, const std::string& text,
                    const std::string& curve = measured_r_curve(), const std::string& pulled = specimen) {
  write_atomically(folder / "specimen.toml", pulled);
  write_atomically(folder / "r_curve.csv", curve);
  const std::string cuts =
      "#: rake = 45 deg\ndepth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm]\n0.1,1.215,0.02,-1\n0.2,2.215,0.02,-2\n"
      "0.4,4.215,0.02,-4\n";
  return testing::write_job(folder, text, cuts, plane);
}

TEST(RCurveJob, OnePullAnswersForTheWholeCurve) {
  const TemporaryFolder folder;
  const inverse::Job job =
      job_of(folder, alone + r_curve + free_toughnesses + "[optimiser]\nnoise = 1e-6\nstep = 0.02\n");
  ASSERT_EQ(job.cuts.size(), 7U);
  EXPECT_EQ(job.observables.back(), inverse::Observable::resistance);
  const auto outcome = testing::calibrate(job, folder / "journal.jsonl", wooden);
  EXPECT_NEAR(testing::value(outcome.calibration, "initiation_toughness"), initiation, 1e-3 * initiation);
  EXPECT_NEAR(testing::value(outcome.calibration, "bridging_toughness"), bridging, 1e-3 * bridging);
  EXPECT_LT(outcome.runs, 20U) << "a run per point of the search, not per point of the curve";
  EXPECT_EQ(outcome.calibration.exit_code, ExitCode::success) << outcome.calibration.statement;
}

TEST(RCurveJob, TellsWhatPlaningAloneDoesNot) {
  const TemporaryFolder folder;
  const std::string planing = "[[curve]]\nfile = \"curve.csv\"\n";
  const std::string end = free_toughnesses + "[optimiser]\nnoise = 1e-6\nstep = 0.02\n";
  const auto planed = testing::calibrate(job_of(folder, head + planing + end), folder / "one", wooden);
  const auto both = testing::calibrate(job_of(folder, head + planing + r_curve + end), folder / "two", wooden);
  EXPECT_EQ(planed.calibration.fit.identifiability.find("bridging_toughness")->verdict,
            inverse::Verdict::not_measurable);
  const auto& known = *both.calibration.fit.identifiability.find("bridging_toughness");
  EXPECT_EQ(known.verdict, inverse::Verdict::measured);
  EXPECT_NEAR(known.value, bridging, 2e-3 * bridging);
}

TEST(RCurveJob, LeavesOutExtensionsThatTheSpecimenDoesNotReach) {
  const TemporaryFolder folder;
  const inverse::Job job =
      job_of(folder, alone + r_curve + free_toughnesses + "[optimiser]\nnoise = 1e-6\nstep = 0.02\n",
             measured_r_curve() + "25,620,6\n");
  const auto outcome = testing::calibrate(job, folder / "journal.jsonl", wooden);
  EXPECT_EQ(inverse::count(outcome.calibration.fit.at.usable), 7U);
  EXPECT_NEAR(testing::value(outcome.calibration, "bridging_toughness"), bridging, 1e-3 * bridging);
}

TEST(RCurveJob, APresetHoldsForTheSpecimenToo) {
  const TemporaryFolder folder;
  const auto cells = [](const inverse::Job& job) {
    return forward::read_scene(job.curves.back().specimen.value()).resolution.cells_through_chip;
  };
  const std::string changes = "changes = [\"resolution.cells_through_chip=7\"]\n";
  const inverse::Job as_told = job_of(folder, alone + r_curve + free_toughnesses);
  ASSERT_EQ(cells(as_told), 4);
  EXPECT_EQ(cells(job_of(folder, "preset = \"standard\"\n" + alone + r_curve + free_toughnesses)), 8);
  EXPECT_EQ(cells(job_of(folder, "preset = \"standard\"\n" + alone + r_curve + changes + free_toughnesses)), 7);
  inverse::JobOverride standard;
  standard.preset = "standard";
  const auto kept = inverse::Folder::create(folder / "out", folder / "job.toml", standard, "code");
  EXPECT_EQ(cells(kept.job()), 8) << "a preset from outside is written over what the job says";
}

TEST(RCurveJob, CoarseRunsAndOtherNumericsLeaveTheSpecimenAlone) {
  const TemporaryFolder folder;
  const inverse::Job job =
      job_of(folder, head + "[[curve]]\nfile = \"curve.csv\"\n" + r_curve + free_toughnesses +
                         "[[numerics]]\nname = \"mesh\"\nchanges = [\"resolution.cells_through_chip=8\"]\n");
  inverse::Job finer = job;
  finer.scene = job.numerics.front().scene;
  const inverse::ParameterSpace one(job), two(finer);
  const Eigen::VectorXd middle = 0.5 * (one.lower() + one.upper());
  EXPECT_EQ(one.scene(middle, job.cuts.back()).canonical(), two.scene(middle, job.cuts.back()).canonical());
  EXPECT_NE(one.scene(middle, job.cuts.front()).canonical(), two.scene(middle, job.cuts.front()).canonical());
}

TEST(RCurveJob, SaysWhatIsWrong) {
  const auto refuses = [](const std::string& why, const std::string& text,
                          const std::string& curve = measured_r_curve(), const std::string& pulled = specimen) {
    const TemporaryFolder folder;
    EXPECT_THAT([&] { job_of(folder, text, curve, pulled); },
                ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(why)));
  };
  refuses("no [grips]", alone + r_curve + free_toughnesses, measured_r_curve(), plane);
  refuses("[[curve]] deepest chooses among cuts", alone + r_curve + "deepest = \"1 mm\"\n" + free_toughnesses);
  refuses("r_curve.csv:2:", alone + r_curve + free_toughnesses, "crack_extension[mm],G[J/m^2]\nfar,3\n1,2\n2,3\n");
  const TemporaryFolder folder;
  const inverse::Job unweighed =
      job_of(folder, alone + r_curve + free_toughnesses, "crack_extension[mm],G[J/m^2]\n1,200\n2,210\n3,220\n");
  EXPECT_THAT([&] { testing::calibrate(unweighed, folder / "journal", wooden); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("G_R has no standard error")));
}

}  // namespace
}  // namespace kerf
