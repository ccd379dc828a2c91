#include <cmath>

#include "models/chip/chip_force.hpp"
#include "models/chip/fit_method.hpp"

namespace kerf::chip {

namespace {

// Eq. (2), linear in sigma_y and G_c, with the shear angle of each cut from its chip thickness. Its error has three
// sources, F_c, F_t and the angle; the last one's weight depends on the parameters, so the fit is repeated with the
// weights of the one before until they settle.

struct Balance {
  double angle;  ///< phi
  double force;  ///< F_c cos phi - F_t sin phi
  double shear;  ///< factor of sigma_y
  double crack;  ///< factor of G_c
  double error;  ///< standard error of the equation
};

struct Residuals {
  std::vector<Balance> balances;

  template <class T>
  bool operator()(const T* unknowns, T* residuals) const {
    for (const auto& balance : balances) {
      *residuals++ = (unknowns[0] * balance.crack + unknowns[1] * balance.shear - balance.force) / balance.error;
    }
    return true;
  }
};

Balance balance(const Measurements& all, const MeasuredCut& cut, double toughness, double yield_stress) {
  const double phi = shear_angle_from_chip_ratio(*cut.chip_ratio, cut.rake);
  const double s = std::sin(phi);
  const double c = std::cos(phi);
  const double tan_rake = std::tan(cut.rake);
  Balance result{.angle = phi,
                 .force = cut.F_c * c - *cut.F_t * s,
                 .shear = cut.depth / (2.0 * s),
                 .crack = c + tan_rake * s,
                 .error = std::hypot(c * all.F_c_error(cut), s * all.F_t_error(cut))};
  if (all.errors_known() && cut.chip_ratio_error) {
    const double run = *cut.chip_ratio - std::sin(cut.rake);
    const double angle_per_ratio = std::cos(cut.rake) / (std::pow(std::cos(cut.rake), 2) + run * run);
    const double per_angle =
        -cut.F_c * s - *cut.F_t * c + yield_stress * cut.depth * c / (2.0 * s * s) + toughness * (s - tan_rake * c);
    result.error = std::hypot(result.error, per_angle * angle_per_ratio * *cut.chip_ratio_error);
  }
  return result;
}

std::string unsuited(const Measurements& measurements, const FitOptions&) {
  if (!measurements.has_F_t()) return "needs the transverse force of every cut";
  if (!measurements.has_chip_ratio()) return "needs the chip ratio of every cut: it gives the shear angle";
  return "";
}

MethodResult fit(const Measurements& measurements, const FitOptions&) {
  MethodResult result;
  double toughness = 0.0;
  double yield_stress = 0.0;
  Residuals equations;
  constexpr int passes = 30;
  for (int pass = 0; pass < passes; ++pass) {
    equations.balances.clear();
    for (const auto& cut : measurements.cuts()) {
      equations.balances.push_back(balance(measurements, cut, toughness, yield_stress));
    }
    const LeastSquares problem{
        .unknowns = {{.name = "toughness", .unit = "J/m^2"}, {.name = "yield_stress", .unit = "MPa"}},
        .residuals = residual_block<2>(equations, measurements.size()),
        .starts = {{toughness, yield_stress}},
        .noise = measurements.noise(2)};
    result.fit = solve(problem);
    if (!result.fit.converged) return result;
    const double change = std::abs(result.fit.values[1] - yield_stress);
    toughness = result.fit.values[0];
    yield_stress = result.fit.values[1];
    if (change <= 1e-9 * std::abs(yield_stress)) break;
  }

  for (int i = 0; i < measurements.size(); ++i) {
    const auto& cut = measurements.cuts()[static_cast<std::size_t>(i)];
    const auto& equation = equations.balances[static_cast<std::size_t>(i)];
    // The method knows F_c only beside the measured F_t and angle.
    const double force = toughness * equation.crack + yield_stress * equation.shear;
    const double F_c = (force + *cut.F_t * std::sin(equation.angle)) / std::cos(equation.angle);
    result.points.push_back({cut.depth, cut.rake, F_c, *cut.F_t});
  }
  if (measurements.errors_known() && !measurements.cuts().front().chip_ratio_error) {
    result.warnings.push_back("the chip ratio has no standard deviation: the shear angle counts as exact");
  }
  return result;
}

}  // namespace

FitMethod chip_force_method() {
  return {"chip_force", "Eq. (2): balance of forces with the shear angle from the chip ratio", unsuited, fit};
}

}  // namespace kerf::chip
