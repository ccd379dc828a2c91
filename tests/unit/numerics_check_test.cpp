// What estimates owe to the mesh: a simulation whose fine forces are known multiples of its coarse ones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/calibration_json.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using testing::calibrate;
using testing::job_text;
using testing::replaced;
using testing::TemporaryFolder;
using testing::write_job;

const std::string finer = R"([[numerics]]
name = "mesh"
changes = ["resolution.cells_through_chip=8"]
)";
// The toughness over the yield stress has the dimension of a length and is none of the mesh's business.
const std::string length = R"([[derived]]
name = "length"
expression = "cohesive.mode_I.toughness / material.yield_stress"
unit = "mm"
)";

/// Eight cells find all forces a tenth higher; twice the speed lets every cut fail.
forward::CutResult meshed(const forward::Scene& scene) {
  forward::CutResult result = testing::synthetic_cut(scene);
  if (scene.resolution.cells_through_chip == 8) {
    result.F_c.value *= 1.1;
    result.F_t.value *= 1.1;
  }
  result.accepted = result.steady = scene.cut.speed < 15000;  // mm/s
  return result;
}

inverse::Calibration found(const std::string& extra) {
  const TemporaryFolder folder;
  return calibrate(write_job(folder, job_text + length + extra), folder / "journal.jsonl", meshed).calibration;
}

TEST(NumericsCheck, ShiftsTheEstimatesAsANewCalibrationWould) {
  const inverse::Calibration calibration = found(finer);
  ASSERT_EQ(calibration.numerics.size(), 1U);
  const inverse::NumericsShift& mesh = calibration.numerics.front();
  EXPECT_EQ(mesh.name, "mesh");
  EXPECT_EQ(mesh.cuts, 4U);
  EXPECT_EQ(mesh.runs, 4U);
  // Forces are homogeneous of first order in yield stress and toughness: the same data want both a tenth lower.
  ASSERT_EQ(mesh.shifts.size(), 4U);
  EXPECT_NEAR(mesh.shifts[0], 60 / 1.1 - 60, 0.05);
  EXPECT_NEAR(mesh.shifts[1], 2 / 1.1 - 2, 0.005);
  EXPECT_NEAR(mesh.shifts[2], 0, 1e-3);
  EXPECT_NEAR(mesh.shifts[3], 0, 2e-4);
  EXPECT_LT(mesh.chi2, 0.01);
  EXPECT_THAT(calibration.statement, ::testing::ContainsRegex("other numerics \"mesh\" estimates move: yield stress by "
                                                              "-5.4 MPa .*no interval holds this"));
}

TEST(NumericsCheck, LeavesTheEstimatesThemselvesAlone) {
  const inverse::Calibration with = found(finer), without = found("");
  EXPECT_EQ(with.fit.at.point, without.fit.at.point);
  EXPECT_TRUE(without.numerics.empty());
  EXPECT_THAT(without.statement, ::testing::Not(::testing::HasSubstr("numerics")));
}

TEST(NumericsCheck, SaysWhenNoCutSurvivesTheChange) {
  const inverse::Calibration calibration = found("[[numerics]]\nname = \"speed\"\nchanges = [\"cut.speed=20 m/s\"]\n");
  ASSERT_EQ(calibration.numerics.size(), 1U);
  EXPECT_EQ(calibration.numerics.front().cuts, 0U);
  EXPECT_TRUE(calibration.numerics.front().shifts.empty());
  EXPECT_THAT(calibration.statement, ::testing::HasSubstr("\"speed\" no cut could be compared"));
}

TEST(NumericsCheck, IsPaidForByTheBudget) {
  const inverse::Calibration calibration = found(finer + "[budget]\nmax_runs = 30\n[optimiser]\naudit = false\n");
  EXPECT_LE(calibration.trace.back().runs, 30U);
}

TEST(NumericsCheck, RefusesWhatTheSceneHasNot) {
  const TemporaryFolder folder;
  const std::string wrong = replaced(finer, "cells_through_chip", "cells_thru_chip");
  EXPECT_THAT([&] { write_job(folder, job_text + wrong); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("cells_through_chip")));
  EXPECT_THAT([&] { write_job(folder, job_text + finer + finer); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("is taken")));
}

}  // namespace
}  // namespace kerf
