#pragma once

#include <algorithm>
#include <cmath>

namespace kerf::chip {

// Bending of a rectangular elastic-plastic section with linear hardening a = E_t / E, in multiples of first yield:
// curvature k = kappa / kappa_y, moment m = M / M_y, energies per kappa_y M_y.
//
//     m = k                                     k <= 1
//     m = a k + (1 - a) (3/2) (1 - 1/(3 k^2))   k > 1

template <class T>
T section_moment(const T& k, double hardening) {
  if (k <= 1.0) return k;
  return hardening * k + (1.0 - hardening) * 1.5 * (1.0 - 1.0 / (3.0 * k * k));
}

/// C = integral of k dm.
template <class T>
T complementary_energy(const T& k, double hardening) {
  if (k <= 1.0) return 0.5 * k * k;
  return 0.5 + 0.5 * hardening * (k * k - 1.0) + (1.0 - hardening) * (1.0 - 1.0 / k);
}

/// W_p = k m - C - m^2/2: the loop that is left after elastic unloading to m = 0. No reverse yield while m <= 2.
template <class T>
T plastic_work(const T& k, double hardening) {
  if (k <= 1.0) return T(0.0);
  const T m = section_moment(k, hardening);
  return k * m - complementary_energy(k, hardening) - 0.5 * m * m;
}

/// The inverse of complementary_energy: curvature at which it reaches `energy`. Infinite when it never does.
double curvature_of_complementary_energy(double energy, double hardening);

}  // namespace kerf::chip
