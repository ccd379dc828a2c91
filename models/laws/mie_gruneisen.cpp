#include "models/laws/mie_gruneisen.hpp"

namespace kerf::laws {
namespace {

enum { volume_ratio, plastic_strain };

}  // namespace

std::vector<Parameter> MieGruneisen::parameters() {
  return {
      number("density", "kg/m^3", 1.0, 3e4, "mass density rho_0"),
      number("sound_speed", "m/s", 1.0, 2e4, "C_0, of the shock speed C_0 + S u"),
      number("slope", "1", 0.0, 5.0, "S"),
      number("gruneisen", "1", 0.0, 5.0, "Grueneisen's gamma_0"),
      number("specific_heat", "J/(kg K)", 1.0, 1e5, "specific heat at constant volume"),
      number("shear_modulus", "MPa", 1e-3, 1e6, "shear modulus G"),
      number("yield_stress", "MPa", 1e-3, 1e5, "von Mises yield stress; absent: the metal stays elastic").if_given(),
      number("taylor_quinney", "1", 0.0, 1.0,
             "share of the work of yielding that becomes heat; the rest stays in the metal as stored energy")
          .or_else("1"),
      number("reference_temperature", "K", 1.0, 1e4, "T_0, of the state without stress"),
      number("temperature", "K", 1.0, 1e4, "temperature at the start; absent: that of the reference state").if_given()};
}

MieGruneisen MieGruneisen::from(const Values& values) {
  return {.density = values.number("density"),
          .sound_speed = values.number("sound_speed"),
          .slope = values.number("slope"),
          .gruneisen = values.number("gruneisen"),
          .specific_heat = values.number("specific_heat"),
          .shear_modulus = values.number("shear_modulus"),
          .yield_stress =
              values.has("yield_stress") ? values.number("yield_stress") : std::numeric_limits<double>::infinity(),
          .taylor_quinney = values.number("taylor_quinney"),
          .reference = values.number("reference_temperature")};
}

double MieGruneisen::cold_energy(double eta) const {
  // The solution of (2) by variation of constants, e = int_0^eta exp(gamma_0 (eta - x)) (p_H/rho_0 - gamma_0 c T_0) dx
  // with p_H as `hugoniot` has it: smooth, so that five points of Gauss give all digits.
  constexpr std::array<double, 5> at{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                     0.9061798459386640};
  constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                         0.2369268850561891};
  double sum = 0.0;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double x = 0.5 * eta * (1.0 + at[k]);
    sum +=
        weight[k] * std::exp(gruneisen * (eta - x)) * (hugoniot(x) / density - gruneisen * specific_heat * reference);
  }
  return 0.5 * eta * sum;
}

double MieGruneisen::pressure(double J, double temperature) const {
  const double eta = 1.0 - J;
  return hugoniot(eta) + gruneisen * density * (specific_heat * (temperature - reference) + cold_energy(eta));
}

void MieGruneisen::deform(const StrainIncrement& l, BodyPoints& p) const {
  const auto [c, s] = step_rotation(l.xy, l.yx);
  const Lanes cc = c * c, ss = s * s, cs = c * s, xx = p.xx, yy = p.yy, xy = p.xy;
  const double G = shear_modulus;
  p.xx = cc * xx + ss * yy - 2.0 * cs * xy + 2.0 * G * l.xx;
  p.yy = ss * xx + cc * yy + 2.0 * cs * xy + 2.0 * G * l.yy;
  p.xy = cs * (xx - yy) + (cc - ss) * xy + G * (l.xy + l.yx);
  p.memory[volume_ratio] *= volume_growth(l);
}

bool MieGruneisen::find_stress(BodyPoints& p) const {
  const Lanes mean = (p.xx + p.yy + p.zz) / 3.0;
  Lanes xx = p.xx - mean, yy = p.yy - mean, zz = p.zz - mean, xy = p.xy;
  const Lanes q = sqrt(1.5 * (xx * xx + yy * yy + zz * zz + 2.0 * xy * xy) + 1e-300);
  p.heating = Lanes{};
  if (any(q > yield_stress)) {
    const Lanes excess = q > yield_stress ? q - yield_stress : Lanes{};
    const Lanes keep = 1.0 - excess / q, slip = excess / (3.0 * shear_modulus);
    xx *= keep;
    yy *= keep;
    zz *= keep;
    xy *= keep;
    p.memory[plastic_strain] += slip;
    p.heating = taylor_quinney * yield_stress * slip;
  }
  Lanes kirchhoff{};
  for (std::size_t i = 0; i < lane_count; ++i)
    kirchhoff[i] = -p.memory[volume_ratio][i] * pressure(p.memory[volume_ratio][i], p.temperature[i]);
  p.xx = xx + kirchhoff;
  p.yy = yy + kirchhoff;
  p.zz = zz + kirchhoff;
  p.xy = xy;
  return !any(!((p.memory[volume_ratio] > 0.0) & (p.temperature > 0.0) & (q < 1e300)));
}

Lanes MieGruneisen::energy(const BodyPoints& p) const {
  const Lanes mean = (p.xx + p.yy + p.zz) / 3.0;
  const Lanes xx = p.xx - mean, yy = p.yy - mean, zz = p.zz - mean;
  Lanes stored = (xx * xx + yy * yy + zz * zz + 2.0 * p.xy * p.xy) / (4.0 * shear_modulus);
  stored += heat_capacity() * (p.temperature - reference) + (1.0 - taylor_quinney) * plastic_work(p);
  return stored + density * each_lane(1.0 - p.memory[volume_ratio], [this](double eta) { return cold_energy(eta); });
}

Lanes MieGruneisen::wave_speed(const BodyPoints& p) const {
  const Lanes eta = 1.0 - p.memory[volume_ratio];
  // Of the shock that would bring the metal there, whose speed is C_0 / (1 - S eta), with the shear wave on top.
  const Lanes bulk = sound_speed / (1.0 - slope * (eta > 0.0 ? eta : Lanes{}));
  return sqrt(bulk * bulk + 4.0 * shear_modulus / (3.0 * density));
}

}  // namespace kerf::laws
