#include "models/laws/linear_softening.hpp"

namespace kerf::laws {

TractionLawKind linear_softening() {
  return {.name = "linear_softening",
          .meaning = "bridging traction law: its full stress almost at once, then a straight loss",
          .parameters = {number("strength", "MPa", 1e-4, 1e5, "bridging stress sigma_b at small opening"),
                         number("toughness", "J/m^2", 1e-3, 1e7, "area under the law G_b"),
                         number("rise", "1", 1e-4, 0.1,
                                "share of the critical opening over which the stress comes up; bounds the stiffness")
                             .or_else("0.02")},
          .make = [](const Values& values) -> std::unique_ptr<TractionLaw> {
            return std::make_unique<LinearSoftening>(values.number("strength"), values.number("toughness"),
                                                     values.number("rise"));
          }};
}

}  // namespace kerf::laws
