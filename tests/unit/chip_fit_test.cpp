#include <gtest/gtest.h>

#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "models/chip/fit_method.hpp"
#include "models/chip/friction_line.hpp"
#include "models/chip/plastic_bending.hpp"
#include "models/chip/reduction.hpp"
#include "models/chip/shear_minimised.hpp"

namespace kerf::chip {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

MeasuredCut cut_at(double depth, double F_c, double F_t = 0.0) {
  MeasuredCut cut;
  cut.depth = depth;
  cut.rake = 15.0 * degree;
  cut.F_c = F_c;
  cut.F_t = F_t;
  return cut;
}

Fit fit(const std::string& method, const Measurements& measurements, const FitOptions& options = {}) {
  return apply(*find_fit_method(method), measurements, options).fit;
}

const std::vector<std::pair<double, double>> scattered = {
    {0.1, 5.2}, {0.2, 7.9}, {0.3, 11.3}, {0.4, 13.6}, {0.5, 17.2}};

Measurements scattered_line(std::optional<double> error = {}) {
  std::vector<MeasuredCut> cuts;
  for (const auto& [depth, force] : scattered) {
    cuts.push_back(cut_at(depth, force));
    cuts.back().F_c_error = cuts.back().F_t_error = error;
  }
  return Measurements(cuts);
}

TEST(LeastSquaresFit, OfALineIsTheTextbookOne) {
  const auto result = fit("intercept_linear", scattered_line());
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& [x, y] : scattered) n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  const double intercept = (sy - slope * sx) / n;
  double squares = 0;
  for (const auto& [x, y] : scattered) squares += std::pow(y - intercept - slope * x, 2);
  const double s = std::sqrt(squares / (n - 2));
  const double error = s * std::sqrt(sxx / (n * sxx - sx * sx));
  const double t = boost::math::quantile(boost::math::students_t(n - 2), 0.975);

  const auto& toughness = result.parameters.at(0);
  EXPECT_NEAR(toughness.value, intercept, 1e-9);
  EXPECT_NEAR(toughness.standard_error, error, 1e-9);
  EXPECT_NEAR(toughness.lower, intercept - t * error, 1e-5 * error) << "the profile of a linear model is exact";
  EXPECT_NEAR(toughness.upper, intercept + t * error, 1e-5 * error);
  EXPECT_NEAR(result.scatter, s, 1e-9);
  EXPECT_EQ(result.freedom, 3);
  EXPECT_NEAR(result.correlation(0, 1), -sx / std::sqrt(n * sxx), 1e-9);
  EXPECT_FALSE(result.p_value.has_value()) << "nothing to test against";
}

/// Three forces leave a fit of A exp(k h) one degree of freedom, and its limits lie far out: where chi2, at the best k
/// for that A (a fine scan), is 1 + t^2 times the least.
TEST(LeastSquaresFit, OfAnExponentialFindsItsLimitsFarOut) {
  const double t = boost::math::quantile(boost::math::students_t(1), 0.975);
  for (const auto& forces : {std::array{0.963, 1.248, 1.416}, std::array{0.975, 1.589, 2.999}}) {
    const Measurements three({cut_at(0.2, forces[0]), cut_at(0.3, forces[1]), cut_at(0.4, forces[2])});
    const auto result = fit("intercept_exponential", three);
    ASSERT_EQ(result.freedom, 1);
    const auto least = [&](double toughness) {
      double lowest = 1e300;
      for (double rate = -50; rate < 50; rate += 1e-4) {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
          sum += std::pow(toughness * std::exp(rate * (0.2 + 0.1 * static_cast<double>(i))) - forces[i], 2);
        lowest = std::min(lowest, sum);
      }
      return lowest;
    };
    const auto& toughness = result.parameters.at(0);
    EXPECT_LT(toughness.lower, 0.2 * toughness.value);
    EXPECT_NEAR(least(toughness.lower), (1 + t * t) * result.chi2, 1e-3 * t * t * result.chi2);
    EXPECT_NEAR(least(toughness.upper), (1 + t * t) * result.chi2, 1e-3 * t * t * result.chi2);
  }
}

TEST(LeastSquaresFit, KnownErrorsAreNotRescaled) {
  const auto small = fit("intercept_linear", scattered_line(0.01));
  const auto large = fit("intercept_linear", scattered_line(0.1));
  EXPECT_NEAR(large.parameters[0].standard_error, 10.0 * small.parameters[0].standard_error, 1e-8);
  EXPECT_NEAR(small.chi2, 100.0 * large.chi2, 1e-6 * small.chi2);
  EXPECT_TRUE(small.rejected());
  EXPECT_NEAR(large.parameters[0].upper - large.parameters[0].value, 1.959964 * large.parameters[0].standard_error,
              1e-5);
}

TEST(LeastSquaresFit, FewRepeatsWidenTheInterval) {
  auto cuts = scattered_line(0.5).cuts();
  for (auto& cut : cuts) cut.repeats = 2;
  const auto result = fit("intercept_linear", Measurements(cuts));
  const double t = boost::math::quantile(boost::math::students_t(5), 0.975);
  EXPECT_NEAR(result.parameters[0].upper - result.parameters[0].value, t * result.parameters[0].standard_error, 1e-5);
}

TEST(LeastSquaresFit, AsManyParametersAsForcesGiveNoInterval) {
  const Measurements three({cut_at(0.1, 5), cut_at(0.2, 8), cut_at(0.3, 12)});
  const auto result = fit("intercept_quadratic", three);
  EXPECT_EQ(result.freedom, 0);
  EXPECT_FALSE(result.aicc.has_value());
  for (const auto& parameter : result.parameters) {
    EXPECT_EQ(parameter.verdict, Verdict::not_measurable);
    EXPECT_TRUE(std::isnan(parameter.standard_error));
    EXPECT_TRUE(std::isinf(parameter.lower) && std::isinf(parameter.upper));
  }
  EXPECT_NEAR(result.parameters[0].value, 3.0, 1e-9) << "the parabola through three points";
  const Measurements two({cut_at(0.1, 5), cut_at(0.2, 8)});
  EXPECT_LT(fit("intercept_quadratic", two).freedom, 0);
}

TEST(LeastSquaresFit, AToughnessBelowItsErrorIsIndistinguishableFromZero) {
  std::vector<MeasuredCut> cuts;
  const double wobble[] = {0.4, -0.5, 0.3, -0.6, 0.5, -0.2};
  for (int i = 0; i < 6; ++i) cuts.push_back(cut_at(0.1 * (i + 1), 3.0 * (i + 1) + wobble[i] - 0.2));
  const auto result = fit("intercept_linear", Measurements(cuts));
  EXPECT_EQ(result.parameters[0].verdict, Verdict::zero);
  EXPECT_EQ(result.parameters[0].lower, 0.0) << "cut to the physical range";
  EXPECT_GT(result.parameters[0].upper, 0.0);
}

TEST(LeastSquaresFit, WhatTheDataDoNotSeeHasNoError) {
  // One depth: intercept and slope only occur as a sum.
  const Measurements one({cut_at(0.2, 5.0), cut_at(0.2, 5.1), cut_at(0.2, 4.9), cut_at(0.2 + 1e-13, 5.0)});
  const auto result = fit("intercept_linear", one);
  EXPECT_LT(result.singular_values.back(), 1e-9);
  EXPECT_TRUE(std::isnan(result.parameters[0].standard_error));
  EXPECT_EQ(result.parameters[0].verdict, Verdict::not_measurable);
}

std::vector<MeasuredCut> exact_cuts(double toughness, double yield_stress, double friction, double adhesion,
                                    double bottom_force) {
  std::vector<MeasuredCut> cuts;
  for (const double depth : {0.05, 0.1, 0.2, 0.3, 0.5}) {
    for (const double rake : {15.0 * degree, 30.0 * degree}) {
      const auto plane = shear_minimised(depth, rake, yield_stress, toughness, friction, adhesion);
      const auto forces = with_bottom_force(plane.forces, bottom_force, friction);
      auto cut = cut_at(depth, forces.F_c, forces.F_t);
      cut.rake = rake;
      const double phi = std::atan2(yield_stress * depth, plane.forces.F_c - toughness);
      cut.chip_ratio = std::cos(phi - rake) / std::sin(phi);
      cuts.push_back(cut);
    }
  }
  return cuts;
}

TEST(FitMethods, RecoverExactForces) {
  const auto with_adhesion = fit("shear_minimised", Measurements(exact_cuts(1.5, 40, 0.35, 0.4, 0)));
  EXPECT_NEAR(with_adhesion.find("toughness")->value, 1.5, 1e-6);
  EXPECT_NEAR(with_adhesion.find("yield_stress")->value, 40, 1e-5);
  EXPECT_NEAR(with_adhesion.find("friction")->value, 0.35, 1e-7);
  EXPECT_NEAR(with_adhesion.find("adhesion_toughness")->value, 0.4, 1e-6);

  const auto with_edge = fit("shear_minimised_edge", Measurements(exact_cuts(1.5, 40, 0.35, 0, 2.0)));
  EXPECT_NEAR(with_edge.find("toughness")->value, 1.5, 1e-6);
  EXPECT_NEAR(with_edge.find("bottom_force")->value, 2.0, 1e-6);

  const auto balance = fit("chip_force", Measurements(exact_cuts(1.5, 40, 0.35, 0.4, 0)));
  EXPECT_NEAR(balance.find("toughness")->value, 1.5, 1e-8);
  EXPECT_NEAR(balance.find("yield_stress")->value, 40, 1e-7);
}

TEST(FitMethods, RecoverABentChip) {
  const FitOptions options{.elastic_modulus = 1000.0, .hardening_ratio = 0.3};
  std::vector<MeasuredCut> cuts;
  for (const double depth : {0.2, 0.4, 0.6, 0.9}) {
    const BendingChip<double> chip{.depth = depth,
                                   .rake = 45.0 * degree,
                                   .yield_stress = 25.0 * plane_yield_stress_factor(true),
                                   .toughness = 0.25,
                                   .friction = 0.2,
                                   .modulus = plane_modulus(1000.0, 0.33, true),
                                   .hardening = 0.3,
                                   .root_rotation = options.root_rotation};
    const auto forces = chip.forces(*root_curvature(chip));
    cuts.push_back(cut_at(depth, forces.F_c, forces.F_t));
    cuts.back().rake = chip.rake;
  }
  const auto result = apply(*find_fit_method("plastic_bending"), Measurements(cuts), options);
  EXPECT_EQ(result.out_of_range, "");
  EXPECT_NEAR(result.fit.find("toughness")->value, 0.25, 1e-6);
  EXPECT_NEAR(result.fit.find("yield_stress")->value, 25.0, 1e-4);
  EXPECT_NEAR(result.fit.find("friction")->value, 0.2, 1e-7);
}

TEST(FitMethods, SayWhyTheyDoNotApply) {
  auto cuts = scattered_line().cuts();
  for (auto& cut : cuts) cut.F_t.reset();
  const Measurements no_transverse(cuts);
  EXPECT_NE(apply(*find_fit_method("shear_minimised"), no_transverse, {}).not_applied, "");
  EXPECT_NE(apply(*find_fit_method("chip_force"), scattered_line(), {}).not_applied, "");
  EXPECT_NE(apply(*find_fit_method("plastic_bending"), scattered_line(), {}).not_applied, "");
  EXPECT_EQ(apply(*find_fit_method("intercept_model"), no_transverse, {}).not_applied, "");
  EXPECT_EQ(find_fit_method("no_such_method"), nullptr);
}

TEST(FrictionLine, GivesSlopeInterceptAndScatter) {
  std::vector<MeasuredCut> cuts;
  const double Z = force_slope(0.4, 15.0 * degree);
  for (int i = 1; i <= 6; ++i) cuts.push_back(cut_at(0.1 * i, 10.0 * i, Z * 10.0 * i + 1.5 + (i % 2 ? 0.05 : -0.05)));
  const auto lines = friction_lines(Measurements(cuts));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0].slope.value, Z, 3.0 * lines[0].slope.standard_error);
  EXPECT_NEAR(lines[0].intercept.value, 1.5, 3.0 * lines[0].intercept.standard_error);
  EXPECT_NEAR(lines[0].friction.value, 0.4, 0.01);
  EXPECT_NEAR(lines[0].scatter, 0.06, 0.02);
  EXPECT_TRUE(lines[0].outliers.empty());
}

TEST(FrictionLine, NamesAnOutlier) {
  std::vector<MeasuredCut> cuts;
  for (int i = 1; i <= 8; ++i) {
    cuts.push_back(cut_at(0.1 * i, 10.0 * i, 2.0 * i + 0.05 * ((i * 7) % 5 - 2)));
    cuts.back().line = 10 + i;
  }
  cuts[3].F_t = *cuts[3].F_t + 3.0;
  const auto lines = friction_lines(Measurements(cuts));
  ASSERT_EQ(lines.size(), 1U);
  ASSERT_EQ(lines[0].outliers.size(), 1U);
  EXPECT_EQ(lines[0].outliers[0].line, 14);
  EXPECT_GT(lines[0].outliers[0].studentized, 5.0);
}

bool warns(const Reduction& reduction, std::string_view words) {
  for (const auto& warning : reduction.warnings) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(ReductionWarnings, SayWhenIntercepsDisagreeAndWhenTheToolIsBlunt) {
  std::vector<MeasuredCut> cuts;
  for (const double depth : {0.05, 0.1, 0.2, 0.3, 0.5}) {
    const auto forces = shear_minimised(depth, 15.0 * degree, 30.0, 1.0, 0.5, 0.0).forces;
    cuts.push_back(cut_at(depth, forces.F_c, forces.F_t));
    cuts.back().F_c_error = cuts.back().F_t_error = 0.05;
  }
  EXPECT_TRUE(warns(reduce(Measurements(cuts)), "disagree about the toughness"));
  EXPECT_FALSE(warns(reduce(Measurements(cuts)), "radius"));
  for (auto& cut : cuts) cut.tool_radius = 0.02;
  EXPECT_TRUE(warns(reduce(Measurements(cuts)), "radius"));
}

}  // namespace
}  // namespace kerf::chip
