#include "models/chip/root_rotation.hpp"

#include <cmath>

namespace kerf::chip {

double orthotropic_root_rotation(double E_x, double E_y, double G_xy) {
  const double gamma = 1.18 * std::sqrt(E_x * E_y) / G_xy;
  const double ratio = gamma / (1.0 + gamma);
  return std::sqrt(E_x / (11.0 * G_xy) * (3.0 - 2.0 * ratio * ratio));
}

}  // namespace kerf::chip
