#include "models/laws/ideal_gas.hpp"

namespace kerf::laws {

std::vector<Parameter> IdealGas::parameters() {
  return {
      number("pressure", "MPa", 1e-6, 1e4, "pressure p_0 of the reference state"),
      number("reference_temperature", "K", 1.0, 1e5, "temperature T_0 of the reference state"),
      number("heat_ratio", "1", 1.01, 2.0, "ratio gamma of the heat capacities"),
      number("density", "kg/m^3", 1e-4, 1e4, "mass density of the reference state"),
      number("temperature", "K", 1.0, 1e5, "temperature at the start; absent: that of the reference state").if_given()};
}

IdealGas IdealGas::from(const Values& values) {
  return {.pressure = values.number("pressure"),
          .reference = values.number("reference_temperature"),
          .heat_ratio = values.number("heat_ratio"),
          .density = values.number("density")};
}

}  // namespace kerf::laws
