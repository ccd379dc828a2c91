#pragma once

#include <limits>
#include <string>
#include <vector>

#include "models/base/parameter.hpp"
#include "models/laws/body_point.hpp"

namespace kerf::laws {

/// A metal with the Mie-Grueneisen equation of state and J2 plasticity. With the compression eta = 1 - J, the Hugoniot
/// pressure p_H = rho_0 C_0^2 eta / (1 - S eta)^2 (shock speed C_0 + S u) and the energy u per mass,
///     p = p_H (1 - gamma_0 eta/2) + gamma_0 rho_0 u                                       (1)
///     u = c (T - T_0) + e(eta),   de/deta = p(eta, T_0)/rho_0 - gamma_0 c T_0,  e(0) = 0     (2)
///     S/rho_0 = c ln(T/T_0) - gamma_0 c eta                                                (3)
/// (2) is what makes (1) and (3) belong to one free energy: an elastic expansion dJ cools by gamma_0 T dJ. The stress
/// deviator follows the Jaumann rate with a constant shear modulus; of the work of yielding a share beta (Taylor and
/// Quinney's) is heat, the rest stays in the metal as stored energy. The equation of state
/// in this form: Wilkins, Computer Simulation of Dynamic Phenomena (1999), section 3.
struct MieGruneisen {
  double density;         ///< rho_0, tonne/mm^3
  double sound_speed;     ///< C_0, mm/s
  double slope;           ///< S
  double gruneisen;       ///< gamma_0
  double specific_heat;   ///< c, mm^2/(s^2 K)
  double shear_modulus;   ///< G, MPa
  double yield_stress;    ///< MPa; infinite: elastic
  double taylor_quinney;  ///< beta
  double reference;       ///< T_0, K

  static std::string name() { return "mie_gruneisen"; }
  static std::string meaning() {
    return "metal with the Mie-Grueneisen equation of state, elastic or von Mises plastic";
  }
  static std::vector<Parameter> parameters();
  static MieGruneisen from(const Values& values);
  static std::vector<Memory> memory() { return {{"volume ratio", 1.0}, {"plastic strain", 0.0}}; }
  static constexpr bool is_thermal = true;

  double mass_density() const { return density; }
  double heat_capacity() const { return density * specific_heat; }
  void deform(const StrainIncrement& l, BodyPoints& points) const;
  Lanes configurational_entropy(const BodyPoints& points) const {
    return -gruneisen * heat_capacity() * (1.0 - points.memory[0]);
  }
  bool find_stress(BodyPoints& points) const;
  Lanes energy(const BodyPoints& points) const;
  /// Done on the metal in yielding, MPa.
  Lanes plastic_work(const BodyPoints& points) const {
    return std::isfinite(yield_stress) ? yield_stress * points.memory[1] : Lanes{};
  }
  Lanes wave_speed(const BodyPoints& points) const;
  /// Eq. (1) at a volume ratio and a temperature, MPa.
  double pressure(double volume_ratio, double temperature) const;

 private:
  double hugoniot(double eta) const {
    const double rest = 1.0 - slope * eta;
    return density * sound_speed * sound_speed * eta / (rest * rest) * (1.0 - 0.5 * gruneisen * eta);
  }
  /// e of Eq. (2).
  double cold_energy(double eta) const;
};

}  // namespace kerf::laws
