#include "inverse/closed_form_cut.hpp"

#include <cmath>

#include "models/chip/shear_minimised.hpp"

namespace kerf::inverse {

forward::CutResult closed_form_cut(const forward::Scene& scene) {
  forward::CutResult result;
  const double yield_stress = std::sqrt(3.0) * laws::shear_yield(scene.material);
  if (!std::isfinite(yield_stress) || !scene.cohesive.mode_I) {
    result.refusals = {"the closed form wants a yield stress and a toughness"};
    return result;
  }
  const double toughness = scene.cohesive.mode_I->toughness();
  const double friction = scene.friction ? scene.friction->coefficient : 0;
  const double depth = scene.cut.depth, rake = scene.tool.rake;
  const auto plane = chip::shear_minimised(depth, rake, yield_stress, toughness, friction, 0.0);
  if (plane.radicand < 0) {
    result.refusals = {"the closed form has no solution here"};
    return result;
  }
  result.F_c.value = plane.forces.F_c;
  result.F_t.value = plane.forces.F_t;
  const double cot_phi = (plane.forces.F_c - toughness) / (yield_stress * depth);  // Eq. (4)
  result.chip_ratio.value = std::cos(rake) * cot_phi + std::sin(rake);
  result.steady = result.accepted = true;
  return result;
}

}  // namespace kerf::inverse
