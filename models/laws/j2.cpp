#include "models/laws/j2.hpp"

namespace kerf::laws {

template <class Hardening>
Block J2<Hardening>::block() {
  std::vector<Parameter> parameters{number("elastic_modulus", "MPa", 1e-2, 2e6, "Young's modulus E"),
                                    number("poisson_ratio", "1", 0.0, 0.495, "Poisson's ratio nu"),
                                    number("density", "kg/m^3", 1.0, 3e4, "mass density rho")};
  for (Parameter& parameter : Hardening::parameters()) parameters.push_back(std::move(parameter));
  return {.path = "material",
          .variant = std::string("j2") + Hardening::suffix,
          .meaning = std::string("isotropic elastic, von Mises plastic with ") + Hardening::meaning + ", plane strain",
          .parameters = std::move(parameters),
          .required = true};
}

template <class Hardening>
J2<Hardening> J2<Hardening>::from(const Values& values) {
  return {.elastic_modulus = values.number("elastic_modulus"),
          .poisson_ratio = values.number("poisson_ratio"),
          .density = values.number("density"),
          .hardening = Hardening::from(values)};
}

template struct J2<LinearHardening>;
template struct J2<PowerHardening>;
template struct J2<SaturatingHardening>;

}  // namespace kerf::laws
