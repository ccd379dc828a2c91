#include "models/chip/beam_section.hpp"

#include <limits>

namespace kerf::chip {

double curvature_of_complementary_energy(double energy, double hardening) {
  if (energy <= 0.5) return std::sqrt(2.0 * std::max(energy, 0.0));
  if (hardening == 0.0) return energy < 1.5 ? 1.0 / (1.5 - energy) : std::numeric_limits<double>::infinity();
  // C is increasing; it is concave before k^3 = (1 - a)/a and convex beyond, so Newton is kept inside a bracket.
  double low = 1.0;
  double high = std::sqrt(1.0 + 2.0 * (energy - 0.5) / hardening);
  double k = std::min(high, energy < 1.4 ? 1.0 / (1.5 - energy) : high);
  for (int step = 0; step < 100; ++step) {
    const double excess = complementary_energy(k, hardening) - energy;
    (excess > 0.0 ? high : low) = k;
    const double slope = hardening * k + (1.0 - hardening) / (k * k);
    double next = k - excess / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - k) <= 1e-15 * k) return next;
    k = next;
  }
  return k;
}

}  // namespace kerf::chip
