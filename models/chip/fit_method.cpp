#include "models/chip/fit_method.hpp"

#include <algorithm>

namespace kerf::chip {

const std::vector<FitMethod>& fit_methods() {
  static const std::vector<FitMethod> all = [] {
    std::vector<FitMethod> methods = shear_minimised_methods();
    methods.push_back(chip_force_method());
    methods.push_back(plastic_bending_method());
    for (auto& method : intercept_methods()) methods.push_back(std::move(method));
    return methods;
  }();
  return all;
}

const FitMethod* find_fit_method(std::string_view name) {
  const auto& all = fit_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const FitMethod& method) { return method.name == name; });
  return found == all.end() ? nullptr : &*found;
}

MethodResult apply(const FitMethod& method, const Measurements& measurements, const FitOptions& options) {
  MethodResult result;
  result.not_applied = method.unsuited(measurements, options);
  if (result.not_applied.empty()) result = method.apply(measurements, options);
  result.method = method.name;
  result.meaning = method.meaning;
  return result;
}

std::vector<FittedForces> drawing_cuts(const Measurements& measurements) {
  constexpr int steps = 48;
  const double deepest = 1.05 * measurements.depths().back();
  std::vector<FittedForces> cuts;
  for (const double rake : measurements.rakes()) {
    for (int i = 0; i <= steps; ++i) {
      // Dense near zero, where a square root needs it.
      const double part = static_cast<double>(i) / steps;
      cuts.push_back({deepest * part * part, rake, 0.0, {}});
    }
  }
  return cuts;
}

}  // namespace kerf::chip
