#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recovery/twin_scene.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

forward::CutResult simulate(const forward::Scene& scene) {
  return forward::run(scene);
}

/// Simulates the truth at two depths and gives it back as a measurement with an error of 1 %.
std::string measured_twin() {
  std::string curve = "#: rake = 30 deg\ndepth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm]\n";
  for (const std::string depth : {"0.5", "0.8"}) {
    const std::string truth =
        testing::replaced(testing::coarse_scene, "depth = \"0.5 mm\"", "depth = \"" + depth + " mm\"");
    const forward::CutResult cut = simulate(forward::read_scene(Document::parse(truth, "truth")));
    EXPECT_THAT(cut.refusals, ::testing::IsEmpty());
    curve += fmt::format("{},{},{},{},{}\n", depth, cut.F_c.value, 0.01 * cut.F_c.value, cut.F_t.value,
                         0.01 * cut.F_c.value);
  }
  return curve;
}

TEST(Twin, SimulationRecoversYieldStressAndFriction) {
  const testing::TemporaryFolder folder;
  const inverse::Job job = testing::write_job(folder, testing::coarse_job, measured_twin(), testing::coarse_scene);
  const auto outcome = testing::calibrate(job, folder / "journal.jsonl", simulate);
  EXPECT_EQ(outcome.calibration.exit_code, ExitCode::success) << outcome.calibration.statement;
  EXPECT_NEAR(testing::value(outcome.calibration, "yield_stress"), 25, 0.3);
  EXPECT_NEAR(testing::value(outcome.calibration, "friction"), 0.2, 0.006);
  EXPECT_LE(outcome.runs, 40u);
  RecordProperty("runs", static_cast<int>(outcome.runs));
}

}  // namespace
}  // namespace kerf
