// Errors carried through the estimator: from their sources to the parameters, and from these to the fitted curve.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "inverse/calibration_json.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using inverse::ErrorSource;
using testing::calibrate;
using testing::job_text;
using testing::replaced;
using testing::TemporaryFolder;
using testing::write_job;

/// A simulation with standard errors of its own, of one per cent of F_c.
forward::CutResult rough(const forward::Scene& scene) {
  forward::CutResult result = testing::synthetic_cut(scene);
  result.F_c.standard_error = result.F_t.standard_error = 0.01 * result.F_c.value;
  result.chip_ratio.standard_error = 0.01 * result.chip_ratio.value;
  return result;
}

const std::string with_specimen =
    replaced(job_text, "file = \"curve.csv\"", "file = \"curve.csv\"\nspecimen_error = 0.03");
const std::string with_prior =
    replaced(with_specimen, "lower = 0.02\n", "lower = 0.02\nprior = 0.3\nprior_error = 0.02\n");
const std::string everything =
    with_prior + "[discrepancy]\nrelative = 0.02\n[edge_force]\nupper = \"100 N/mm\"\n" +
    "[[derived]]\nname = \"length\"\nexpression = \"material.elastic_modulus * cohesive.mode_I.toughness / "
    "material.yield_stress^2\"\nunit = \"mm\"\n";

inverse::Fit fit_of(const std::string& job, const inverse::Simulator& simulate, double scatter = 0.02) {
  const TemporaryFolder folder;
  const auto curve = testing::curve_text({}, {0.1, 0.2, 0.4, 0.8}, scatter);
  return calibrate(write_job(folder, job, curve), folder / "journal.jsonl", simulate).calibration.fit;
}

double share(const inverse::Fit& fit, std::size_t estimate, ErrorSource source) {
  return fit.error_budget.at(estimate).value().source[static_cast<std::size_t>(source)];
}

TEST(ErrorBudget, SharesAddUpToOne) {
  const inverse::Fit fit = fit_of(everything, rough);
  ASSERT_EQ(fit.error_budget.size(), 5U);  // three parameters, the edge force, a derived length
  for (const auto& shares : fit.error_budget) {
    ASSERT_TRUE(shares.has_value());
    EXPECT_NEAR(std::accumulate(shares->source.begin(), shares->source.end(), shares->unexplained), 1, 1e-6);
  }
  for (std::size_t s = 0; s < inverse::error_source_count; ++s) {
    double largest = 0;
    for (const auto& shares : fit.error_budget) largest = std::max(largest, shares->source[s]);
    EXPECT_GT(largest, 1e-3) << inverse::error_source_names[s] << " was put in";
  }
}

TEST(ErrorBudget, ASourceThatIsRemovedHasNoShare) {
  const auto none = [](const inverse::Fit& fit, ErrorSource source) {
    for (std::size_t i = 0; i < fit.error_budget.size(); ++i) EXPECT_EQ(share(fit, i, source), 0) << i;
  };
  none(fit_of(everything, testing::synthetic_cut), ErrorSource::simulation);
  none(fit_of(replaced(everything, "relative = 0.02", "relative = 0"), rough), ErrorSource::discrepancy);
  none(fit_of(replaced(everything, "\nspecimen_error = 0.03", ""), rough), ErrorSource::specimen);
  none(fit_of(replaced(everything, "prior = 0.3\nprior_error = 0.02\n", ""), rough), ErrorSource::prior);
}

TEST(ErrorBudget, EqualErrorsHaveEqualShares) {
  // Measured and stated errors of 2 % of F_c each, and of the chip ratio; F_t's measured error is another.
  const std::string job = replaced(job_text, R"("F_c", "F_t", "chip_ratio")", R"("F_c", "chip_ratio")") +
                          "[discrepancy]\nrelative = 0.02\n";
  const std::string fixed = replaced(job, "[[free]]\npath = \"friction.coefficient\"\nlower = 0.02\nupper = 1.5\n", "");
  const inverse::Fit fit = fit_of(fixed, testing::synthetic_cut);
  for (std::size_t i = 0; i < fit.error_budget.size(); ++i) {
    EXPECT_NEAR(share(fit, i, ErrorSource::measurement), share(fit, i, ErrorSource::discrepancy), 1e-9);
  }
}

TEST(ErrorBudget, AMisfitAboveTheStatedErrorsIsAShareOfItsOwn) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder, job_text, testing::curve_text({}, {0.1, 0.2, 0.4, 0.8}, 0.02, 7));
  const auto four_times = [](const forward::Scene& scene) {  // a chip that no shear plane makes
    forward::CutResult result = testing::synthetic_cut(scene);
    result.chip_ratio.value *= scene.cut.depth < 0.3 ? 1.2 : 0.8;
    return result;
  };
  const inverse::Fit fit = calibrate(job, folder / "journal.jsonl", four_times).calibration.fit;
  ASSERT_GT(fit.identifiability.error_scale, 1.5);
  for (const auto& shares : fit.error_budget)
    EXPECT_NEAR(shares.value().unexplained, 1 - std::pow(fit.identifiability.error_scale, -2), 1e-12);
}

TEST(FittedErrors, OfTheOnlyParameterFollowTheCurve) {
  // F_c is proportional to yield stress and toughness together: one common factor is free.
  const std::string tied = replaced(
      replaced(job_text,
               "[[free]]\npath = \"cohesive.mode_I.toughness\"\nlower = \"100 J/m^2\"\nupper = \"20 kJ/m^2\"\n", ""),
      "[[free]]\npath = \"friction.coefficient\"\nlower = 0.02\nupper = 1.5\n", "");
  const TemporaryFolder folder;
  inverse::Job job = write_job(
      folder,
      replaced(tied, "[[tie]]\npath = \"cohesive.mode_II.toughness\"\nequals = 1\nof = \"cohesive.mode_I.toughness\"\n",
               "[optimiser]\nstep = 0.002\nnoise = 1e-7\n"));
  // Begun where it ends, so that the slopes are those of short differences there.
  job.free[0].start = calibrate(job, folder / "first.jsonl").calibration.fit.identifiability.parameters[0].value;
  const inverse::Fit fit = calibrate(job, folder / "journal.jsonl").calibration.fit;
  const auto& yield = *fit.identifiability.find("yield_stress");
  const inverse::ParameterSpace space(job);
  for (std::size_t i = 0; i < job.cuts.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto force = [&](double factor) {
      const Eigen::VectorXd there = Eigen::VectorXd::Constant(1, space.coordinate(0, yield.value * factor));
      return testing::synthetic_cut(forward::read_scene(space.scene(there, job.cuts[i]))).F_c.value;
    };
    const double slope = (force(1.001) - force(0.999)) / (0.002 * yield.value);
    EXPECT_NEAR(fit.fitted_errors(row, 0) / (slope * yield.standard_error), 1, 0.01) << i;
    EXPECT_NEAR(fit.residual_errors(row, 0), job.cuts[i].measured[0]->standard_error, 1e-9);
  }
}

}  // namespace
}  // namespace kerf
