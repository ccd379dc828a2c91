#include "models/laws/exponential.hpp"

namespace kerf::laws {

TractionLawKind exponential() {
  return {.name = "exponential",
          .meaning = "smooth traction law with a long tail that ends at 7.2 times the opening of its peak",
          .parameters = {number("strength", "MPa", 1e-4, 1e5, "largest cohesive traction sigma_c"),
                         number("toughness", "J/m^2", 1e-3, 1e7, "area under the law G_c, tail included")},
          .make = [](const Values& values) -> std::unique_ptr<TractionLaw> {
            return std::make_unique<Exponential>(values.number("strength"), values.number("toughness"));
          }};
}

}  // namespace kerf::laws
