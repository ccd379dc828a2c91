#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/parameter_space.hpp"
#include "models/base/units.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using ::testing::HasSubstr;
using testing::job_text;
using testing::replaced;
using testing::TemporaryFolder;
using testing::write_job;

TEST(Job, IsReadWithItsSceneAndCurve) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder);
  ASSERT_EQ(job.free.size(), 3u);
  EXPECT_EQ(job.free[0].name, "yield_stress");
  EXPECT_TRUE(job.free[0].key);
  EXPECT_EQ(job.free[1].name, "toughness");
  EXPECT_NEAR(job.free[1].lower, 0.1, 1e-15);  // N/mm
  EXPECT_NEAR(job.free[1].upper, 20, 1e-12);
  EXPECT_EQ(job.free[2].name, "friction");
  ASSERT_EQ(job.cuts.size(), 4u);
  EXPECT_NEAR(job.cuts[2].depth, 0.4, 1e-15);
  EXPECT_NEAR(job.cuts[2].rake, consistent_units_in("deg") * 30, 1e-15);
  EXPECT_TRUE(job.cuts[2].measured[2].has_value());
  EXPECT_FALSE(job.edge_force.has_value());
}

TEST(Job, ACurveMayDifferFromTheScene) {
  const TemporaryFolder folder;
  const std::string second = "[[curve]]\nfile = \"curve.csv\"\nchanges = [\"material.elastic_modulus=2000MPa\"]\n";
  const inverse::Job job = write_job(folder, replaced(job_text, "[[free]]", second + "[[free]]"));
  ASSERT_EQ(job.cuts.size(), 8u);
  const inverse::ParameterSpace space(job);
  const auto modulus = [&](std::size_t cut) {
    return space.scene(space.lower(), job.cuts[cut])
        .read(forward::scene_blocks())
        .at("material")
        .number("elastic_modulus");
  };
  EXPECT_EQ(modulus(3), 1000);
  EXPECT_EQ(modulus(4), 2000);
  const std::string wrong = replaced(second, "elastic_modulus", "elastic_modulos");
  EXPECT_THROW(write_job(folder, replaced(job_text, "[[free]]", wrong + "[[free]]")), InputError);
}

TEST(Job, PatchesTheSceneThroughItsOrdinaryReader) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder);
  const inverse::ParameterSpace space(job);
  Eigen::VectorXd point(3);
  point << space.coordinate(0, 55), space.coordinate(1, 3), space.coordinate(2, 0.5);
  const forward::Scene scene = forward::read_scene(space.scene(point, job.cuts[1]));
  EXPECT_NEAR(std::sqrt(3.0) * laws::shear_yield(scene.material), 55, 1e-12);
  EXPECT_NEAR(scene.cohesive.mode_I->toughness(), 3, 1e-12);
  EXPECT_NEAR(scene.cohesive.mode_II->toughness(), 3, 1e-12);  // tied
  EXPECT_NEAR(scene.friction->coefficient, 0.5, 1e-12);
  EXPECT_NEAR(scene.cut.depth, 0.2, 1e-15);
}

TEST(Job, UnobservedColumnsDoNotEnter) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder, replaced(job_text, R"("F_c", "F_t", "chip_ratio")", R"("F_t")"));
  EXPECT_FALSE(job.cuts[0].measured[0].has_value());
  EXPECT_TRUE(job.cuts[0].measured[1].has_value());
}

TEST(Job, TwoNamesThatCollideBecomePaths) {
  const TemporaryFolder folder;
  const std::string tie =
      "[[tie]]\npath = \"cohesive.mode_II.toughness\"\nequals = 1\nof = \"cohesive.mode_I.toughness\"\n";
  const std::string other =
      "[[free]]\npath = \"cohesive.mode_II.toughness\"\nlower = \"1 J/m^2\"\nupper = \"9 kJ/m^2\"\n";
  const inverse::Job job = write_job(folder, replaced(job_text, tie, other));
  EXPECT_EQ(job.free[1].name, "cohesive.mode_I.toughness");
  EXPECT_EQ(job.free[3].name, "cohesive.mode_II.toughness");
}

struct Mistake {
  const char* what;
  const char* with;
  const char* said;
};

class JobMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(JobMistake, IsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  const Mistake& mistake = GetParam();
  try {
    write_job(folder, replaced(job_text, mistake.what, mistake.with));
    FAIL() << "was read without complaint: " << mistake.with;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(mistake.said));
    EXPECT_THAT(error.what(), HasSubstr("job.toml"));
    EXPECT_EQ(error.code(), ExitCode::bad_data);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, JobMistake,
    ::testing::Values(
        Mistake{"material.yield_stress", "material.yield_strss", "did you mean \"material.yield_stress\""},
        Mistake{"material.yield_stress", "tool.rake", "comes from the measured curve"},
        Mistake{"material.yield_stress", "pic_damping.rate", "has no table [pic_damping]"},
        Mistake{"[[tie]]", "[[free]]\npath = \"friction.coefficient\"\nlower = \"0.1\"\nupper = \"1\"\n[[tie]]",
                "free twice"},
        Mistake{"lower = \"10 MPa\"", "lower = \"10\"", "needs a unit"},
        Mistake{"lower = \"10 MPa\"", "lower = 10", "needs a unit"},
        Mistake{"lower = \"10 MPa\"", "lower = \"10 mm\"", "mm"},
        Mistake{"lower = \"10 MPa\"", "lower = \"-10 MPa\"", "allowed"},
        Mistake{"lower = \"10 MPa\"", "lower = \"ten MPa\"", "lower = \"ten MPa\""},
        Mistake{"lower = \"10 MPa\"", "lower = \"400 MPa\"", "must be below upper"},
        Mistake{"lower = \"10 MPa\"", "lowr = \"10 MPa\"", "did you mean \"lower\""},
        Mistake{"lower = 0.02", "lower = 0", "must be positive on a logarithmic scale"},
        Mistake{"key = true", "start = \"1 GPa\"", "is outside"},
        Mistake{"key = true", "scale = \"cubic\"", "log, linear"},
        Mistake{"of = \"cohesive.mode_I.toughness\"", "of = \"material.yield_stress\"", "different dimensions"},
        Mistake{"path = \"cohesive.mode_II.toughness\"", "path = \"material.yield_stress\"", "already free"},
        Mistake{"equals = 1", "equals = 1e6", "at its lower bound the scene cannot be read"},
        Mistake{"\"F_t\"", "\"F_z\"", "F_z"}, Mistake{"title = \"a twin\"", "title = \"a twin\"\nbudget = 3", "budget"},
        Mistake{"[[tie]]", "[budget]\nmax_runs = 10.5\n[[tie]]", "whole number"},
        Mistake{"[[tie]]", "[optimiser]\nmethod = \"newton\"\n[[tie]]", "gauss_newton"},
        Mistake{"[[tie]]", "[edge_force]\nlower = \"5 N/mm\"\nupper = \"1 N/mm\"\n[[tie]]", "must be below upper"},
        Mistake{"file = \"curve.csv\"", "file = \"curve.csv\"\nshallowest = \"5 mm\"", "no point of"}));

TEST(Job, MissingFilesAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT([&] { write_job(folder, replaced(job_text, "scene.toml", "scen.toml")); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("scen.toml")));
  EXPECT_THAT([&] { write_job(folder, replaced(job_text, "curve.csv", "curv.csv")); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("curv.csv")));
}

TEST(Job, DataWithoutErrorsNeedADiscrepancy) {
  const TemporaryFolder folder;
  const char* bare = "#: rake = 30 deg\ndepth[mm],Fc[N/mm],Ft[N/mm]\n0.1,5,1\n0.2,8,2\n0.4,15,3\n";
  const std::string forces = replaced(job_text, R"(, "chip_ratio")", "");
  const inverse::Job without = write_job(folder, forces, bare);
  EXPECT_THROW(inverse::Misfit(without, inverse::ParameterSpace(without)), InputError);
  const inverse::Job with = write_job(folder, forces + "[discrepancy]\nrelative = 0.05\n", bare);
  const inverse::ParameterSpace space(with);
  EXPECT_NEAR(inverse::Misfit(with, space).weights()(1, 0), 1 / (0.05 * 8), 1e-12);
}

}  // namespace
}  // namespace kerf
