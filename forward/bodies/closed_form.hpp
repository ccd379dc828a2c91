#pragma once

#include <map>
#include <string>
#include <vector>

#include "forward/bodies/run.hpp"

namespace kerf::forward::bodies {

/// What theory says of columns of a run's history, reading by reading; NaN where it says nothing. A scene that closed
/// forms do not describe has none.
/// - stress_xx and temperature of one ideal gas: an isothermal stroke at p V, an adiabatic one at p V^gamma and
///   T V^(gamma - 1) of its start
/// - temperature of one ideal rubber pulled fast: T exp((w - w_0)/(c T_0)) of an incompressible strip
/// - temperature of one elastic Mie-Grueneisen body: T exp(-gamma_0 (J - J_0)) on an isentrope
/// - force on a bar whose modulus is read: that of layered_modulus() times the strain
/// - kinetic energy of a standing wave: K_0 cos^2(2 pi f t)
using ClosedForms = std::map<std::string, std::vector<double>>;
ClosedForms closed_forms(const BodiesResult& result, const Scene& scene);

/// Work of deforming an incompressible strip of ideal rubber by lambda, MPa.
double rubber_work(const laws::IdealRubber& law, double lambda);

/// Young's modulus along x of a law under the box's conditions (plane strain, free or held across), MPa: what a uniform
/// bar would show. Only isotropic elastic bodies know it, others are NaN.
double bar_modulus(const laws::BodyLaw& law, bool held_across);

/// Whether walls hold a bar across, so that it cannot get thicker or thinner.
bool is_held_across(const Scene& scene);

/// Of the particles that it gives, mm^2 per width.
double volume_of(const Shape& shape, double cell);

/// Modulus along x of layers whose normal stands askew by a; f_i their shares, A/V the interface's area per volume,
/// c = cos a, s = sin a:
///     1/E = (c^4 + 2 c^2 s^2) sum f_i/E_i + s^4/(sum f_i E_i) + A/V (c^4/D_n + c^2 s^2/D_t)
/// Exact for layers of one material, where a bar free at its sides has the same stress everywhere; of several in a wide
/// body with nu = 0.
struct LayeredModulus {
  double volume;                   ///< mm^2 per width
  double perfect;                  ///< of layers that share their displacement, MPa
  double glued;                    ///< with the scene's interface; perfect without one
  double normal_stiffness, angle;  ///< of that interface: D_n, MPa/mm, and a, rad
};
LayeredModulus layered_modulus(const Scene& scene, double strain);

/// Frequency of the lowest mode of a bar between walls, c/wavelength, Hz.
double standing_wave_frequency(const Scene& scene);

}  // namespace kerf::forward::bodies
