#include "models/chip/shear_minimised.hpp"

namespace kerf::chip {

namespace {

ChipPrediction predict(const Values& cut) {
  const double depth = cut.number("depth");
  const double rake = cut.number("rake");
  const double yield_stress = cut.number("yield_stress");
  const double toughness = cut.number("toughness");
  const double friction = cut.number("friction");
  if (!chip_can_slide(friction, rake)) return no_solution(locked_chip_reason());

  const auto plane = shear_minimised(depth, rake, yield_stress, toughness, friction, cut.number("adhesion_toughness"));
  const auto forces = with_bottom_force(plane.forces, cut.number("bottom_force"), friction);

  ChipPrediction prediction;
  prediction.F_c = forces.F_c;
  prediction.F_t = forces.F_t;
  prediction.shear_angle = std::atan2(yield_stress * depth, plane.forces.F_c - toughness);
  const double phi = *prediction.shear_angle;
  prediction.details = {
      {"chip_ratio", std::cos(phi - rake) / std::sin(phi), "1", "chip thickness / depth"},
      {"shear_strain", 1.0 / std::tan(phi) + std::tan(phi - rake), "1", "shear strain gamma on the shear plane"},
  };
  return prediction;
}

}  // namespace

ClosedForm shear_minimised_model() {
  return {"shear_minimised",
          "shear plane at the angle of least force, Eqs. (3) and (4)",
          {keys::depth(), keys::rake(), keys::yield_stress(), keys::toughness(), keys::friction(),
           keys::adhesion_toughness(), keys::bottom_force()},
          predict};
}

}  // namespace kerf::chip
