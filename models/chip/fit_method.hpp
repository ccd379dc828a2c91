#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/chip/least_squares.hpp"
#include "models/chip/measured_cut.hpp"

namespace kerf::chip {

/// What a fit may need to know beside the forces.
struct FitOptions {
  std::optional<double> elastic_modulus;  ///< MPa; plastic_bending needs it
  double poisson_ratio = 0.33;
  double hardening_ratio = 0.0;
  double root_rotation = 2.0 / 3.0;
  bool plane_strain = true;
};

/// Forces of a fitted model at one cut, N/mm; F_t only from methods that speak about it.
struct FittedForces {
  double depth = 0.0;  ///< mm
  double rake = 0.0;   ///< rad
  double F_c = 0.0;
  std::optional<double> F_t;
};

/// One way to a toughness, applied to one measured curve.
struct MethodResult {
  std::string method;
  std::string meaning;
  std::string not_applied;  ///< empty, or why these data do not suit the method; then nothing else is filled
  Fit fit;
  std::string out_of_range;          ///< empty, or why the model does not hold at the fitted parameters
  std::vector<FittedForces> points;  ///< at the measured cuts, in their order
  std::vector<FittedForces> curve;   ///< finely, from small depth to the largest, one rake after the other
  std::vector<std::string> warnings;
};

struct FitMethod {
  std::string name;
  std::string meaning;
  std::string (*unsuited)(const Measurements&, const FitOptions&);  ///< empty, or why the method cannot be applied
  MethodResult (*apply)(const Measurements&, const FitOptions&);    ///< fills fit, points, curve, warnings
};

/// All methods, in the order of a report. Adding one is a file with its residuals and a line here.
const std::vector<FitMethod>& fit_methods();
const FitMethod* find_fit_method(std::string_view name);

/// Applies one method, or says why not.
MethodResult apply(const FitMethod& method, const Measurements& measurements, const FitOptions& options);

// Families of methods.
std::vector<FitMethod> shear_minimised_methods();
FitMethod chip_force_method();
FitMethod plastic_bending_method();
std::vector<FitMethod> intercept_methods();

/// Depths and rakes at which to draw a fitted curve.
std::vector<FittedForces> drawing_cuts(const Measurements& measurements);

}  // namespace kerf::chip
