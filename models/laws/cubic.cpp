#include "models/laws/cubic.hpp"

namespace kerf::laws {

TractionLawKind cubic() {
  return {.name = "cubic",
          .meaning = "smooth traction law: rises to its strength at a third of the critical opening",
          .parameters = {number("strength", "MPa", 1e-4, 1e5, "largest cohesive traction sigma_c"),
                         number("toughness", "J/m^2", 1e-3, 1e7, "area under the law G_c")},
          .make = [](const Values& values) -> std::unique_ptr<TractionLaw> {
            return std::make_unique<Cubic>(values.number("strength"), values.number("toughness"));
          }};
}

}  // namespace kerf::laws
