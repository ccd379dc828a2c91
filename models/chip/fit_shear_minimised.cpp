#include <algorithm>
#include <cmath>

#include "models/chip/fit_method.hpp"
#include "models/chip/friction_line.hpp"
#include "models/chip/shear_minimised.hpp"

namespace kerf::chip {

namespace {

// Fits of Eqs. (3) and (4) to both forces at once. What the friction line leaves at zero cutting force may be adhesion
// to the rake face, or a force on the tool's edge and bottom of which F_c has a share that nothing else measures: each
// assumption is a method of its own, so that a report can show how much of the toughness rests on it.
// One of them is also held against the chip's thickness, which the others leave alone.
enum class Offset { none, adhesion, edge_with_friction, edge_without_drag, edge_with_free_drag, edge_and_chip_ratio };

constexpr bool drags_with_friction(Offset offset) {
  return offset == Offset::edge_with_friction || offset == Offset::edge_and_chip_ratio;
}

constexpr int unknowns_of(Offset offset) {
  return offset == Offset::none ? 3 : offset == Offset::edge_with_free_drag ? 5 : 4;
}

template <Offset offset, class T>
std::optional<ToolForces<T>> predict(double depth, double rake, const T* unknowns) {
  const T& toughness = unknowns[0];
  const T& yield_stress = unknowns[1];
  const T& friction = unknowns[2];
  if (!chip_can_slide(friction, rake)) return {};
  T adhesion(0.0);
  if constexpr (offset == Offset::adhesion) adhesion = unknowns[3];
  const auto plane = shear_minimised(depth, rake, yield_stress, toughness, friction, adhesion);
  if (depth > 0.0 && plane.radicand <= 0.0) return {};
  auto forces = plane.forces;
  if constexpr (drags_with_friction(offset)) forces = with_bottom_force(forces, unknowns[3], friction);
  if constexpr (offset == Offset::edge_without_drag) forces.F_t += unknowns[3];
  if constexpr (offset == Offset::edge_with_free_drag) {
    forces.F_t += unknowns[3];
    forces.F_c += unknowns[4];
  }
  return forces;
}

template <Offset offset>
struct Residuals {
  const Measurements* measurements;

  template <class T>
  bool operator()(const T* unknowns, T* residuals) const {
    for (const auto& cut : measurements->cuts()) {
      const auto forces = predict<offset>(cut.depth, cut.rake, unknowns);
      if (!forces) return false;
      *residuals++ = (forces->F_c - cut.F_c) / measurements->F_c_error(cut);
      *residuals++ = (forces->F_t - *cut.F_t) / measurements->F_t_error(cut);
      if constexpr (offset == Offset::edge_and_chip_ratio) {
        const T drag = unknowns[2] * unknowns[3];
        const T cot_phi = (forces->F_c - drag - unknowns[0]) / (unknowns[1] * cut.depth);
        const T chip_ratio = std::cos(cut.rake) * cot_phi + std::sin(cut.rake);
        *residuals++ = (chip_ratio - *cut.chip_ratio) / *cut.chip_ratio_error;
      }
    }
    return true;
  }
};

template <Offset offset>
std::vector<Unknown> unknowns() {
  std::vector<Unknown> all = {{.name = "toughness", .unit = "J/m^2"},
                              {.name = "yield_stress", .unit = "MPa", .lower = 1e-9},
                              {.name = "friction", .unit = "1", .lower = -5.0, .upper = 20.0}};
  if constexpr (offset == Offset::adhesion) {
    all.push_back({.name = "adhesion_toughness", .unit = "J/m^2"});
  } else if constexpr (offset != Offset::none) {
    all.push_back({.name = "bottom_force", .unit = "N/mm"});
    if constexpr (offset == Offset::edge_with_free_drag) {
      // A drag of either sign could stand for any toughness: only what is physical bounds this fit.
      all.push_back({.name = "bottom_drag", .unit = "N/mm"});
      for (const std::size_t i : {0U, 3U, 4U}) all[i].lower = 0.0;
    }
  }
  return all;
}

/// Slopes of both forces give friction; the toughness is tried from next to nothing to nearly all of the least force.
template <Offset offset>
std::vector<std::vector<double>> starts(const Measurements& measurements) {
  const auto& cuts = measurements.cuts();
  const auto by_force = [](const MeasuredCut& a, const MeasuredCut& b) { return a.F_c < b.F_c; };
  const auto& least = *std::min_element(cuts.begin(), cuts.end(), by_force);
  const auto& most = *std::max_element(cuts.begin(), cuts.end(), by_force);
  const double rake = most.rake;

  std::vector<double> slopes = {*most.F_t / most.F_c};
  double offset_force = 0.0;
  if (const auto lines = friction_lines(measurements); !lines.empty() && offset != Offset::none) {
    slopes.push_back(lines.back().slope.value);
    offset_force = lines.back().intercept.value;
  }
  std::vector<std::vector<double>> all;
  for (const double slope : slopes) {
    double friction = friction_from_slope(slope, rake);
    if (!chip_can_slide(friction, rake) || std::abs(friction) > 4.0) friction = 0.3;
    for (const double share : {0.02, 0.2, 0.5, 0.9}) {
      const double toughness = share * least.F_c;
      const double cot_phi = slope + std::sqrt(1.0 + slope * slope);
      const double yield_stress = std::max((most.F_c - toughness) / (most.depth * cot_phi), 1e-3);
      std::vector<double> start = {toughness, yield_stress, friction};
      if constexpr (offset != Offset::none) start.push_back(std::max(offset_force, 0.0));
      if constexpr (offset == Offset::edge_with_free_drag) start.push_back(0.0);
      all.push_back(std::move(start));
    }
  }
  return all;
}

std::string unsuited(const Measurements& measurements, const FitOptions&) {
  return measurements.has_F_t() ? "" : "needs the transverse force of every cut";
}

std::string unsuited_chip_ratio(const Measurements& measurements, const FitOptions&) {
  if (!measurements.has_F_t()) return "needs the transverse force of every cut";
  for (const auto& cut : measurements.cuts()) {
    if (!cut.chip_ratio || cut.chip_ratio_error.value_or(0.0) <= 0.0 || !measurements.errors_known()) {
      return "needs chip ratio and forces with standard deviations: they have no common scale otherwise";
    }
  }
  return "";
}

template <Offset offset>
MethodResult fit(const Measurements& measurements, const FitOptions&) {
  MethodResult result;
  constexpr int kinds = offset == Offset::edge_and_chip_ratio ? 3 : 2;  // F_c, F_t and perhaps the chip ratio
  result.fit = solve(
      {.unknowns = unknowns<offset>(),
       .residuals = residual_block<unknowns_of(offset)>(Residuals<offset>{&measurements}, kinds * measurements.size()),
       .starts = starts<offset>(measurements),
       .noise = measurements.noise(kinds)});
  if (!result.fit.converged) return result;
  const auto add = [&](std::vector<FittedForces>& to, double depth, double rake) {
    if (const auto forces = predict<offset>(depth, rake, result.fit.values.data())) {
      to.push_back({depth, rake, forces->F_c, forces->F_t});
    }
  };
  for (const auto& cut : measurements.cuts()) add(result.points, cut.depth, cut.rake);
  for (const auto& cut : drawing_cuts(measurements)) add(result.curve, cut.depth, cut.rake);
  return result;
}

}  // namespace

std::vector<FitMethod> shear_minimised_methods() {
  return {
      {"shear_minimised", "Eqs. (3) and (4): friction T = G_a + mu N on the rake face", unsuited,
       fit<Offset::adhesion>},
      {"shear_minimised_coulomb", "Eqs. (3) and (4) without adhesion or edge force", unsuited, fit<Offset::none>},
      {"shear_minimised_edge", "Eqs. (1) and (4): edge force F_b with Coulomb drag mu F_b", unsuited,
       fit<Offset::edge_with_friction>},
      {"shear_minimised_edge_no_drag", "Eq. (4) with an edge force F_b that adds nothing to F_c", unsuited,
       fit<Offset::edge_without_drag>},
      {"shear_minimised_edge_free_drag", "Eq. (4) with an edge force F_b and a drag of its own in F_c", unsuited,
       fit<Offset::edge_with_free_drag>},
      {"shear_minimised_edge_chip_ratio", "shear_minimised_edge held against the chip ratio as well",
       unsuited_chip_ratio, fit<Offset::edge_and_chip_ratio>},
  };
}

}  // namespace kerf::chip
