#include <algorithm>
#include <cmath>

#include "models/chip/fit_method.hpp"
#include "models/chip/friction_line.hpp"
#include "models/chip/shear_minimised.hpp"

namespace kerf::chip {

namespace {

// The cutting force extrapolated to zero depth, as papers do it, whose intercept is taken for the toughness: along a
// straight line, a parabola, an exponential, and along Eq. (4), which knows that the last part is a square root.

/// F_c(h) of one shape with N unknowns; the first is the intercept.
struct Line {
  static constexpr int unknowns = 2;
  template <class T>
  static T force(double depth, double, const T* p) {
    return p[0] + p[1] * depth;
  }
};

struct Parabola {
  static constexpr int unknowns = 3;
  template <class T>
  static T force(double depth, double, const T* p) {
    return p[0] + (p[1] + p[2] * depth) * depth;
  }
};

struct Exponential {
  static constexpr int unknowns = 2;
  template <class T>
  static T force(double depth, double, const T* p) {
    using std::exp;
    return p[0] * exp(p[1] * depth);
  }
};

/// Eq. (4) in terms of the friction line F_t = Z F_c + g: unknowns G_c, sigma_y, Z and g.
struct SquareRoot {
  static constexpr int unknowns = 4;
  template <class T>
  static T force(double depth, double rake, const T* p) {
    using std::sqrt;
    const T shear = p[1] * depth;
    const T radicand = shear * shear * (1.0 + p[2] * p[2]) + 2.0 * shear * (p[3] + p[0] * (p[2] + std::tan(rake)));
    if (depth == 0.0) return p[0];
    return p[0] + shear * p[2] + sqrt(radicand);  // NaN beyond its domain: the fit turns back
  }
};

/// Eq. (4) without a transverse force: unknowns G_c, sigma_y, mu; no adhesion.
struct SquareRootFromForce {
  static constexpr int unknowns = 3;
  template <class T>
  static T force(double depth, double rake, const T* p) {
    return shear_minimised(depth, rake, p[1], p[0], p[2], T(0.0)).forces.F_c;
  }
};

template <class Shape>
struct Residuals {
  const Measurements* measurements;
  std::optional<FrictionLine> line;  ///< what is known of the last two unknowns, for SquareRoot

  template <class T>
  bool operator()(const T* unknowns, T* residuals) const {
    using std::isfinite;
    for (const auto& cut : measurements->cuts()) {
      const T force = Shape::force(cut.depth, cut.rake, unknowns);
      if (!isfinite(force)) return false;
      *residuals++ = (force - cut.F_c) / measurements->F_c_error(cut);
    }
    if (line) {
      const T slope = unknowns[Shape::unknowns - 2] - line->slope.value;
      const T offset = unknowns[Shape::unknowns - 1] - line->intercept.value;
      const auto& root = line->information_root;
      *residuals++ = root(0, 0) * slope + root(0, 1) * offset;
      *residuals++ = root(1, 1) * offset;
    }
    return true;
  }
};

template <class Shape>
MethodResult extrapolate(const Measurements& measurements, const std::vector<Unknown>& unknowns,
                         const std::vector<std::vector<double>>& starts, const std::optional<FrictionLine>& line = {}) {
  MethodResult result;
  const int nuisances = line ? 2 : 0;
  result.fit = solve({.unknowns = unknowns,
                      .residuals = residual_block<Shape::unknowns>(Residuals<Shape>{&measurements, line},
                                                                   measurements.size() + nuisances),
                      .starts = starts,
                      .noise = measurements.noise(1),
                      .nuisances = nuisances});
  if (!result.fit.converged) return result;
  const auto add = [&](std::vector<FittedForces>& to, double depth, double rake) {
    to.push_back({depth, rake, Shape::force(depth, rake, result.fit.values.data()), {}});
  };
  for (const auto& cut : measurements.cuts()) add(result.points, cut.depth, cut.rake);
  for (const auto& cut : drawing_cuts(measurements)) add(result.curve, cut.depth, cut.rake);
  return result;
}

struct Ends {
  double depth_low, force_low, depth_high, force_high;
  double slope() const { return (force_high - force_low) / (depth_high - depth_low); }
  double intercept() const { return force_low - slope() * depth_low; }
};

Ends ends_of(const Measurements& measurements) {
  const auto by_depth = [](const MeasuredCut& a, const MeasuredCut& b) { return a.depth < b.depth; };
  const auto [low, high] = std::minmax_element(measurements.cuts().begin(), measurements.cuts().end(), by_depth);
  return {low->depth, low->F_c, high->depth, high->F_c};
}

const Unknown toughness{.name = "toughness", .unit = "J/m^2"};
const Unknown slope{.name = "slope", .unit = "MPa", .positive = false};

MethodResult fit_line(const Measurements& measurements, const FitOptions&) {
  const auto ends = ends_of(measurements);
  return extrapolate<Line>(measurements, {toughness, slope}, {{ends.intercept(), ends.slope()}});
}

MethodResult fit_parabola(const Measurements& measurements, const FitOptions&) {
  const auto ends = ends_of(measurements);
  return extrapolate<Parabola>(measurements,
                               {toughness, slope, {.name = "curvature", .unit = "MPa/mm", .positive = false}},
                               {{ends.intercept(), ends.slope(), 0.0}});
}

MethodResult fit_exponential(const Measurements& measurements, const FitOptions&) {
  const auto ends = ends_of(measurements);
  const double rate = ends.force_low > 0.0 && ends.force_high > 0.0
                          ? std::log(ends.force_high / ends.force_low) / (ends.depth_high - ends.depth_low)
                          : 0.0;
  return extrapolate<Exponential>(measurements, {toughness, {.name = "rate", .unit = "1/mm", .positive = false}},
                                  {{ends.force_low * std::exp(-rate * ends.depth_low), rate}});
}

MethodResult fit_model(const Measurements& measurements, const FitOptions&) {
  const auto ends = ends_of(measurements);
  const Unknown yield_stress{.name = "yield_stress", .unit = "MPa", .lower = 1e-9};
  const auto lines = friction_lines(measurements);
  std::vector<std::vector<double>> starts;
  for (const double share : {0.02, 0.2, 0.5, 0.9}) {
    const double start = share * ends.force_low;
    const double stress = std::max((ends.force_high - start) / ends.depth_high, 1e-3);
    if (lines.empty()) {
      for (const double friction : {0.0, 0.3, 1.0}) starts.push_back({start, stress, friction});
    } else {
      const double z = lines.front().slope.value;
      starts.push_back({start, stress / (z + std::sqrt(1.0 + z * z)), z, lines.front().intercept.value});
    }
  }
  if (lines.empty()) {
    auto result = extrapolate<SquareRootFromForce>(
        measurements, {toughness, yield_stress, {.name = "friction", .unit = "1", .lower = -0.9, .upper = 20.0}},
        starts);
    result.warnings.push_back("without a friction line the cutting force alone has to tell friction from toughness");
    return result;
  }
  return extrapolate<SquareRoot>(measurements,
                                 {toughness,
                                  yield_stress,
                                  {.name = "slope", .unit = "1", .positive = false},
                                  {.name = "offset", .unit = "N/mm", .positive = false}},
                                 starts, lines.front());
}

std::string unsuited(const Measurements& measurements, const FitOptions&) {
  if (measurements.depths().size() < 2) return "needs at least two depths of cut";
  if (measurements.rakes().size() > 1) return "needs one rake angle: an intercept pools what the rake tells apart";
  return "";
}

}  // namespace

std::vector<FitMethod> intercept_methods() {
  return {
      {"intercept_linear", "F_c extrapolated along a straight line", unsuited, fit_line},
      {"intercept_quadratic", "F_c extrapolated along a parabola", unsuited, fit_parabola},
      {"intercept_exponential", "F_c = A exp(k h)", unsuited, fit_exponential},
      {"intercept_model", "F_c along the square root of Eq. (4), friction from the friction line", unsuited, fit_model},
  };
}

}  // namespace kerf::chip
