#include "models/laws/material.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
