// Draws from the posterior against what is known without drawing: Gaussian problems, unseen parameters, scaled errors.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/calibration_json.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using testing::job_text;
using testing::replaced;
using testing::TemporaryFolder;

const std::string sampled = "[uncertainty]\nposterior_moves = 4000\n";

/// Seven cuts of one rake, all observables with a scatter of 1 %.
inverse::Fit fit_of(const std::string& job, unsigned seed) {
  const TemporaryFolder folder;
  const std::string curve = testing::curve_text({}, {0.1, 0.14, 0.2, 0.28, 0.4, 0.57, 0.8}, 0.01, seed);
  return testing::calibrate(testing::write_job(folder, job + sampled, curve), folder / "journal.jsonl").calibration.fit;
}

/// Ends of the posterior's interval from those of the profile's, in half widths of the latter.
double disagreement(const inverse::ParameterEstimate& p, const inverse::Interval& posterior) {
  const double half = 0.5 * (p.interval.upper - p.interval.lower);
  return std::max(std::abs(p.interval.lower - posterior.lower), std::abs(p.interval.upper - posterior.upper)) / half;
}

TEST(Posterior, AgreesWithTheProfilesWhereTheProblemIsLinear) {
  // Errors as stated, and errors that the misfit proves too small: a normal density and Student's.
  bool scaled[2] = {false, false};
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const inverse::Fit fit = fit_of(job_text, seed);
    scaled[fit.identifiability.error_scale > 1 ? 1 : 0] = true;
    ASSERT_TRUE(fit.posterior.has_value());
    ASSERT_GT(fit.posterior->independent(), 2000);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_LT(disagreement(fit.identifiability.parameters[j], fit.posterior->intervals[j]), 0.1) << seed << " " << j;
    const Eigen::MatrixXd logs = fit.posterior->draws.leftCols(3).array().log();
    const Eigen::MatrixXd centred = logs.rowwise() - logs.colwise().mean();
    const Eigen::MatrixXd covariance = centred.transpose() * centred / static_cast<double>(centred.rows() - 1);
    for (Eigen::Index a = 1; a < 3; ++a)
      for (Eigen::Index b = 0; b < a; ++b)
        EXPECT_NEAR(covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b)),
                    fit.identifiability.correlation(a, b), 0.06);
  }
  EXPECT_TRUE(scaled[0] && scaled[1]) << "both densities are to be tried";
}

TEST(Posterior, FillsTheRangeOfWhatIsNotSeen) {
  const inverse::Fit fit = fit_of(replaced(job_text, "[[tie]]", R"([[free]]
path = "cohesive.mode_I.strength"
lower = "5 MPa"
upper = "200 MPa"
[[tie]])"),
                                  1);
  const Eigen::ArrayXd logs = fit.posterior->draws.col(3).array().log();
  const double lower = std::log(5.0), range = std::log(200.0 / 5.0);
  // Uniform: these shares are known to 3 sqrt(0.19/independent draws), about 0.03.
  for (const double share : {0.25, 0.5, 0.75})
    EXPECT_NEAR((logs < lower + share * range).cast<double>().mean(), share, 0.03) << share;
}

TEST(Posterior, KnowsTheEdgeForceAndWhatFollows) {
  const inverse::Fit fit = fit_of(
      std::string(job_text) + "[edge_force]\nlower = \"-50 N/mm\"\nupper = \"50 N/mm\"\ncompare = false\n" +
          "[[derived]]\nname = \"length\"\nexpression = \"cohesive.mode_I.toughness / material.yield_stress\"\nunit = "
          "\"mm\"\n",
      1);
  ASSERT_EQ(fit.posterior->intervals.size(), 5U);
  EXPECT_LT(disagreement(*fit.identifiability.find("edge_force"), fit.posterior->intervals[3]), 0.12);
  EXPECT_LT(disagreement(*fit.identifiability.find("length"), fit.posterior->intervals[4]), 0.12);
}

TEST(Posterior, IsDrawnOnlyWhenAskedFor) {
  const TemporaryFolder folder;
  const auto outcome = testing::calibrate(testing::write_job(folder), folder / "journal.jsonl");
  EXPECT_FALSE(outcome.calibration.fit.posterior.has_value());
}

}  // namespace
}  // namespace kerf
