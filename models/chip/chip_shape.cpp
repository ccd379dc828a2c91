#include "models/chip/chip_shape.hpp"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <limits>

namespace kerf::chip {

ChipShape chip_shape(const BendingChip<double>& chip, double k, int sections) {
  const double end = chip.turn();
  const double start = std::min(chip.root_angle(k), end);
  const double yield_curvature = 2.0 * chip.yield_stress / (chip.modulus * chip.depth);
  const double force = chip.normal_force(k) / chip.energy_scale();

  // u^2 = end - angle takes away the square-root singularity at the contact, where the curvature vanishes.
  const auto length_per_u = [&](double u) {
    const double curvature =
        curvature_of_complementary_energy(force * chip.projection(u * u), chip.hardening) * yield_curvature;
    return 2.0 * u / curvature;
  };
  using Gauss = boost::math::quadrature::gauss<double, 15>;

  const double u_root = std::sqrt(end - start);
  double length = 0.0;
  double axis_x = 0.5 * chip.depth * std::sin(start);
  double axis_y = 0.5 * chip.depth * std::cos(start);
  ChipShape shape{};
  const auto add_lower_face = [&](double angle) {
    shape.lower_face.push_back(
        {axis_x - 0.5 * chip.depth * std::sin(angle), axis_y - 0.5 * chip.depth * std::cos(angle)});
  };
  add_lower_face(start);
  for (int i = 0; i < sections; ++i) {
    const double from = u_root * (sections - i - 1) / sections;
    const double to = u_root * (sections - i) / sections;
    if (to > from) {
      length += Gauss::integrate(length_per_u, from, to);
      axis_x -= Gauss::integrate([&](double u) { return std::cos(end - u * u) * length_per_u(u); }, from, to);
      axis_y += Gauss::integrate([&](double u) { return std::sin(end - u * u) * length_per_u(u); }, from, to);
    }
    add_lower_face(end - from * from);
  }

  // The rake face passes through the contact along (-sin alpha, cos alpha); follow it down to the crack plane.
  const auto contact = shape.lower_face.back();
  shape.contact_length = length;
  shape.tip_gap = -(contact.x + contact.y * std::tan(chip.rake));
  const double residual = (k - section_moment(k, chip.hardening)) * yield_curvature;
  shape.curl_radius = residual > 0.0 ? 1.0 / residual : std::numeric_limits<double>::infinity();
  shape.touching = length < 0.5 * chip.depth;
  return shape;
}

}  // namespace kerf::chip
