#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/local_model.hpp"
#include "inverse/optimiser.hpp"
#include "inverse/statement.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using testing::calibrate;
using testing::curve_text;
using testing::job_text;
using testing::jump_at;
using testing::replaced;
using testing::synthetic_cut;
using testing::TemporaryFolder;
using testing::Truth;
using testing::two_branches;
using testing::value;
using testing::write_job;

const std::vector<double> depths{0.1, 0.2, 0.4, 0.8};

/// Far from the truth (60 MPa, 2 N/mm, 0.3), so that the search has something to do.
std::string with_starts(std::string job) {
  job = replaced(job, "lower = \"10 MPa\"", "start = \"120 MPa\"\nlower = \"10 MPa\"");
  job = replaced(job, "lower = \"100 J/m^2\"", "start = \"800 J/m^2\"\nlower = \"100 J/m^2\"");
  return replaced(job, "lower = 0.02", "start = 0.6\nlower = 0.02");
}

struct Method {
  const char* name;
  int max_runs;
  double tolerance;  ///< relative, of the recovered parameters
};

class EveryOptimiser : public ::testing::TestWithParam<Method> {};

TEST_P(EveryOptimiser, RecoversATwin) {
  const TemporaryFolder folder;
  const auto [name, max_runs, tolerance] = GetParam();
  const std::string extra = fmt::format("[optimiser]\nmethod = \"{}\"\n[budget]\nmax_runs = {}\n", name, max_runs);
  const auto outcome = calibrate(write_job(folder, with_starts(job_text) + extra), folder / "journal.jsonl");
  EXPECT_TRUE(outcome.calibration.fit.converged) << outcome.calibration.fit.reason;
  EXPECT_EQ(outcome.calibration.exit_code, ExitCode::success);
  EXPECT_NEAR(value(outcome.calibration, "yield_stress"), 60, 60 * tolerance);
  EXPECT_NEAR(value(outcome.calibration, "toughness"), 2, 2 * tolerance);
  EXPECT_NEAR(value(outcome.calibration, "friction"), 0.3, 0.3 * tolerance);
  EXPECT_LE(outcome.runs, static_cast<std::size_t>(max_runs));
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryOptimiser,
                         ::testing::Values(Method{"gauss_newton", 100, 0.01}, Method{"multi_fidelity", 200, 0.01},
                                           Method{"levenberg_marquardt", 400, 0.01}, Method{"bobyqa", 2000, 0.05},
                                           Method{"sbplx", 6000, 0.05}, Method{"crs2", 12000, 0.1},
                                           Method{"mlsl", 4000, 0.05}, Method{"surrogate", 400, 0.01}));

/// Counts runs by fidelity; coarse ones (three cells) are off by a tenth, more at high flow stress.
struct TwoFidelities {
  std::shared_ptr<std::atomic<int>> fine = std::make_shared<std::atomic<int>>(0),
                                    coarse = std::make_shared<std::atomic<int>>(0);
  forward::CutResult operator()(const forward::Scene& scene) const {
    forward::CutResult result = synthetic_cut(scene);
    if (scene.resolution.cells_through_chip >= 4) {
      ++*fine;
      return result;
    }
    ++*coarse;
    const double bias = 0.9 * std::pow(std::sqrt(3.0) * laws::shear_yield(scene.material) / 60, 0.1);
    result.F_c.value *= bias;
    result.F_t.value *= 0.95 * bias;
    result.chip_ratio.value *= 1.05;
    return result;
  }
};

TEST(MultiFidelity, SearchesOnCoarseRunsAndAnswersOnFineOnes) {
  const TemporaryFolder folder;
  const std::string job = with_starts(job_text) + "[budget]\nmax_runs = 400\n[optimiser]\naudit = false\n";
  const TwoFidelities one, two;
  const auto plain = calibrate(write_job(folder, job), folder / "one.jsonl", one);
  const auto mapped = calibrate(write_job(folder, job + "method = \"multi_fidelity\"\n"), folder / "two.jsonl", two);
  EXPECT_TRUE(mapped.calibration.fit.converged) << mapped.calibration.fit.reason;
  EXPECT_NEAR(value(mapped.calibration, "yield_stress"), 60, 0.6);
  EXPECT_NEAR(value(mapped.calibration, "toughness"), 2, 0.02);
  EXPECT_EQ(*one.coarse, 0);
  EXPECT_GT(*two.coarse, 12);
  EXPECT_LE(*two.fine, 4 * 8) << "start, two or three checks and one set of differences";
  EXPECT_LT(*two.fine, *one.fine);
  for (const inverse::RunRecord& run : mapped.calibration.fit.at.runs)
    EXPECT_TRUE(run.accepted) << "the answer rests on fine runs";
}

TEST(MultiFidelity, AClosedFormCostsNoCoarseRuns) {
  const TemporaryFolder folder;
  const TwoFidelities simulate;
  const std::string job = with_starts(job_text) +
                          "[budget]\nmax_runs = 400\n[optimiser]\naudit = false\nmethod = \"multi_fidelity\"\n"
                          "[coarse]\nmodel = \"closed_form\"\n";
  const auto outcome = calibrate(write_job(folder, job), folder / "j.jsonl", simulate);
  EXPECT_TRUE(outcome.calibration.fit.converged) << outcome.calibration.fit.reason;
  EXPECT_NEAR(value(outcome.calibration, "toughness"), 2, 0.02);
  EXPECT_EQ(*simulate.coarse, 0);
  // The synthetic cut is the closed form: start, its minimum, and the differences there.
  EXPECT_LE(*simulate.fine, 4 + 4 + 12 + 8);
}

TEST(MultiFidelity, ACoarseModelOnAnotherBranchIsNotMapped) {
  const TemporaryFolder folder;
  const auto simulate = [](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    if (scene.resolution.cells_through_chip < 4) {
      result.branch = forward::Branch::bending;
      result.F_c.value *= 0.5;
    }
    return result;
  };
  const std::string job =
      with_starts(job_text) + "[budget]\nmax_runs = 400\n[optimiser]\nmethod = \"multi_fidelity\"\n";
  const auto outcome = calibrate(write_job(folder, job), folder / "j.jsonl", simulate);
  EXPECT_TRUE(outcome.calibration.fit.converged) << outcome.calibration.fit.reason;
  EXPECT_NEAR(value(outcome.calibration, "toughness"), 2, 0.02);
}

TEST(MultiFidelity, RefusesAChangeThatIsNone) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& change) {
    try {
      write_job(folder, std::string(job_text) + "[coarse]\nchanges = [\"" + change + "\"]\n");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message("resolution.cells_through_ship=3"), ::testing::HasSubstr("cells_through_chip"));
  EXPECT_THAT(message("resolution.cells_through_chip"), ::testing::HasSubstr("PATH=VALUE"));
  EXPECT_THAT(message("cohesive.mode_I.law=cubik"), ::testing::HasSubstr("cubic"));
  EXPECT_THAT(message("resolution.cells_through_chip=1"), ::testing::HasSubstr("cells_through_chip"));
  EXPECT_EQ(message("resolution.cells_through_chip=3"), "");
}

TEST(Surrogate, LeavesAWrongBasin) {
  const TemporaryFolder folder;
  // A ripple of 30 % over the flow stress: the search that begins beside a dip stays in it.
  const auto rippled = [](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    const double x = std::log(std::sqrt(3.0) * laws::shear_yield(scene.material) / 60);
    const double ripple = std::exp(0.9 * std::pow(std::sin(2.2 * x), 2));
    result.F_c.value *= ripple;
    result.F_t.value *= ripple;
    return result;
  };
  const std::string far = replaced(with_starts(job_text), "start = \"120 MPa\"", "start = \"20 MPa\"");
  const auto chi2 = [&](const char* method) {
    const inverse::Job job =
        write_job(folder, far + fmt::format("[budget]\nmax_runs = 600\n[optimiser]\nmethod = \"{}\"\n", method));
    return calibrate(job, folder / fmt::format("{}.jsonl", method), rippled).calibration.fit.residuals.chi2;
  };
  EXPECT_LT(chi2("surrogate"), 0.1);
}

TEST(Optimiser, NamesAreUnique) {
  std::set<std::string> names;
  for (const inverse::Optimiser& optimiser : inverse::optimisers()) EXPECT_TRUE(names.insert(optimiser.name).second);
  EXPECT_THROW(inverse::find_optimiser("steepest"), std::invalid_argument);
}

TEST(Calibration, AFifthOfTheRunsFailingChangesTheCountOnly) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder, with_starts(job_text) + "[budget]\nmax_runs = 400\nfailing_share = 0.5\n",
                                     curve_text({}, {0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0}));
  const auto outcome = calibrate(job, folder / "journal.jsonl", testing::failing(0.2, synthetic_cut));
  EXPECT_TRUE(outcome.calibration.fit.converged) << outcome.calibration.fit.reason;
  EXPECT_NEAR(value(outcome.calibration, "yield_stress"), 60, 0.6);
  EXPECT_NEAR(value(outcome.calibration, "toughness"), 2, 0.04);
  EXPECT_NEAR(value(outcome.calibration, "friction"), 0.3, 0.003);
}

TEST(Calibration, NamesTheCutsThatItLeftOut) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder, with_starts(job_text) + "[budget]\nfailing_share = 0.5\n");
  const auto outcome = calibrate(job, folder / "journal.jsonl", [](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    if (scene.cut.depth < 0.7) return result;
    result.accepted = false;
    result.refusals = {"the grid is too coarse"};
    return result;
  });
  EXPECT_THAT(outcome.calibration.statement,
              ::testing::StartsWith("Of 4 cuts 1 is left out: depth 0.800 mm (the grid is too coarse). "));
  EXPECT_NEAR(value(outcome.calibration, "yield_stress"), 60, 0.6);
  const auto all = calibrate(write_job(folder, with_starts(job_text)), folder / "all.jsonl");
  EXPECT_THAT(all.calibration.statement, ::testing::Not(::testing::HasSubstr("left out")));
}

TEST(Calibration, SaysWhenTooManyRunsFail) {
  const TemporaryFolder folder;
  const auto outcome = calibrate(write_job(folder), folder / "journal.jsonl", testing::failing(1.1, synthetic_cut));
  EXPECT_EQ(outcome.calibration.exit_code, ExitCode::too_many_failed_runs);
  EXPECT_THAT(outcome.calibration.statement, ::testing::HasSubstr("made to fail"));
  EXPECT_LE(outcome.runs, 8u);
}

TEST(Calibration, StopsAtItsBudget) {
  const TemporaryFolder folder;
  const auto outcome =
      calibrate(write_job(folder, with_starts(job_text) + "[budget]\nmax_runs = 20\n"), folder / "journal.jsonl");
  EXPECT_EQ(outcome.calibration.exit_code, ExitCode::not_converged);
  EXPECT_LE(outcome.runs, 20u);
  EXPECT_THAT(outcome.calibration.statement, ::testing::HasSubstr("did not converge"));
}

TEST(Calibration, TheClosedFormIsAGoodStart) {
  const TemporaryFolder folder;
  const auto outcome =
      calibrate(write_job(folder, std::string(job_text) + "[optimiser]\naudit = false\n"), folder / "journal.jsonl");
  // The synthetic cut is the closed form, so the start is the answer and only one set of differences is paid.
  EXPECT_THAT(outcome.calibration.start_origin, ::testing::HasSubstr("yield_stress from the closed form"));
  EXPECT_EQ(outcome.runs, 4u + 12u);
  EXPECT_NEAR(value(outcome.calibration, "toughness"), 2, 0.02);
}

TEST(Calibration, FindsAnEdgeForceAtNoCostAndShowsBothAssumptions) {
  const TemporaryFolder folder;
  const std::string edge = "[edge_force]\ncutting_share = \"none\"\n";
  const auto outcome = calibrate(write_job(folder, with_starts(job_text) + edge, curve_text({.edge_force = 4}, depths)),
                                 folder / "journal.jsonl");
  const inverse::Calibration& found = outcome.calibration;
  EXPECT_NEAR(value(found, "edge_force"), 4, 0.05);
  EXPECT_NEAR(value(found, "toughness"), 2, 0.04);
  ASSERT_EQ(found.alternatives.size(), 1u);
  EXPECT_EQ(found.alternatives[0].share, inverse::CuttingShare::friction);
  // Friction of the edge takes its part of the cutting force from the toughness.
  EXPECT_LT(found.alternatives[0].identifiability.find("toughness")->value, value(found, "toughness"));
  EXPECT_THAT(found.statement, ::testing::HasSubstr("assumption, not a measurement"));
}

TEST(Calibration, SaysWhatCannotBeMeasured) {
  const TemporaryFolder folder;
  // One cutting force cannot tell flow stress from toughness, whatever its error.
  std::string job = replaced(job_text, R"("F_c", "F_t", "chip_ratio")", R"("F_c")");
  const inverse::Job read = write_job(folder, with_starts(job), curve_text({}, {0.4}, 0.01));
  const auto outcome = calibrate(read, folder / "journal.jsonl");
  EXPECT_EQ(outcome.calibration.exit_code, ExitCode::not_identifiable);
  const inverse::ParameterEstimate& yield = *outcome.calibration.fit.identifiability.find("yield_stress");
  EXPECT_TRUE(std::isinf(yield.standard_error));
  EXPECT_NE(yield.verdict, inverse::Verdict::measured);
  const auto& values = outcome.calibration.fit.identifiability.singular_values;
  EXPECT_LT(values[1], 1e-6 * values[0]);
}

TEST(Calibration, IntervalsCoverTheTruth) {
  const TemporaryFolder folder;
  const int trials = 80;
  int covered = 0;
  double normalised = 0;
  for (unsigned seed = 1; seed <= trials; ++seed) {
    const inverse::Job job = write_job(folder, job_text, curve_text({}, depths, 0.03, seed));
    const auto outcome = calibrate(job, folder / fmt::format("journal_{}.jsonl", seed));
    const inverse::ParameterEstimate& p = *outcome.calibration.fit.identifiability.find("toughness");
    covered += p.interval.lower <= 2 && 2 <= p.interval.upper;
    normalised += std::pow((p.value - 2) / p.standard_error, 2);
  }
  // 95 % of 80 is 76 +- 2; three standard deviations, and nothing above, because scaled errors only widen.
  EXPECT_GE(covered, 70);
  EXPECT_LT(normalised / trials, 1.5);
}

TEST(Verdict, FollowsErrorAndInterval) {
  using inverse::judge;
  using inverse::Verdict;
  const inverse::Interval bounds{1, 100};
  EXPECT_EQ(judge(10, 1, {8, 12}, bounds), Verdict::measured);
  EXPECT_EQ(judge(10, 6, {4, 30}, bounds), Verdict::bounded);
  EXPECT_EQ(judge(10, 2, {4, 40}, bounds), Verdict::bounded) << "a lopsided interval is wide too";
  EXPECT_EQ(judge(10, 1, {1, 12}, bounds), Verdict::bounded_above);
  EXPECT_EQ(judge(10, 1, {8, 100}, bounds), Verdict::bounded_below);
  EXPECT_EQ(judge(10, 90, {1, 100}, bounds), Verdict::not_measurable);
}

TEST(Calibration, SaysThatTheDataSitAtAJump) {
  const TemporaryFolder folder;
  const auto outcome = calibrate(write_job(folder), folder / "journal.jsonl", two_branches);
  EXPECT_THAT(outcome.calibration.statement, ::testing::HasSubstr("sit at the jump"));
  EXPECT_THAT(outcome.calibration.statement, ::testing::HasSubstr("0.800 mm at 30.0 deg (touching)"));
  const auto plain = calibrate(write_job(folder), folder / "plain.jsonl");
  EXPECT_THAT(plain.calibration.statement, ::testing::Not(::testing::HasSubstr("jump")));
}

TEST(Calibration, SaysThatAJumpLiesWithinTheIntervals) {
  // Steps of 1 % from 60 MPa do not get to the jump at 61.5; the end of the interval, 62.3, does.
  const TemporaryFolder folder;
  const std::string text =
      std::string(job_text) + "[optimiser]\nstep = 0.01\nnoise = 1e-7\n[uncertainty]\nverify = true\n";
  const auto said = [&](double jump) {
    const auto file = folder / fmt::format("{}.jsonl", jump);
    const auto found = calibrate(write_job(folder, text), file, jump_at(jump)).calibration;
    EXPECT_TRUE(found.fit.converged);
    EXPECT_NEAR(found.fit.identifiability.parameters[0].interval.upper, 62.3, 0.5);
    return found.statement;
  };
  EXPECT_THAT(said(61.5), ::testing::HasSubstr("sit at the jump"));
  EXPECT_THAT(said(70), ::testing::Not(::testing::HasSubstr("jump")));
}

}  // namespace
}  // namespace kerf
