#include "models/laws/sawtooth.hpp"

namespace kerf::laws {

TractionLawKind sawtooth() {
  return {
      .name = "sawtooth",
      .meaning = "triangular traction law: straight up to its strength, straight down to the critical opening",
      .parameters = {number("strength", "MPa", 1e-4, 1e5, "largest cohesive traction sigma_c"),
                     number("toughness", "J/m^2", 1e-3, 1e7, "area under the law G_c"),
                     number("peak", "1", 1e-3, 0.999, "opening at the peak as a share of the critical opening delta_c")
                         .or_else("0.1")},
      .make = [](const Values& values) -> std::unique_ptr<TractionLaw> {
        return std::make_unique<Sawtooth>(values.number("strength"), values.number("toughness"), values.number("peak"));
      }};
}

}  // namespace kerf::laws
