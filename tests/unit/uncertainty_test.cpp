// Weights, priors, derived quantities and what is left of an estimate without some of the data.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "inverse/left_out.hpp"
#include "inverse/statement.hpp"
#include "models/base/units.hpp"
#include "tests/unit/modelled_cut.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using testing::calibrate;
using testing::curve_text;
using testing::job_text;
using testing::replaced;
using testing::TemporaryFolder;
using testing::write_job;

const std::vector<double> depths{0.1, 0.2, 0.4, 0.8};

/// The synthetic cut with a chip that curls with two depths' radius and more for a stronger material.
forward::CutResult curling(const forward::Scene& scene) {
  forward::CutResult result = testing::synthetic_cut(scene);
  result.chip_curvature.value = -0.5 / scene.cut.depth * laws::shear_yield(scene.material) / 40;
  return result;
}

TEST(Curl, IsComparedAsACurvature) {
  const TemporaryFolder folder;
  const std::string curve =
      "#: rake = 30 deg\ndepth[mm],Fc[N/mm],Ft[N/mm],curl_radius[mm],curl_radius_sd[mm],repeats\n"
      "0.5,40,10,-2,0.4,4\n0.8,60,15,,,4\n";
  const inverse::Job job =
      write_job(folder, replaced(job_text, R"("F_c", "F_t", "chip_ratio")", R"("chip_curvature")"), curve);
  const auto& measured = job.cuts[0].measured[static_cast<std::size_t>(inverse::Observable::chip_curvature)];
  ASSERT_TRUE(measured.has_value());
  EXPECT_DOUBLE_EQ(measured->value, -0.5);
  EXPECT_DOUBLE_EQ(measured->standard_error, 0.2 / 4);  // d(1/R) = dR / R^2, dR that of the mean
  EXPECT_FALSE(job.cuts[1].measured[3].has_value()) << "a straight chip's cell is empty";
  EXPECT_THAT([&] { write_job(folder, job_text, replaced(curve, "-2,0.4", "0,0.4")); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("curl radius 0")));
}

TEST(Curl, TellsWhatItDependsOn) {
  const TemporaryFolder folder;
  std::string curve = "#: rake = 30 deg\ndepth[mm],Fc[N/mm],Ft[N/mm],curl_radius[mm],curl_radius_sd[mm]\n";
  for (const double depth : depths) {  // a shear yield stress of 60/sqrt(3) MPa
    const double radius = -depth / 0.5 * 40 / (60 / std::sqrt(3.0));
    curve += fmt::format("{},40,10,{:.12g},{:.12g}\n", depth, radius, 0.02 * std::abs(radius));
  }
  std::string job = replaced(job_text, R"("F_c", "F_t", "chip_ratio")", R"("chip_curvature")");
  job = replaced(job, "lower = \"10 MPa\"", "start = \"50 MPa\"\nlower = \"10 MPa\"");
  const auto outcome = calibrate(write_job(folder, job, curve), folder / "journal.jsonl", curling);
  const auto& yield = *outcome.calibration.fit.identifiability.find("yield_stress");
  EXPECT_NEAR(yield.value, 60, 0.1);
  EXPECT_NEAR(yield.standard_error / yield.value, 0.02 / 2, 1e-3);  // four chips
  EXPECT_EQ(outcome.calibration.fit.identifiability.find("toughness")->verdict, inverse::Verdict::not_measurable);
}

struct Compared {
  explicit Compared(const inverse::Job& read) : job(read), space(job), misfit(job, space), mask(job.cuts.size(), true) {
    point = 0.5 * (space.lower() + space.upper());
    simulated.resize(static_cast<Eigen::Index>(job.cuts.size()), Eigen::NoChange);
    simulated.setZero();
    for (std::size_t i = 0; i < job.cuts.size(); ++i)
      for (std::size_t k = 0; k < inverse::observable_count; ++k)
        if (const auto& m = job.cuts[i].measured[k])
          simulated(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
              m->value * (1 + 0.01 * static_cast<double>(i + 1) * (k == 1 ? -1 : 1));
  }
  inverse::Job job;
  inverse::ParameterSpace space;
  inverse::Misfit misfit;
  inverse::CutMask mask;
  Eigen::VectorXd point;
  inverse::Observations simulated;
};

TEST(SpecimenError, IsAFullCovariance) {
  const TemporaryFolder folder;
  const std::string job = replaced(job_text, "file = \"curve.csv\"", "file = \"curve.csv\"\nspecimen_error = 0.05");
  const Compared c(write_job(folder, job, curve_text({}, depths)));
  // The same by Cholesky: forces share one error, chip ratios another.
  const Eigen::Index n = 4;
  double chi2 = 0;
  for (const std::vector<Eigen::Index>& columns : {std::vector<Eigen::Index>{0, 1}, {2}}) {
    const auto size = n * static_cast<Eigen::Index>(columns.size());
    Eigen::VectorXd r(size), u(size), s(size);
    Eigen::Index at = 0;
    for (const Eigen::Index k : columns)
      for (Eigen::Index i = 0; i < n; ++i, ++at) {
        const Estimate& m = *c.job.cuts[static_cast<std::size_t>(i)].measured[static_cast<std::size_t>(k)];
        r[at] = c.simulated(i, k) - m.value;
        u[at] = 0.05 * m.value;
        s[at] = m.standard_error;
      }
    const Eigen::MatrixXd covariance = Eigen::MatrixXd(s.cwiseAbs2().asDiagonal()) + u * u.transpose();
    chi2 += covariance.llt().matrixL().solve(r).squaredNorm();
  }
  const inverse::Residuals residuals = c.misfit.residuals(c.simulated, c.point, c.mask);
  EXPECT_NEAR(residuals.chi2, chi2, 1e-9 * chi2);
  const Estimate& first = *c.job.cuts[0].measured[0];
  EXPECT_NEAR(residuals.standardised[0], 0.01 * first.value / std::hypot(first.standard_error, 0.05 * first.value),
              1e-12);
}

TEST(SpecimenError, WidensWhatAllCutsShareOnly) {
  const TemporaryFolder folder;
  const std::string alone = replaced(job_text, R"(, "chip_ratio")", "") + "[optimiser]\nstep = 0.002\n";
  const std::string shared = replaced(alone, "file = \"curve.csv\"", "file = \"curve.csv\"\nspecimen_error = 0.1");
  const auto relative_error = [&](const std::string& job, const char* journal, const char* name) {
    const auto outcome = calibrate(write_job(folder, job), folder / journal);
    const auto& p = *outcome.calibration.fit.identifiability.find(name);
    return p.standard_error / p.value;
  };
  // All forces 10 % too high is a yield stress and a toughness 10 % too high, and no other friction.
  const double before = relative_error(alone, "a", "toughness");
  EXPECT_NEAR(relative_error(shared, "b", "toughness"), std::hypot(before, 0.1), 1e-3);
  EXPECT_NEAR(relative_error(shared, "b", "friction"), relative_error(alone, "a", "friction"), 1e-3);
}

TEST(Prior, CombinesWithTheDataByInverseVariances) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& job, const char* journal) {
    const auto outcome = calibrate(write_job(folder, job), folder / journal);
    return outcome.calibration.fit.identifiability.find("toughness")->standard_error;
  };
  const double alone = error_of(job_text, "a");
  const std::string prior =
      replaced(job_text, "upper = \"20 kJ/m^2\"",
               fmt::format("upper = \"20 kJ/m^2\"\nprior = \"2 kJ/m^2\"\nprior_error = \"{:.9g} kJ/m^2\"", alone));
  EXPECT_NEAR(error_of(prior, "b"), alone / std::sqrt(2.0), 0.02 * alone);
}

TEST(Prior, PullsTheEstimate) {
  const TemporaryFolder folder;
  const std::string prior = replaced(job_text, "upper = \"20 kJ/m^2\"",
                                     "upper = \"20 kJ/m^2\"\nprior = \"3 kJ/m^2\"\nprior_error = \"1 J/m^2\"");
  const auto outcome = calibrate(write_job(folder, prior), folder / "journal.jsonl");
  EXPECT_NEAR(testing::value(outcome.calibration, "toughness"), 3, 0.01);
  EXPECT_THAT(outcome.calibration.statement, ::testing::HasSubstr("known of toughness beforehand"));
}

const std::string derived =
    "[[derived]]\nname = \"total\"\nunit = \"J/m^2\"\n"
    "expression = \"cohesive.mode_I.toughness + 2 * cohesive.mode_II.toughness\"\n"
    "[[derived]]\nname = \"zone\"\nunit = \"mm\"\n"
    "expression = \"material.elastic_modulus * toughness / yield_stress^2\"\n";

TEST(Derived, FollowsPathsNamesTiesAndConstants) {
  const TemporaryFolder folder;
  const inverse::Job job = write_job(folder, job_text + derived);
  const std::vector<double> values{60, 2, 0.3};
  EXPECT_NEAR(job.derived[0].of(values), 2 + 2 * 2, 1e-12);
  EXPECT_NEAR(job.derived[1].of(values), 1000 * 2 / (60.0 * 60.0), 1e-12);
}

TEST(Derived, HasTheErrorAndTheIntervalOfItsParameter) {
  const TemporaryFolder folder;
  const auto outcome = calibrate(write_job(folder, job_text + derived), folder / "journal.jsonl");
  const inverse::Identifiability& known = outcome.calibration.fit.identifiability;
  const auto &toughness = *known.find("toughness"), &total = *known.find("total"), &zone = *known.find("zone");
  EXPECT_NEAR(total.value, 3 * toughness.value, 1e-9);
  EXPECT_NEAR(total.standard_error, 3 * toughness.standard_error, 1e-9);
  EXPECT_NEAR(total.interval.lower, 3 * toughness.interval.lower, 2e-3 * total.value);
  EXPECT_NEAR(total.interval.upper, 3 * toughness.interval.upper, 2e-3 * total.value);
  // Toughness and yield stress are told apart through their opposite errors, which the zone's length adds up.
  EXPECT_GT(zone.standard_error / zone.value, toughness.standard_error / toughness.value);
}

TEST(Derived, IsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  const auto refused = [&](const char* expression, const char* unit, const char* said) {
    const std::string text =
        fmt::format("[[derived]]\nname = \"q\"\nunit = \"{}\"\nexpression = \"{}\"\n", unit, expression);
    EXPECT_THAT([&] { write_job(folder, job_text + text); },
                ::testing::ThrowsMessage<InputError>(::testing::HasSubstr(said)))
        << expression;
  };
  refused("toughness / yield_stress", "MPa", "is measured in");
  refused("toughness + yield_stress", "J/m^2", "is measured in");
  refused("toughness *", "J/m^2", "is missing");
  refused("toughness (2)", "J/m^2", "expected +");
  refused("cohesive.mode_I.toughnes", "J/m^2", "did you mean");
  refused("toughness", "furlong^x", "unit");
}

TEST(TradeOff, NamesTheCombinationThatIsKnown) {
  const TemporaryFolder folder;
  // At one rake and one depth, F_c says one thing about two parameters; with friction held by a prior.
  std::string job = replaced(job_text, R"("F_c", "F_t", "chip_ratio")", R"("F_c")");
  job = replaced(job, "upper = 1.5", "upper = 1.5\nprior = 0.3\nprior_error = 0.001");
  const auto outcome = calibrate(write_job(folder, job, curve_text({}, {0.4}, 0.01)), folder / "journal.jsonl");
  const inverse::ParameterEstimate& toughness = *outcome.calibration.fit.identifiability.find("toughness");
  ASSERT_TRUE(toughness.trade_off.has_value());
  EXPECT_EQ(toughness.trade_off->partner, "yield_stress");
  // d ln F_c = a d ln G + b d ln sigma, so G sigma^(b/a) is known to 1 % / a.
  const double step = 1e-4, rake = std::acos(-1.0) / 6;
  const auto slope = [&](double G, double sigma) {
    const auto at = [&](double s) {
      return testing::synthetic_forces(
                 0.4, rake,
                 {.yield_stress = testing::value(outcome.calibration, "yield_stress") * std::exp(sigma * s),
                  .toughness = toughness.value * std::exp(G * s),
                  .friction = testing::value(outcome.calibration, "friction")})
          .F_c;
    };
    return std::log(at(step) / at(-step)) / (2 * step);
  };
  const double a = slope(1, 0), b = slope(0, 1);
  EXPECT_NEAR(toughness.trade_off->exponent, b / a, 0.03 * b / a);
  EXPECT_NEAR(toughness.trade_off->relative_error, 0.01 / a, 0.05 * 0.01 / a);
  EXPECT_THAT(outcome.calibration.statement, ::testing::HasSubstr("trades off against yield stress"));
}

TEST(Resampling, AnOutlierIsWhatTheEstimateHangsOn) {
  const TemporaryFolder folder;
  std::string curve = "#: rake = 30 deg\ndepth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm],specimen\n";
  const char* specimens[] = {"A", "B", "C", "D", "A", "B", "C", "D"};
  for (int i = 0; i < 8; ++i) {
    const double depth = 0.1 * (i + 1);
    const auto forces = testing::synthetic_forces(depth, std::acos(-1.0) / 6, {});
    const double off = i == 2 || i == 6 ? 1.1 : 1.0;  // all of specimen C
    curve += fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{}\n", depth, off * forces.F_c, 0.02 * forces.F_c,
                         forces.F_t, 0.02 * forces.F_c, specimens[i]);
  }
  const std::string job = replaced(job_text, R"(, "chip_ratio")", "");
  const auto outcome = calibrate(write_job(folder, job, curve), folder / "journal.jsonl");
  const inverse::Resampling& r = outcome.calibration.fit.resampling;
  ASSERT_EQ(r.without_cut.size(), 8u);
  ASSERT_EQ(r.without_specimen.size(), 4u);
  // Without C the rest is the truth.
  EXPECT_EQ(r.without_specimen[2].what, "C");
  EXPECT_NEAR(r.without_specimen[2].values[0], 60, 0.6);
  EXPECT_NEAR(r.without_specimen[2].values[1], 2, 0.06);
  EXPECT_GT(std::abs(r.without_specimen[0].values[0] - 60), 1.2);
  ASSERT_TRUE(r.bootstrap.has_value());
  EXPECT_EQ(r.bootstrap->draws, 200);
  EXPECT_GT(r.bootstrap->standard_deviations[0], 0.5);
}

TEST(Verify, SimulatesTheEndsOfTheIntervals) {
  const TemporaryFolder folder;
  const std::string verify = job_text + std::string("[uncertainty]\nverify = true\n");
  const auto outcome = calibrate(write_job(folder, verify, curve_text({}, depths, 0.01)), folder / "journal.jsonl");
  const inverse::Identifiability& known = outcome.calibration.fit.identifiability;
  for (const inverse::ParameterEstimate& p : known.parameters) {
    ASSERT_TRUE(p.lower_end && p.upper_end) << p.name;
    ASSERT_TRUE(p.lower_end->simulated.has_value()) << p.name;
    // The 95 % rise of chi^2 is 3.84; close to the estimate the linear model keeps its word.
    EXPECT_NEAR(p.lower_end->predicted - known.chi2, 3.84, 0.01) << p.name;
    EXPECT_NEAR(*p.lower_end->simulated - known.chi2, 3.84, 0.6) << p.name;
  }
  const auto plain = calibrate(write_job(folder, job_text, curve_text({}, depths, 0.01)), folder / "other.jsonl");
  EXPECT_EQ(outcome.runs, plain.runs + 12 * depths.size()) << "once for the slopes, once for chi^2";
}

/// Over steps of a tenth of its error a parameter's slope drowns in the roughness of the simulation; over steps as long
/// as its interval it does not.
TEST(Verify, TheEndsTeachTheSlopes) {
  const TemporaryFolder folder;
  const std::string text = std::string(job_text) + "[optimiser]\nstep = 0.02\nnoise = 0.002\n";
  double with = 0, without = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    const auto rough = [seed](const forward::Scene& scene) {
      forward::CutResult result = testing::synthetic_cut(scene);
      for (Estimate* force : {&result.F_c, &result.F_t, &result.chip_ratio})
        force->value *= 1 + 0.002 * std::sqrt(2.0) * std::sin(1e7 * seed * force->value);
      return result;
    };
    for (const bool verify : {true, false}) {
      const std::string job = text + (verify ? "[uncertainty]\nverify = true\n" : "");
      const auto found = calibrate(write_job(folder, job, curve_text({}, depths, 0.04)),
                                   folder / fmt::format("{}{}.jsonl", seed, verify), rough)
                             .calibration;
      const inverse::LocalModel& model = *found.fit.model;
      testing::ModelledCut smooth(write_job(folder, std::string(job_text) + "[optimiser]\nstep = 1e-4\nnoise = 1e-9\n"),
                                  folder / fmt::format("{}{}_smooth.jsonl", seed, verify));
      const inverse::LocalModel exact = smooth.about(model.base().point);
      (verify ? with : without) += (model.slopes(0).col(1) - exact.slopes(0).col(1)).squaredNorm();
    }
  }
  EXPECT_LT(std::sqrt(with), 0.5 * std::sqrt(without)) << "toughness, F_c";
}

TEST(Statement, ShowsTheDigitsThatAnErrorLeaves) {
  const double MPa = consistent_units_in("MPa");
  EXPECT_EQ(inverse::show(1096.4 * MPa, "MPa", 78.1 * MPa), "1096 MPa");
  EXPECT_EQ(inverse::show(15847 * MPa, "MPa", 4692 * MPa), "15800 MPa");
  EXPECT_EQ(inverse::show(0.30821, "1", 0.0227), "0.308");
  EXPECT_EQ(inverse::show(0.5, "1", 0.0004), "0.50000");
  EXPECT_EQ(inverse::show(1202 * MPa, "MPa", 3190 * MPa), "1200 MPa") << "an error larger than the value";
  EXPECT_EQ(inverse::show(10670, "1", 268000), "11000");
  EXPECT_EQ(inverse::show(1096.4 * MPa, "MPa"), "1096 MPa");
  EXPECT_EQ(inverse::show(0.30821, "1"), "0.308");
  EXPECT_EQ(inverse::show(0, "1", 0.1), "0.00");
  EXPECT_EQ(inverse::show(2.5e9, "1", 3e7), "2.500e+09");
  EXPECT_EQ(inverse::show(1, "1", std::numeric_limits<double>::infinity()), "1.00");
}

}  // namespace
}  // namespace kerf
