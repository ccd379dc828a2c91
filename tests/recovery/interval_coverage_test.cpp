// Twin experiments at 3 rakes and 3 depths with 2 % noise on the forces, cut and fitted by the closed form through the
// whole of a calibration. What this does not prove: that a simulation is as smooth as the closed form.

#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "inverse/closed_form_cut.hpp"
#include "inverse/coverage.hpp"
#include "inverse/next_cut.hpp"
#include "tests/unit/modelled_cut.hpp"

namespace kerf {
namespace {

using testing::TemporaryFolder;

const std::vector<double> three_rakes{10, 20, 30}, three_depths{0.1, 0.2, 0.4};

std::string twin(const std::vector<double>& rakes, const std::vector<double>& depths, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::string text = "depth[mm],rake[deg],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm]\n";
  for (const double rake : rakes)
    for (const double depth : depths) {
      const auto forces = testing::synthetic_forces(depth, rake * std::acos(-1.0) / 180, {});
      const double error = 0.02 * forces.F_c;
      const double F_c = forces.F_c + (seed == 0 ? 0 : error * normal(random));
      const double F_t = forces.F_t + (seed == 0 ? 0 : error * normal(random));
      text += fmt::format("{},{},{:.15g},{:.15g},{:.15g},{:.15g}\n", depth, rake, F_c, error, F_t, error);
    }
  return text;
}

const std::string forces_only = testing::replaced(testing::job_text, R"(, "chip_ratio")", "");

TEST(IntervalCoverage, HoldsTheTruthIn95PercentOfTheTrials) {
  const TemporaryFolder folder;
  const int trials = 400;
  std::map<std::string, int> held{{"yield_stress", 0}, {"toughness", 0}, {"friction", 0}};
  const std::map<std::string, double> truth{{"yield_stress", 60}, {"toughness", 2}, {"friction", 0.3}};
  for (int trial = 1; trial <= trials; ++trial) {
    const inverse::Job job =
        testing::write_job(folder, forces_only, twin(three_rakes, three_depths, static_cast<std::uint64_t>(trial)));
    const auto outcome = testing::calibrate(job, folder / fmt::format("{}.jsonl", trial), inverse::closed_form_cut);
    for (auto& [name, count] : held) {
      const inverse::Interval& i = outcome.calibration.fit.identifiability.find(name)->interval;
      count += i.lower <= truth.at(name) && truth.at(name) <= i.upper ? 1 : 0;
    }
  }
  for (const auto& [name, count] : held) {
    const double share = static_cast<double>(count) / trials;
    RecordProperty(name, std::to_string(share));
    EXPECT_GE(share, 0.93) << name;
    EXPECT_LE(share, 0.97) << name;
  }
}

/// Slopes of a job's cuts at the truth.
struct Slopes : testing::ModelledCut {
  explicit Slopes(const inverse::Job& of) : Slopes(of, std::make_shared<TemporaryFolder>()) {}
  double error_of(const std::string& name) const {
    return inverse::identify(model, misfit, space).find(name)->standard_error;
  }

  std::shared_ptr<TemporaryFolder> folder;
  inverse::LocalModel model;

 private:
  Slopes(const inverse::Job& of, const std::shared_ptr<TemporaryFolder>& place)
      : ModelledCut(of, *place / "journal.jsonl", inverse::closed_form_cut), folder(place), model(about(truth())) {}
};

TEST(NextCut, ShrinksTheErrorAsItsJacobianPredicts) {
  const TemporaryFolder folder;
  const Slopes before(testing::write_job(folder, forces_only, twin({20}, three_depths, 0)));
  const Slopes candidates(inverse::with_cuts(before.job, inverse::candidate_cuts(before.job)));
  const auto cuts =
      inverse::next_cuts(before.job, before.model, before.misfit, candidates.job, candidates.model, "toughness");
  ASSERT_EQ(cuts.size(), 3u * 7u * 3u);  // rakes, depths, and the observables that the closed form knows
  EXPECT_LT(cuts.front().standard_error_ratio, 0.95);
  EXPECT_LE(cuts.back().standard_error_ratio, 1 + 1e-9);

  inverse::Job longer = before.job;
  const inverse::NextCut& best = cuts.front();
  longer.cuts.push_back({.depth = best.depth, .rake = best.rake, .specimen = "next", .measured = {}});
  longer.cuts.back().measured[static_cast<std::size_t>(best.observable)] =
      Estimate{best.expected, best.measurement_error};
  const Slopes after(longer);
  EXPECT_NEAR(after.error_of("toughness") / before.error_of("toughness"), best.standard_error_ratio, 0.01);
  EXPECT_THROW(
      inverse::next_cuts(before.job, before.model, before.misfit, candidates.job, candidates.model, "toughnes"),
      InputError);
}

TEST(Binomial, IntervalsAreThoseOfClopperAndPearson) {
  // 0 of n leaves 1 - 0.025^(1/n) above.
  EXPECT_NEAR(inverse::binomial_interval(0, 10).upper, 1 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_NEAR(inverse::binomial_interval(10, 10).lower, std::pow(0.025, 0.1), 1e-12);
}

}  // namespace
}  // namespace kerf
