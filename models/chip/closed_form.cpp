#include "models/chip/closed_form.hpp"

#include <algorithm>

#include "models/chip/atkins.hpp"
#include "models/chip/chip_force.hpp"
#include "models/chip/cohesive_beam.hpp"
#include "models/chip/plastic_bending.hpp"
#include "models/chip/shear_minimised.hpp"

namespace kerf::chip {

const std::vector<ClosedForm>& closed_forms() {
  static const std::vector<ClosedForm> all = {
      chip_force_model(), shear_minimised_model(), atkins_model(), plastic_bending_model(), cohesive_beam_model(),
  };
  return all;
}

const ClosedForm* find_closed_form(std::string_view name) {
  const auto& all = closed_forms();
  const auto found = std::find_if(all.begin(), all.end(), [&](const ClosedForm& form) { return form.name == name; });
  return found == all.end() ? nullptr : &*found;
}

namespace keys {

Parameter depth() {
  return number("depth", "mm", 1e-6, 1e3, "depth of cut h");
}
Parameter rake() {
  return number("rake", "deg", -60, 85, "rake angle alpha, from the normal of the crack plane");
}
Parameter yield_stress() {
  return number("yield_stress", "MPa", 1e-6, 1e6, "yield stress sigma_y");
}
Parameter toughness() {
  return number("toughness", "J/m^2", 0, 1e9, "fracture toughness G_c");
}
Parameter friction() {
  return number("friction", "1", 0, 10, "Coulomb friction mu of chip on rake face").or_else("0");
}
Parameter adhesion_toughness() {
  return number("adhesion_toughness", "J/m^2", 0, 1e9, "adhesion G_a of the chip to the rake face").or_else("0 J/m^2");
}
Parameter bottom_force() {
  return number("bottom_force", "N/mm", 0, 1e6, "normal force per width F_b on the tool's bottom").or_else("0 N/mm");
}

}  // namespace keys

ChipPrediction no_solution(std::string reason) {
  ChipPrediction prediction;
  prediction.valid = false;
  prediction.reason = std::move(reason);
  return prediction;
}

std::string locked_chip_reason() {
  return "friction locks the chip to the rake face (cos(rake) + friction sin(rake) <= 0): no force moves the tool";
}

}  // namespace kerf::chip
