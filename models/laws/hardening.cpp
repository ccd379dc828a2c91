#include "models/laws/hardening.hpp"

#include <fmt/format.h>

#include "models/base/error.hpp"

namespace kerf::laws {
namespace {

Parameter initial_yield_stress() {
  return number("yield_stress", "MPa", 1e-4, 1e5, "uniaxial yield stress sigma_y");
}

}  // namespace

std::vector<Parameter> LinearHardening::parameters() {
  return {
      initial_yield_stress(),
      number("hardening_modulus", "MPa", 0.0, 1e6, "slope of yield stress against plastic strain H").or_else("0 MPa")};
}

LinearHardening LinearHardening::from(const Values& values) {
  return {.yield_stress = values.number("yield_stress"), .modulus = values.number("hardening_modulus")};
}

std::vector<Parameter> PowerHardening::parameters() {
  return {initial_yield_stress(),
          number("hardening_coefficient", "1", 0.0, 1e4, "K of the flow stress sigma_y (1 + K eps_p^n)"),
          number("hardening_exponent", "1", 0.05, 5.0, "n of the flow stress sigma_y (1 + K eps_p^n)")};
}

PowerHardening PowerHardening::from(const Values& values) {
  return {.yield_stress = values.number("yield_stress"),
          .coefficient = values.number("hardening_coefficient"),
          .exponent = values.number("hardening_exponent")};
}

std::vector<Parameter> SaturatingHardening::parameters() {
  return {initial_yield_stress(),
          number("saturation_stress", "MPa", 1e-4, 1e5, "flow stress sigma_s at large plastic strain"),
          number("saturation_strain", "1", 1e-5, 1e2, "plastic strain eps_0 over which the flow stress saturates")};
}

SaturatingHardening SaturatingHardening::from(const Values& values) {
  const SaturatingHardening curve{.yield_stress = values.number("yield_stress"),
                                  .saturation_stress = values.number("saturation_stress"),
                                  .saturation_strain = values.number("saturation_strain")};
  if (curve.saturation_stress < curve.yield_stress)
    throw InputError(fmt::format("{}: saturation_stress = {:g} MPa must not be below yield_stress = {:g} MPa",
                                 values.where("saturation_stress"), curve.saturation_stress, curve.yield_stress));
  return curve;
}

}  // namespace kerf::laws
