#include "models/chip/plastic_bending.hpp"

#include <fmt/format.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <numbers>

#include "models/chip/chip_shape.hpp"
#include "models/chip/root_rotation.hpp"

namespace kerf::chip {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

double bisect(const BendingChip<double>& chip, double low, double high) {
  std::uintmax_t iterations = 200;
  const auto [a, b] = boost::math::tools::toms748_solve([&](double k) { return chip.imbalance(k); }, low, high,
                                                        boost::math::tools::eps_tolerance<double>(52), iterations);
  return 0.5 * (a + b);
}

ChipPrediction predict(const Values& cut) {
  const bool plane_strain = cut.text("plane") == "strain";
  const BendingChip<double> chip{
      .depth = cut.number("depth"),
      .rake = cut.number("rake"),
      .yield_stress = cut.number("yield_stress") * plane_yield_stress_factor(plane_strain),
      .toughness = cut.number("toughness"),
      .friction = cut.number("friction"),
      .modulus = plane_modulus(cut.number("elastic_modulus"), cut.number("poisson_ratio"), plane_strain),
      .hardening = cut.number("hardening_ratio"),
      .root_rotation = cut.number("root_rotation")};
  if (chip.projection(chip.turn()) <= 0.0) {
    return no_solution(
        "friction holds the chip: sin(theta) must exceed friction (1 - cos(theta)), theta = 90 deg - rake");
  }
  const auto k = root_curvature(chip);
  if (!k) {
    return no_solution("no curvature of the root balances the toughness: the perfectly plastic beam cannot store it");
  }
  const auto forces = with_bottom_force(chip.forces(*k), cut.number("bottom_force"), chip.friction);

  ChipPrediction prediction;
  prediction.F_c = forces.F_c;
  prediction.F_t = forces.F_t;
  prediction.reason = out_of_bending_range(chip, *k);
  prediction.valid = prediction.reason.empty();
  prediction.details = {
      {"normal_force", chip.normal_force(*k), "N/m", "force N per width on the rake face"},
      {"root_curvature", *k, "1", "root curvature / first-yield curvature, k_0"},
      {"root_angle", chip.root_angle(*k), "deg", "root rotation theta_0"},
      {"plastic_work", plastic_work(*k, chip.hardening) * chip.energy_scale(), "J/m^2", "plastic work W_p per area"},
  };
  if (*k > 0.0) {
    const auto shape = chip_shape(chip, *k);
    prediction.touching = shape.touching;
    prediction.details.push_back({"tip_gap", shape.tip_gap, "mm", "lead of the crack tip over the tool's tip"});
    prediction.details.push_back({"contact_length", shape.contact_length, "mm", "arc from crack tip to tool contact"});
    prediction.details.push_back({"curl_radius", shape.curl_radius, "mm", "radius of the chip after unloading"});
  }
  return prediction;
}

}  // namespace

std::optional<double> root_curvature(const BendingChip<double>& chip) {
  if (chip.toughness <= 0.0) return 0.0;
  if (chip.imbalance(1.0) >= 0.0 && chip.root_angle(1.0) <= chip.turn()) return bisect(chip, 0.0, 1.0);

  // Beyond yield the imbalance may rise, fall (plastic work outgrows the complementary energy) and rise again when the
  // root rotation uses up the angle. The chip is bent from straight, so the first crossing counts.
  constexpr double without_rotation = 1e6;
  const double per_k = chip.root_angle(1.0);
  const double last = per_k > 0.0 ? chip.turn() / per_k : without_rotation;
  if (last <= 1.0) return bisect(chip, 0.0, last);
  constexpr int steps = 400;
  double low = 1.0;
  for (int i = 1; i <= steps; ++i) {
    const double high = i == steps ? last : std::pow(last, static_cast<double>(i) / steps);
    if (chip.imbalance(high) >= 0.0) return bisect(chip, low, high);
    low = high;
  }
  return std::nullopt;
}

double plane_modulus(double elastic_modulus, double poisson_ratio, bool plane_strain) {
  return plane_strain ? elastic_modulus / (1.0 - poisson_ratio * poisson_ratio) : elastic_modulus;
}

double plane_yield_stress_factor(bool plane_strain) {
  return plane_strain ? 2.0 / std::numbers::sqrt3 : 1.0;
}

std::string out_of_bending_range(const BendingChip<double>& chip, double k) {
  const double root = chip.root_angle(k);
  if (root <= 0.5 * chip.turn()) return {};
  return fmt::format(
      "root rotation {:.1f} deg exceeds half of the chip's turn of {:.1f} deg: the root and not the bent chip carries "
      "the force, so the value is no bending solution{}",
      root / degree, chip.turn() / degree,
      chip.hardening == 0.0 ? " (without hardening the beam stores at most sigma_y'^2 h / (2 E'))" : "");
}

ClosedForm plastic_bending_model() {
  return {"plastic_bending",
          "elastic-plastic beam that bends ahead of the tool's tip, Eqs. (5) and (6)",
          {keys::depth(), keys::rake(), keys::yield_stress(), keys::toughness(), keys::friction(),
           number("elastic_modulus", "MPa", 1e-3, 1e7, "Young's modulus E"),
           number("poisson_ratio", "1", -0.99, 0.5, "Poisson's ratio nu").or_else("0.33"),
           number("hardening_ratio", "1", 0, 0.999, "tangent modulus over Young's modulus, a = E_t/E").or_else("0"),
           number("root_rotation", "1", 0, 10, "root rotation chi: 2/3 isotropic, Eq. (7) orthotropic")
               .or_else(fmt::format("{}", isotropic_root_rotation)),
           keys::bottom_force(), text("plane", "plane strain or plane stress", {"strain", "stress"}).or_else("strain")},
          predict};
}

}  // namespace kerf::chip
