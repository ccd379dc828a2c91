// Slopes from differences of a rough simulation: what they show without the roughness that they contain themselves.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <bit>

#include "inverse/seen_slopes.hpp"
#include "tests/unit/modelled_cut.hpp"

namespace kerf {
namespace {

using testing::job_text;
using testing::replaced;
using testing::TemporaryFolder;
using testing::write_job;

constexpr double roughness = 2e-3;
const std::vector<double> depths{0.1, 0.14, 0.2, 0.28, 0.4, 0.57, 0.8};

/// The synthetic cut, every observable off by a share that is normal and the same whenever the scene is.
inverse::Simulator rough(unsigned seed) {
  return [seed](const forward::Scene& scene) {
    forward::CutResult result = testing::synthetic_cut(scene);
    std::vector<unsigned> bits{seed};
    for (const double number : {result.F_c.value, result.F_t.value, scene.cut.depth, scene.cohesive.mode_I->strength()})
      for (const int shift : {0, 32})
        bits.push_back(static_cast<unsigned>(std::bit_cast<std::uint64_t>(number) >> shift));
    std::seed_seq sequence(bits.begin(), bits.end());
    std::mt19937_64 random(sequence);
    std::normal_distribution<double> normal(0, roughness);
    for (Estimate* value : {&result.F_c, &result.F_t, &result.chip_ratio}) value->value *= 1 + normal(random);
    return result;
  };
}

/// Yield stress, toughness and friction, and a strength that this cut does not see.
std::string with_strength(const std::string& optimiser) {
  return replaced(job_text, "[[tie]]", R"([[free]]
path = "cohesive.mode_I.strength"
lower = "5 MPa"
upper = "200 MPa"
[[tie]])") +
         fmt::format("[optimiser]\nnoise = {}\n{}", roughness, optimiser);
}

/// Information about the last parameter when the others are free.
double about_strength(const Eigen::Matrix4d& information) {
  const Eigen::Matrix3d others = information.topLeftCorner<3, 3>();
  const Eigen::Vector3d along = information.topRightCorner<3, 1>();
  return information(3, 3) - along.dot(others.ldlt().solve(along));
}

struct Differences : testing::ModelledCut {
  Differences(const inverse::Job& job, unsigned seed, const std::filesystem::path& file)
      : ModelledCut(job, file, rough(seed)), raw(about(truth())) {}

  Eigen::MatrixXd information(const inverse::LocalModel& model) const {
    const Eigen::MatrixXd jacobian = inverse::residual_slopes(model, misfit, truth(), 0);
    return jacobian.transpose() * jacobian;
  }

  inverse::LocalModel raw;
};

TEST(SeenSlopes, ShowNoInformationThatRoughnessFeigns) {
  const TemporaryFolder folder;
  for (const bool central : {false, true}) {
    const inverse::Job job = write_job(folder, with_strength(fmt::format("step = 0.05\ncentral = {}\n", central)),
                                       testing::curve_text({}, depths));
    Eigen::Matrix4d raw = Eigen::Matrix4d::Zero(), seen = raw;
    double raw_strength = 0, seen_strength = 0, unseen = 0;
    constexpr unsigned trials = 200;
    for (unsigned seed = 0; seed < trials; ++seed) {
      const Differences differences(job, seed, folder / fmt::format("{}{}", central, seed));
      const Eigen::Matrix4d all = differences.information(differences.raw);
      const Eigen::Matrix4d kept = differences.information(seen_slopes(differences.raw, differences.misfit));
      raw += all / trials;
      seen += kept / trials;
      raw_strength += about_strength(all) / trials;
      seen_strength += about_strength(kept) / trials;
      unseen += about_strength(kept) < 1e-6 * kept(3, 3) ? 1.0 / trials : 0;
    }
    // Roughness alone: 21 weighted slopes of variance 2 (t/h)^2, one-sided, or (t/h)^2 / 2; F_t weighs less, and three
    // are fitted away.
    const double alone = (central ? 0.5 : 2) * std::pow(roughness / 0.05 / 0.02, 2);
    EXPECT_GT(raw_strength, 11 * alone);
    EXPECT_LT(raw_strength, 18 * alone);
    EXPECT_LT(seen_strength, 0.08 * raw_strength);  // what passes as significant by chance
    EXPECT_GT(unseen, 0.98);
    for (Eigen::Index j = 0; j < 3; ++j) EXPECT_NEAR(seen(j, j) / (raw(j, j) - raw(3, 3)), 1, 0.03) << j;
  }
}

TEST(SeenSlopes, AreTheSlopesThemselvesWhereTheSimulationIsSmooth) {
  const TemporaryFolder folder;
  inverse::Job job = write_job(folder, with_strength("step = 0.03\n"), testing::curve_text({}, depths));
  job.optimiser.roughness = 0;
  const Differences differences(job, 1, folder / "journal");
  const inverse::LocalModel seen = seen_slopes(differences.raw, differences.misfit);
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_EQ(seen.slopes(k), differences.raw.slopes(k));
}

TEST(SeenSlopes, SayThatAParameterIsNotMeasurable) {
  const TemporaryFolder folder;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const inverse::Job job = write_job(folder, with_strength("step = 0.05\n"), testing::curve_text({}, depths));
    const auto outcome = testing::calibrate(job, folder / fmt::format("{}", seed), rough(seed));
    const inverse::Identifiability& known = outcome.calibration.fit.identifiability;
    EXPECT_EQ(known.find("strength")->verdict, inverse::Verdict::not_measurable) << outcome.calibration.statement;
    EXPECT_LT(known.find("yield_stress")->interval.lower, 60);
    EXPECT_GT(known.find("yield_stress")->interval.upper, 60);
  }
}

TEST(SeenSlopes, AreNotTakenFromStepsThatRoughnessHides) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder, with_strength("step = 0.05\n"), testing::curve_text({}, depths));
  Differences differences(job, 1, folder / "journal");
  const Eigen::MatrixXd before = differences.raw.slopes(0);
  const auto largest = [](const inverse::LocalModel& model, Eigen::Index parameter) {
    double error = 0;
    for (Eigen::Index cut = 0; cut < static_cast<Eigen::Index>(depths.size()); ++cut)
      error = std::max(error, std::sqrt(model.slope_covariance(cut, 0)(parameter, parameter)));
    return error;
  };
  for (const double step : {0.001, 0.2}) {
    inverse::LocalModel model = differences.raw;
    Eigen::VectorXd point = differences.truth();
    point[3] += step;
    model.learn(differences.objective.evaluate(point));
    // A surprise of 0.3 % over 0.001 would be a slope of 3; what it does tell is the roughness of the base itself.
    EXPECT_LT((model.slopes(0) - before).cwiseAbs().maxCoeff(), 2 * largest(differences.raw, 3)) << step;
    EXPECT_LT(largest(model, 0), step < 0.05 ? 0.9 * largest(differences.raw, 0) : largest(differences.raw, 0)) << step;
    EXPECT_LT(largest(model, 3), (step < 0.05 ? 0.9 : 0.5) * largest(differences.raw, 3)) << step;
  }
}

}  // namespace
}  // namespace kerf
