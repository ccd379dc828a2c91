#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/chip/fit_method.hpp"
#include "models/chip/plastic_bending.hpp"

namespace kerf::chip {

namespace {

// Fit of Eqs. (5) and (6) to both forces. The root's curvature is found in plain numbers; one Newton step in dual
// numbers then carries its exact derivatives (implicit function theorem).

template <class T>
BendingChip<T> chip_of(double depth, double rake, const T* unknowns, const FitOptions& options) {
  return {.depth = depth,
          .rake = rake,
          .yield_stress = unknowns[1] * plane_yield_stress_factor(options.plane_strain),
          .toughness = unknowns[0],
          .friction = unknowns[2],
          .modulus = plane_modulus(*options.elastic_modulus, options.poisson_ratio, options.plane_strain),
          .hardening = options.hardening_ratio,
          .root_rotation = options.root_rotation};
}

std::optional<double> solve_root(const BendingChip<double>& chip) {
  if (chip.toughness <= 0.0 || chip.projection(chip.turn()) <= 0.0) return {};
  return root_curvature(chip);
}

struct Residuals {
  const Measurements* measurements;
  FitOptions options;

  bool operator()(const double* unknowns, double* residuals) const {
    return fill(
        unknowns, residuals, [](const BendingChip<double>&, double k) { return k; }, unknowns);
  }

  template <class T>
  bool operator()(const T* unknowns, T* residuals) const {
    const double plain[] = {unknowns[0].a, unknowns[1].a, unknowns[2].a};
    const auto with_derivatives = [](const BendingChip<T>& chip, double k) {
      using Along = ceres::Jet<double, 1>;
      const BendingChip<Along> frozen{
          chip.depth,   chip.rake,      Along(chip.yield_stress.a), Along(chip.toughness.a), Along(chip.friction.a),
          chip.modulus, chip.hardening, chip.root_rotation};
      const double slope = frozen.imbalance(Along(k, 0)).v[0];
      return T(k) - chip.imbalance(T(k)) / slope;
    };
    return fill(unknowns, residuals, with_derivatives, plain);
  }

 private:
  template <class T, class Curvature>
  bool fill(const T* unknowns, T* residuals, const Curvature& curvature, const double* plain) const {
    for (const auto& cut : measurements->cuts()) {
      const auto k = solve_root(chip_of(cut.depth, cut.rake, plain, options));
      if (!k) return false;
      const auto chip = chip_of(cut.depth, cut.rake, unknowns, options);
      const auto forces = chip.forces(curvature(chip, *k));
      *residuals++ = (forces.F_c - cut.F_c) / measurements->F_c_error(cut);
      *residuals++ = (forces.F_t - *cut.F_t) / measurements->F_t_error(cut);
    }
    return true;
  }
};

std::string unsuited(const Measurements& measurements, const FitOptions& options) {
  if (!options.elastic_modulus) return "needs the elastic modulus (--elastic-modulus)";
  if (!measurements.has_F_t()) return "needs the transverse force of every cut";
  return "";
}

MethodResult fit(const Measurements& measurements, const FitOptions& options) {
  const auto by_force = [](const MeasuredCut& a, const MeasuredCut& b) { return a.F_c < b.F_c; };
  const auto [least, most] = std::minmax_element(measurements.cuts().begin(), measurements.cuts().end(), by_force);
  const double friction = friction_from_slope(*most->F_t / most->F_c, most->rake);
  std::vector<std::vector<double>> starts;
  for (const double share : {0.05, 0.3, 0.7, 0.95}) {
    for (const double stress : {0.1, 1.0, 10.0}) {
      starts.push_back({share * least->F_c, stress * most->F_c / most->depth, friction});
    }
  }
  MethodResult result;
  result.fit = solve({.unknowns = {{.name = "toughness", .unit = "J/m^2"},
                                   {.name = "yield_stress", .unit = "MPa", .lower = 1e-9},
                                   {.name = "friction", .unit = "1", .lower = -5.0, .upper = 20.0}},
                      .residuals = residual_block<3>(Residuals{&measurements, options}, 2 * measurements.size()),
                      .starts = std::move(starts),
                      .noise = measurements.noise(2)});
  if (!result.fit.converged) return result;

  const double* unknowns = result.fit.values.data();
  const auto add = [&](std::vector<FittedForces>& to, double depth, double rake) {
    const auto chip = chip_of(depth, rake, unknowns, options);
    if (const auto k = solve_root(chip)) {
      const auto forces = chip.forces(*k);
      to.push_back({depth, rake, forces.F_c, forces.F_t});
    }
  };
  for (const auto& cut : measurements.cuts()) {
    add(result.points, cut.depth, cut.rake);
    const auto chip = chip_of(cut.depth, cut.rake, unknowns, options);
    const auto k = solve_root(chip);
    if (!result.out_of_range.empty() || !k) continue;
    if (const auto reason = out_of_bending_range(chip, *k); !reason.empty()) {
      result.out_of_range = fmt::format("at depth {:.4g} mm the {}", cut.depth, reason);
    }
  }
  for (const auto& cut : drawing_cuts(measurements)) {
    if (cut.depth > 0.0) add(result.curve, cut.depth, cut.rake);
  }
  return result;
}

}  // namespace

FitMethod plastic_bending_method() {
  return {"plastic_bending", "Eqs. (5) and (6): the chip bends ahead of the tool's tip", unsuited, fit};
}

}  // namespace kerf::chip
