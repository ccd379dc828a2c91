#include "models/chip/chip_force.hpp"

#include <algorithm>
#include <numbers>

namespace kerf::chip {

namespace {

ChipPrediction predict(const Values& cut) {
  const double rake = cut.number("rake");
  const double phi = cut.number("shear_angle");
  const double friction = cut.number("friction");
  if (!chip_can_slide(friction, rake)) return no_solution(locked_chip_reason());
  if (1.0 / std::tan(phi) <= force_slope(friction, rake)) {
    return no_solution("at this shear angle friction holds the chip: cot(shear_angle) must exceed F_t/F_c");
  }
  const auto chip = chip_force(cut.number("depth"), rake, phi, cut.number("yield_stress"), cut.number("toughness"),
                               friction, cut.number("adhesion_toughness"));
  const auto forces = with_bottom_force(chip, cut.number("bottom_force"), friction);

  ChipPrediction prediction;
  prediction.F_c = forces.F_c;
  prediction.F_t = forces.F_t;
  prediction.shear_angle = phi;
  if (phi >= std::numbers::pi / 2 + std::min(rake, 0.0)) {
    prediction.valid = false;
    prediction.reason = "the shear plane lies behind the rake face";
  }
  prediction.details = {
      {"chip_ratio", std::cos(phi - rake) / std::sin(phi), "1", "chip thickness / depth"},
      {"shear_strain", 1.0 / std::tan(phi) + std::tan(phi - rake), "1", "shear strain gamma on the shear plane"},
  };
  return prediction;
}

}  // namespace

ClosedForm chip_force_model() {
  return {"chip_force",
          "balance of forces on a chip whose shear angle was measured, Eq. (2)",
          {keys::depth(), keys::rake(), keys::yield_stress(), keys::toughness(), keys::friction(),
           keys::adhesion_toughness(), keys::bottom_force(),
           number("shear_angle", "deg", 0.01, 89.99, "measured angle phi of the shear plane")},
          predict};
}

}  // namespace kerf::chip
