#include "inverse/noise_audit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/calibration_json.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using inverse::DifferenceTable;
using inverse::ecnoise;
using testing::job_text;
using testing::replaced;
using testing::synthetic_cut;
using testing::TemporaryFolder;
using testing::write_job;

TEST(EcNoise, FindsTheDeviationOfNoiseOnASmoothFunction) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const double noise = 1e-4;
  double logarithm = 0;
  const int trials = 200;
  int found = 0, far_off = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> values;
    for (int i = 0; i < 7; ++i) values.push_back(std::exp(0.7 * i * 2e-3) + noise * normal(random));
    const DifferenceTable table = ecnoise(values);
    if (table.outcome != DifferenceTable::Outcome::found) continue;
    ++found;
    logarithm += std::log(table.noise / noise);
    far_off += std::abs(std::log(table.noise / noise)) > std::log(6.0);
  }
  EXPECT_GT(found, 0.8 * trials);
  EXPECT_LE(far_off, 3) << "of 20000 trials 0.3 % are";
  EXPECT_NEAR(std::exp(logarithm / found), 1, 0.35) << "six differences leave an error of a third";
}

TEST(EcNoise, SaysWhenTheSpacingIsWrong) {
  EXPECT_EQ(ecnoise({1, 1, 1, 1, 1, 1, 1 + 1e-16}).outcome, DifferenceTable::Outcome::too_close);
  EXPECT_EQ(ecnoise({1, 1.1, 1.3, 1.6, 2, 2.5, 3.1}).outcome, DifferenceTable::Outcome::too_far);
}

/// Forces rough by `noise`, the same for the same scene, as a simulation's are.
inverse::Simulator rough(double noise) {
  return [noise](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    std::mt19937_64 random(std::hash<double>{}(result.F_c.value * (1 + 1e-3 * scene.cut.notch)));
    std::normal_distribution<double> normal;
    result.F_c.value *= 1 + noise * normal(random);
    result.F_t.value *= 1 + noise * normal(random);
    result.chip_ratio.value *= 1 + noise * normal(random);
    return result;
  };
}

TEST(NoiseAudit, MeasuresWhatTheSimulatorDoes) {
  const TemporaryFolder folder;
  double previous_step = 0;
  for (const double noise : {1e-5, 1e-3, 1e-2}) {
    const auto outcome = testing::calibrate(write_job(folder), folder / fmt::format("{}.jsonl", noise), rough(noise));
    ASSERT_TRUE(outcome.calibration.audit.has_value());
    const inverse::NoiseAudit& audit = *outcome.calibration.audit;
    EXPECT_GT(audit.noise, noise / 3);
    EXPECT_LT(audit.noise, noise * 4);
    EXPECT_GE(audit.step, previous_step);
    previous_step = audit.step;
    EXPECT_EQ(audit.observables.size(), 3u) << "one cut of four, by F_c, F_t and chip ratio";
    EXPECT_EQ(audit.runs, 10u);
  }
  EXPECT_GT(previous_step, 0.04) << "a roughness of 1 % wants a longer step than is usual";
}

TEST(NoiseAudit, LeavesAloneWhatTheJobGives) {
  const TemporaryFolder folder;
  const std::string given = std::string(job_text) + "[optimiser]\nstep = 0.07\nnoise = 0.002\n";
  const auto without = testing::calibrate(write_job(folder, given), folder / "a.jsonl", rough(1e-2));
  EXPECT_FALSE(without.calibration.audit.has_value());

  const inverse::Job job = write_job(folder, given + "audit = true\n");
  const auto with = testing::calibrate(job, folder / "b.jsonl", rough(1e-2));
  ASSERT_TRUE(with.calibration.audit.has_value());
  const auto json = inverse::calibration_json(job, with.calibration, {}).at("noise_audit");
  EXPECT_EQ(json.at("used_step"), 0.07);
  EXPECT_EQ(json.at("used_noise"), 0.002);
  EXPECT_NE(json.at("noise"), 0.002);
}

TEST(NoiseAudit, AskedForMoreThanItsShareOfTheBudgetIsLeftOut) {
  const TemporaryFolder folder;
  const auto outcome =
      testing::calibrate(write_job(folder, std::string(job_text) + "[budget]\nmax_runs = 39\n"), folder / "j.jsonl");
  EXPECT_FALSE(outcome.calibration.audit.has_value());
  EXPECT_TRUE(outcome.calibration.fit.converged);
}

}  // namespace
}  // namespace kerf
