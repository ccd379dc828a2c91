#include "models/laws/j2.hpp"

namespace kerf::laws {

Block J2::block() {
  return {.path = "material",
          .variant = "j2",
          .meaning = "isotropic elastic, von Mises plastic with linear hardening, plane strain",
          .parameters = {number("elastic_modulus", "MPa", 1e-2, 2e6, "Young's modulus E"),
                         number("poisson_ratio", "1", 0.0, 0.495, "Poisson's ratio nu"),
                         number("density", "kg/m^3", 1.0, 3e4, "mass density rho"),
                         number("yield_stress", "MPa", 1e-4, 1e5, "uniaxial yield stress sigma_y"),
                         number("hardening_modulus", "MPa", 0.0, 1e6, "slope of yield stress against plastic strain H")
                             .or_else("0 MPa")},
          .required = true};
}

J2 J2::from(const Values& values) {
  return {.elastic_modulus = values.number("elastic_modulus"),
          .poisson_ratio = values.number("poisson_ratio"),
          .density = values.number("density"),
          .yield_stress = values.number("yield_stress"),
          .hardening_modulus = values.number("hardening_modulus")};
}

}  // namespace kerf::laws
