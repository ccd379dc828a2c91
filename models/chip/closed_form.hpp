#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/parameter.hpp"

namespace kerf::chip {

/// What a closed form says about one cut. Forces per width of cut in N/mm, angles in rad.
struct ChipPrediction {
  double F_c = std::numeric_limits<double>::quiet_NaN();  ///< cutting force
  double F_t = std::numeric_limits<double>::quiet_NaN();  ///< transverse force, positive pushes the tool away
  std::optional<double> shear_angle;                      ///< of the shear plane with the crack plane
  bool valid = true;                                      ///< false: the value stands outside the model's range
  std::string reason;                                     ///< why not valid, in words

  /// What else this model knows, in the order worth reading.
  struct Detail {
    std::string key;
    double value;      ///< consistent units
    std::string unit;  ///< to print it in
    std::string meaning;
  };
  std::vector<Detail> details;
  std::optional<bool> touching;  ///< does the tool's tip reach the crack tip? Only models with a chip shape know.
};

/// A model that needs no simulation: its name, its declared keys and its equations.
struct ClosedForm {
  std::string name;
  std::string meaning;
  std::vector<Parameter> parameters;
  ChipPrediction (*predict)(const Values&);
};

/// All closed forms. Adding one is a file with its equations and a line here.
const std::vector<ClosedForm>& closed_forms();

/// Null when there is no closed form of that name.
const ClosedForm* find_closed_form(std::string_view name);

/// Keys that mean the same in every model: declared once.
namespace keys {
Parameter depth();
Parameter rake();
Parameter yield_stress();
Parameter toughness();
Parameter friction();
Parameter adhesion_toughness();
Parameter bottom_force();
}  // namespace keys

/// A prediction without a value: the model's equations have no solution, `reason` says why.
ChipPrediction no_solution(std::string reason);

/// The reason given whenever chip_can_slide is false.
std::string locked_chip_reason();

}  // namespace kerf::chip
