#include "models/laws/traction_law.hpp"

#include "models/base/error.hpp"
#include "models/laws/cubic.hpp"
#include "models/laws/exponential.hpp"
#include "models/laws/linear_softening.hpp"
#include "models/laws/sawtooth.hpp"
#include "models/laws/trilinear.hpp"

namespace kerf::laws {

const std::vector<TractionLawKind>& traction_laws() {
  static const std::vector<TractionLawKind> laws{cubic(), exponential(), linear_softening(), sawtooth(), trilinear()};
  return laws;
}

std::unique_ptr<TractionLaw> make_traction_law(const Values& values) {
  for (const TractionLawKind& law : traction_laws())
    if (law.name == values.variant()) return law.make(values);
  throw InputError(values.where("law") + ": no cohesive law is called '" + values.variant() + "'");
}

}  // namespace kerf::laws
