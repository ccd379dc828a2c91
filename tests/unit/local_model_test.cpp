// The quadratics about a simulated point: across branches, near their differences and far from them.

#include "inverse/local_model.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/modelled_cut.hpp"

namespace kerf {
namespace {

using testing::job_text;
using testing::ModelledCut;
using testing::synthetic_cut;
using testing::TemporaryFolder;
using testing::two_branches;
using testing::write_job;

TEST(LocalModel, NeverDifferencesAcrossABranch) {
  const TemporaryFolder folder;
  ModelledCut cut(write_job(folder), folder / "journal.jsonl", two_branches);
  const auto model = cut.about(cut.truth());
  EXPECT_EQ(inverse::count(model.known()), 4u);
  const auto nowhere = [](const Eigen::VectorXd&) { return false; };
  EXPECT_EQ(inverse::count(model.at_jump(nowhere)), 4u) << "every cut jumps at 61 MPa";
  // The step of 4 % upwards crosses to the other branch; the slope must be that of this side, d ln F_c < d ln sigma_y.
  Eigen::VectorXd moved = cut.truth();
  moved[0] -= 0.02;
  const double change = std::log(model.predict(moved)(3, 0) / model.base().simulated(3, 0));
  EXPECT_LT(change, 0);
  EXPECT_GT(change, -0.02);
}

TEST(LocalModel, RemembersWhereOtherRunsChangedTheBranch) {
  const TemporaryFolder folder;
  const std::string text = std::string(job_text) + "[optimiser]\nstep = 0.01\nnoise = 1e-7\n";
  ModelledCut cut(write_job(folder, text), folder / "journal.jsonl", two_branches);
  auto model = cut.about(cut.truth());
  const auto jumps = [&](bool allowed) {
    return inverse::count(model.at_jump([&](const Eigen::VectorXd&) { return allowed; }));
  };
  EXPECT_EQ(jumps(true), 0u) << "60.6 MPa do not reach the jump at 61";
  Eigen::VectorXd beyond = cut.truth();
  beyond[0] += 0.05;
  model.learn(cut.objective.evaluate(beyond));
  EXPECT_EQ(jumps(true), 4u);
  EXPECT_EQ(jumps(false), 0u) << "five steps away, where the data do not allow it";
}

TEST(LocalModel, ShrinksTheStepUntilTheBranchStays) {
  const TemporaryFolder folder;
  // Bending on both sides: only steps below 1.6 % of the flow stress stay.
  const auto island = [](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    if (std::abs(std::log(std::sqrt(3.0) * laws::shear_yield(scene.material) / 60)) > 0.016) {
      result.branch = forward::Branch::bending;
      result.F_c.value *= 0.5;
    }
    return result;
  };
  ModelledCut cut(write_job(folder), folder / "journal.jsonl", island);
  const auto model = cut.about(cut.truth());
  EXPECT_EQ(inverse::count(model.known()), 4u);
  EXPECT_GT(model.slopes(0)(3, 0), 0.5);
  EXPECT_LT(model.slopes(0)(3, 0), 1);
}

TEST(LocalModel, CentralDifferencesHaveNoErrorOfFirstOrder) {
  const TemporaryFolder folder;
  const auto slope = [&](bool central, double step) {
    const std::string text =
        std::string(job_text) + fmt::format("[optimiser]\nstep = {}\ncentral = {}\nnoise = 1e-7\n", step, central);
    ModelledCut cut(write_job(folder, text), folder / fmt::format("{}{}.jsonl", central, step));
    const auto model = cut.about(cut.truth());
    EXPECT_EQ(cut.database.runs(), central ? 4u + 24u : 4u + 12u);
    return model.slopes(0)(3, 0);
  };
  const double exact = slope(true, 1e-4);
  EXPECT_LT(std::abs(slope(true, 0.2) - exact), 0.2 * std::abs(slope(false, 0.2) - exact));
}

TEST(LocalModel, IsSureNearItsDifferencesAndTheyCostNoMoreRuns) {
  const TemporaryFolder folder;
  ModelledCut cut(write_job(folder), folder / "journal.jsonl");
  auto model = inverse::LocalModel(cut.objective.evaluate(cut.truth()), cut.objective.choice());
  EXPECT_FALSE(model.is_sure(cut.objective));
  model.difference(cut.objective);
  EXPECT_TRUE(model.is_sure(cut.objective));
  EXPECT_EQ(cut.database.runs(), 4u + 12u);

  const auto slope_at = [&](const Eigen::VectorXd& there) { return cut.about(there).slopes(0)(3, 0); };
  const inverse::Evaluation near = cut.objective.evaluate(cut.truth() + Eigen::Vector3d(0.003, 0.003, -0.003));
  const inverse::Evaluation far = cut.objective.evaluate(cut.truth() + Eigen::Vector3d(0.5, -0.8, 0.7));
  model.move_to(near);
  EXPECT_TRUE(model.is_sure(cut.objective));
  EXPECT_NEAR(model.slopes(0)(3, 0), slope_at(near.point), 0.01);
  model.move_to(far);
  EXPECT_FALSE(model.is_sure(cut.objective)) << "curvature may have turned the slopes by then";
  const std::size_t before = cut.database.runs();
  model.difference(cut.objective);
  EXPECT_TRUE(model.is_sure(cut.objective));
  EXPECT_LE(cut.database.runs(), before + 12);
  EXPECT_NEAR(model.slopes(0)(3, 0), slope_at(far.point), 0.02);
}

TEST(LocalModel, GoesOnStraightBeyondItsReach) {
  const TemporaryFolder folder;
  ModelledCut cut(write_job(folder), folder / "journal.jsonl");
  auto model = cut.about(cut.truth());
  for (const double step : {-0.4, -0.2, 0.2, 0.4}) {
    Eigen::VectorXd there = cut.truth();
    there[1] += step;
    model.learn(cut.objective.evaluate(there));
  }
  const auto logarithm = [&](double step) {
    Eigen::VectorXd there = cut.truth();
    there[1] += step;
    return std::log(model.predict(there)(0, 0));
  };
  const double tiny = 1e-3;
  const auto slope = [&](double step) { return (logarithm(step + tiny) - logarithm(step - tiny)) / (2 * tiny); };
  const double bend = slope(0.3) - slope(-0.3);
  EXPECT_GT(bend, 0.03) << "toughness is the larger share of the force the more of it there is";
  EXPECT_NEAR(slope(2), slope(0.51), 1e-6);
  EXPECT_NEAR(slope(-2), slope(-0.51), 1e-6);
  EXPECT_NEAR(slope(0.52), slope(0.48), 0.1 * bend);
}

TEST(LocalModel, IsNotBentByTheRoughnessOfACutThatWasNotAudited) {
  const TemporaryFolder folder;
  // The deepest cut is rough by 0.2 %, three hundred times what is said.
  const auto one_rough = [](const forward::Scene& scene) {
    forward::CutResult result = synthetic_cut(scene);
    if (scene.cut.depth > 0.5) result.F_c.value *= 1 + 0.003 * std::sin(1e6 * result.F_c.value);
    return result;
  };
  const std::string text = std::string(job_text) + "[optimiser]\nstep = 0.15\nnoise = 7e-6\n";
  ModelledCut smooth(write_job(folder, text), folder / "smooth"),
      cut(write_job(folder, text), folder / "rough", one_rough);
  const inverse::LocalModel exact = smooth.about(cut.truth());
  auto model = cut.about(cut.truth());
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (const double size : {0.005, 0.01, 0.01, 0.02, 0.02, 0.05, 0.1, 0.15, 0.2}) {
    const Eigen::Vector3d direction = Eigen::Vector3d::NullaryExpr([&] { return normal(random); });
    model.learn(cut.objective.evaluate(cut.truth() + size * direction.normalized()));
  }
  EXPECT_LT((model.slopes(0) - exact.slopes(0)).topRows(3).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((model.slopes(0) - exact.slopes(0)).row(3).cwiseAbs().maxCoeff(), 0.05);
  for (Eigen::Index j = 0; j < 3; ++j) {
    const double error = std::sqrt(model.slope_covariance(3, 0)(j, j));
    EXPECT_GT(error, 0.003) << "what is rough by 0.2 % tells slopes over 0.15 to a hundredth";
    EXPECT_LT(error, 0.03);
    for (const double step : {-0.2, 0.2}) {
      Eigen::VectorXd there = cut.truth();
      there[j] += step;
      const double change = std::log(model.predict(there)(3, 0) / exact.predict(there)(3, 0));
      EXPECT_LT(std::abs(change), 0.012);
    }
  }
}

}  // namespace
}  // namespace kerf
