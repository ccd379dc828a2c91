#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "models/chip/beam_section.hpp"
#include "models/chip/closed_form.hpp"
#include "models/chip/rake_face.hpp"

namespace kerf::chip {

// The tool does not touch the crack tip: the chip is an elastic-plastic beam of height h that leaves the crack tip
// turned by the root rotation theta_0 and ends tangent to the rake face, theta = pi/2 - alpha. With
// A(x) = sin x - mu (1 - cos x), per width:
//
//     energy            N A(theta)           = G_c + W_p(k_0)                                               (5)
//     first integral    N A(theta - theta_0) = C(k_0)                                                       (6)
//     root rotation     theta_0 = chi h kappa_0 = 2 chi eps_y k_0
//
// eps_y = sigma_y'/E', kappa_y M_y = sigma_y'^2 h / (3 E'); W_p and C of beam_section.hpp. Plane strain:
// E' = E/(1 - nu^2), sigma_y' = 2 sigma_y / sqrt 3. Elastic and without root rotation, G_c = M_0^2 / (2 E' I): the
// double cantilever beam.

/// All of the beam that does not depend on the force.
template <class T>
struct BendingChip {
  double depth;                ///< mm
  double rake;                 ///< rad
  T yield_stress;              ///< sigma_y' in MPa, already reduced for plane strain
  T toughness;                 ///< N/mm
  T friction;                  ///< mu
  double modulus;              ///< E' in MPa
  double hardening = 0.0;      ///< a = E_t/E
  double root_rotation = 0.0;  ///< chi

  double turn() const { return std::numbers::pi / 2 - rake; }  ///< theta, rad
  T projection(const T& angle) const {                         ///< A
    using std::cos, std::sin;
    return sin(angle) - friction * (1.0 - cos(angle));
  }
  T root_angle(const T& k) const { return 2.0 * root_rotation * yield_stress / modulus * k; }
  T energy_scale() const { return yield_stress * yield_stress * depth / (3.0 * modulus); }  ///< kappa_y M_y
  /// (5) and (6) without N: zero at the root's curvature, negative before it.
  T imbalance(const T& k) const {
    const T angle = T(turn());
    return projection(angle) * complementary_energy(k, hardening) * energy_scale() -
           projection(angle - root_angle(k)) * (toughness + plastic_work(k, hardening) * energy_scale());
  }
  /// N from (5), N/mm.
  T normal_force(const T& k) const {
    return (toughness + plastic_work(k, hardening) * energy_scale()) / projection(T(turn()));
  }
  ToolForces<T> forces(const T& k) const {
    const T normal = normal_force(k);
    return {normal * (std::cos(rake) + friction * std::sin(rake)),
            normal * (friction * std::cos(rake) - std::sin(rake))};
  }
};

/// The root's curvature k_0 = kappa_0/kappa_y: the first one that a chip bent from straight comes to. None when no
/// curvature satisfies (5) and (6).
std::optional<double> root_curvature(const BendingChip<double>& chip);

/// E' and sigma_y' of the plane: strain or stress.
double plane_modulus(double elastic_modulus, double poisson_ratio, bool plane_strain);
double plane_yield_stress_factor(bool plane_strain);

/// A bending solution needs the root to turn less than half of the whole angle; beyond that the root, not the beam,
/// carries the chip and the force is overestimated. Empty when fine, else the reason.
std::string out_of_bending_range(const BendingChip<double>& chip, double k);

ClosedForm plastic_bending_model();

}  // namespace kerf::chip
