#include "models/laws/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "models/base/document.hpp"
#include "models/base/error.hpp"

namespace kerf::laws {
namespace {

Material read(const std::string& keys) {
  return make_material(Document::parse("[material]\ndensity = \"1000 kg/m^3\"\n" + keys, "cut.toml")
                           .read(material_blocks())
                           .at("material"));
}

const char* const polymer = "elastic_modulus = \"1 GPa\"\npoisson_ratio = 0.33\nyield_stress = \"25 MPa\"\n";

TEST(Materials, AreMadeByTheirNamesInAFile) {
  const auto j2 = std::get<J2<LinearHardening>>(read(std::string("law = \"j2\"\n") + polymer));
  EXPECT_DOUBLE_EQ(j2.elastic_modulus, 1000.0);
  EXPECT_DOUBLE_EQ(j2.density, 1e-9);
  EXPECT_EQ(j2.hardening.modulus, 0.0);
  const auto power = std::get<J2<PowerHardening>>(
      read(std::string("law = \"j2_power\"\n") + polymer + "hardening_coefficient = 2\nhardening_exponent = 0.4\n"));
  EXPECT_EQ(power.hardening.exponent, 0.4);
  const auto voce =
      std::get<J2<SaturatingHardening>>(read(std::string("law = \"j2_saturating\"\n") + polymer +
                                             "saturation_stress = \"60 MPa\"\nsaturation_strain = 0.1\n"));
  EXPECT_EQ(voce.hardening.saturation_strain, 0.1);
  const auto hencky = std::get<Hencky<PowerHardening>>(read(std::string("law = \"hencky_power\"\n") + polymer +
                                                            "hardening_coefficient = 2\nhardening_exponent = 0.4\n"));
  EXPECT_EQ(hencky.elastic_modulus, 1000.0);
  EXPECT_EQ(hencky.hardening.exponent, 0.4);
}

const char* const fir =
    "law = \"hill\"\nmodulus_x = \"14500 MPa\"\nmodulus_y = \"960 MPa\"\nmodulus_z = \"620 MPa\"\n"
    "shear_modulus_xy = \"830 MPa\"\npoisson_xy = 0.37\npoisson_xz = 0.42\npoisson_yz = 0.35\n";

TEST(Materials, StrengthsThatAHillMaterialLeavesOutAreInfinite) {
  const auto hill = std::get<Hill>(read(std::string(fir) + "shear_yield_xy = \"30 MPa\"\n"));
  EXPECT_EQ(hill.constants().yield_x, Hill::infinite);
  EXPECT_EQ(hill.constants().yield_z, Hill::infinite);
  EXPECT_EQ(hill.shear_yield(), 30.0);
  EXPECT_EQ(hill.constants().hardening_coefficient, 0.0);
  EXPECT_NEAR(hill.hardening().yield_stress, 30.0 * std::sqrt(3.0), 1e-13);
  EXPECT_EQ(std::get<Hill>(read(fir)).shear_yield(), Hill::infinite);
}

TEST(Materials, SayWhereAHillMaterialIsImpossible) {
  const auto complaint = [](const std::string& keys) {
    try {
      read(keys);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no complaint");
  };
  const std::string open = complaint(std::string(fir) + "yield_y = \"10 MPa\"\n");
  EXPECT_THAT(open, testing::HasSubstr("cut.toml:11:"));
  EXPECT_THAT(open, testing::HasSubstr("one of them must be finite too"));
  const std::string low =
      complaint(std::string(fir) + "yield_x = \"10 MPa\"\nyield_y = \"100 MPa\"\nyield_z = \"100 MPa\"\n");
  EXPECT_THAT(low, testing::HasSubstr("yield_x = 10 MPa is too low beside yield_y and yield_z"));
  EXPECT_THAT(low, testing::HasSubstr("at least 50 MPa"));
}

TEST(Materials, RefuseToSoften) {
  try {
    read(std::string("law = \"j2_saturating\"\n") + polymer +
         "saturation_stress = \"20 MPa\"\nsaturation_strain = 0.1\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("cut.toml:7:"));
    EXPECT_THAT(error.what(), testing::HasSubstr("must not be below yield_stress = 25 MPa"));
  }
}

}  // namespace
}  // namespace kerf::laws
