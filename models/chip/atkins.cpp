#include "models/chip/atkins.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::chip {

namespace {

constexpr double quarter_turn = std::numbers::pi / 2;

ChipPrediction predict(const Values& cut) {
  const double rake = cut.number("rake");
  const double friction = cut.number("friction");
  const double adhesion = cut.number("adhesion_toughness");
  if (!chip_can_slide(friction, rake)) return no_solution(locked_chip_reason());

  const auto least = atkins_minimum(cut.number("depth"), rake, cut.number("yield_stress"), cut.number("toughness"),
                                    friction, adhesion);
  const ToolForces<double> rake_face{
      least.F_c, force_slope(friction, rake) * least.F_c + adhesion_offset(adhesion, friction, rake)};
  const auto forces = with_bottom_force(rake_face, cut.number("bottom_force"), friction);

  ChipPrediction prediction;
  prediction.F_c = forces.F_c;
  prediction.F_t = forces.F_t;
  prediction.shear_angle = least.shear_angle;
  const double phi = least.shear_angle;
  prediction.details = {
      {"chip_ratio", std::cos(phi - rake) / std::sin(phi), "1", "chip thickness / depth"},
      {"shear_strain", 1.0 / std::tan(phi) + std::tan(phi - rake), "1", "shear strain gamma on the shear plane"},
  };
  return prediction;
}

}  // namespace

double atkins_cutting_force(double shear_angle, double depth, double rake, double yield_stress, double toughness,
                            double friction, double adhesion) {
  const double sliding = std::sin(shear_angle) / std::cos(shear_angle - rake);
  const double face = std::cos(rake) + friction * std::sin(rake);
  const double q = 1.0 - friction * sliding / face;
  if (q <= 0.0) return std::numeric_limits<double>::infinity();
  const double shear_strain = 1.0 / std::tan(shear_angle) + std::tan(shear_angle - rake);
  const double work =
      0.5 * yield_stress * shear_strain * depth + toughness + adhesion * sliding * std::cos(rake) / face;
  return work / q;
}

AtkinsMinimum atkins_minimum(double depth, double rake, double yield_stress, double toughness, double friction,
                             double adhesion) {
  // The chip shears between the crack plane and the steepest plane that still moves away from the tool (Q > 0); the
  // force, a convex function of cot phi over a linear one, has one minimum between. The search spans many decades of
  // angle: a tough, soft chip shears at very small ones.
  const double slope = force_slope(friction, rake);
  const double steepest = std::min({quarter_turn - std::atan(slope), quarter_turn + std::min(rake, 0.0), quarter_turn});
  const auto angle = [&](double log_ratio) { return steepest / (1.0 + std::exp(-log_ratio)); };
  const auto force = [&](double log_ratio) {
    return atkins_cutting_force(angle(log_ratio), depth, rake, yield_stress, toughness, friction, adhesion);
  };
  const auto [at, least] =
      boost::math::tools::brent_find_minima(force, -40.0, 30.0, std::numeric_limits<double>::digits);
  return {least, angle(at)};
}

ClosedForm atkins_model() {
  return {"atkins",
          "energy balance, least force over the shear angle found numerically; tau_y = sigma_y / 2",
          {keys::depth(), keys::rake(), keys::yield_stress(), keys::toughness(), keys::friction(),
           keys::adhesion_toughness(), keys::bottom_force()},
          predict};
}

}  // namespace kerf::chip
