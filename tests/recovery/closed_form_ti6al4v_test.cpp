// The shipped Ti-6Al-4V cuts at 10 m/min, seen by the closed forms. The bounds are what independent fits of the same
// equations gave; they say nothing about which edge assumption is right.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "data/curve.hpp"
#include "inverse/closed_form_reduction.hpp"
#include "inverse/reduction_json.hpp"
#include "models/chip/reduction.hpp"

namespace kerf {
namespace {

const chip::Reduction& titanium() {
  static const auto reduction = [] {
    const auto file = std::filesystem::path(KERF_SOURCE_DIR) / "data/sets/ti6al4v/10_m_min.csv";
    return chip::reduce(inverse::measurements_of(data::read_curve(file)));
  }();
  return reduction;
}

TEST(ClosedFormsOnTitanium, EdgeForceExplainsTheForces) {
  const auto& fit = titanium().find("shear_minimised_edge")->fit;
  EXPECT_FALSE(fit.rejected());
  EXPECT_GT(fit.find("yield_stress")->value, 1300.0);
  EXPECT_LE(fit.find("yield_stress")->value, 1350.5);
  EXPECT_NEAR(fit.find("friction")->value, 0.46, 0.01);
  EXPECT_NEAR(fit.find("bottom_force")->value, 30.0, 4.0);
  EXPECT_EQ(fit.find("yield_stress")->verdict, chip::Verdict::measured);
}

TEST(ClosedFormsOnTitanium, WithoutItTheyAreRejected) {
  const auto& fit = titanium().find("shear_minimised_coulomb")->fit;
  EXPECT_EQ(fit.freedom, 3);
  EXPECT_NEAR(fit.chi2, 20.0, 1.0);
  EXPECT_TRUE(fit.rejected());
}

TEST(ClosedFormsOnTitanium, ToughnessRestsOnTheEdgeAssumption) {
  const auto& adhesion = titanium().find("shear_minimised")->fit;
  const auto& no_drag = titanium().find("shear_minimised_edge_no_drag")->fit;
  EXPECT_NEAR(adhesion.chi2, no_drag.chi2, 0.1) << "equally good";
  EXPECT_NEAR(adhesion.find("toughness")->value, 9.0, 0.5);
  EXPECT_NEAR(no_drag.find("toughness")->value, 24.0, 0.5);
  EXPECT_NE(adhesion.find("toughness")->verdict, chip::Verdict::measured);
}

TEST(ClosedFormsOnTitanium, ChipThicknessContradictsThem) {
  const auto& fit = titanium().find("shear_minimised_edge_chip_ratio")->fit;
  EXPECT_EQ(fit.freedom, 5);
  EXPECT_TRUE(fit.rejected()) << "chi2 " << fit.chi2;
}

TEST(ClosedFormsOnTitanium, BluntEdgeIsPointedOut) {
  bool found = false;
  for (const auto& warning : titanium().warnings) found = found || warning.find("ploughs") != std::string::npos;
  EXPECT_TRUE(found);
}

TEST(ClosedFormsOnTitanium, JsonKeepsItsContract) {
  const auto file = std::filesystem::path(KERF_SOURCE_DIR) / "data/sets/ti6al4v/10_m_min.csv";
  const auto measurements = inverse::measurements_of(data::read_curve(file));
  const auto json = inverse::to_json(titanium(), measurements);
  for (const char* name : {"shear_minimised", "chip_force", "intercept_linear", "intercept_quadratic",
                           "intercept_exponential", "intercept_model"}) {
    ASSERT_TRUE(json["methods"].contains(name)) << name;
    const auto& toughness = json["methods"][name]["parameters"]["toughness"];
    EXPECT_EQ(toughness["unit"], "J/m^2");
    EXPECT_EQ(toughness["interval"].size(), 2U);
    EXPECT_TRUE(json["methods"][name]["verdict"].contains("toughness"));
  }
  for (const char* key : {"yield_stress", "friction", "adhesion_toughness"}) {
    EXPECT_TRUE(json["methods"]["shear_minimised"]["parameters"].contains(key)) << key;
  }
  const auto& parabola = json["methods"]["intercept_quadratic"]["parameters"]["toughness"];
  EXPECT_TRUE(parabola["se"].is_null() && parabola["interval"][0].is_null()) << "three forces, three parameters";
  EXPECT_FALSE(json["warnings"].empty());
  EXPECT_NEAR(json["friction_line"]["friction"]["value"].get<double>(), 0.46, 0.01);
}

}  // namespace
}  // namespace kerf
