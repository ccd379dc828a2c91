#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "models/base/error.hpp"
#include "models/base/parameter.hpp"
#include "models/laws/body_point.hpp"

namespace kerf::laws {

/// A material law of the cut as a body's. Where it is given a specific heat c it has a temperature: of the plastic work
/// w_p a share beta (Taylor and Quinney's) is heat,
///     T = theta + beta w_p/(rho c),                                              (1)
/// of which a point keeps theta, which heat from elsewhere alone changes. Stresses do not depend on T, and elastic
/// strains neither cool nor warm.
template <class Law>
struct Mechanical {
  Law law;
  double specific_heat = 0;   ///< c, mm^2/(s^2 K); zero: no temperature
  double taylor_quinney = 0;  ///< beta
  double reference = 0;       ///< temperature at the start unless the scene says another, K

  static std::string name() { return Law::block().variant; }
  static std::string meaning() { return Law::block().meaning; }
  static std::vector<Parameter> parameters() {
    std::vector<Parameter> all = Law::block().parameters;
    all.push_back(number("specific_heat", "J/(kg K)", 1.0, 1e5, "plastic work heats the body; absent: no temperature")
                      .if_given());
    all.push_back(
        number("taylor_quinney", "1", 0.0, 1.0, "share of the plastic work that becomes heat; absent: 0.9").if_given());
    all.push_back(number("temperature", "K", 1.0, 1e4, "at the start; absent: 293.15 K").if_given());
    return all;
  }
  static Mechanical from(const Values& values) {
    Mechanical made{Law::from(values)};
    for (const char* key : {"taylor_quinney", "temperature"})
      if (values.has(key) && !values.has("specific_heat"))
        throw InputError(values.where(key) + ": [[body]] has the key \"" + key + "\" and lacks \"specific_heat\"");
    if (!values.has("specific_heat")) return made;
    made.specific_heat = values.number("specific_heat");
    made.taylor_quinney = values.has("taylor_quinney") ? values.number("taylor_quinney") : 0.9;
    made.reference = 293.15;
    return made;
  }
  static std::vector<Memory> memory() {
    if constexpr (Law::has_axes)
      return {{"plastic strain", 0.0}, {"grain direction x", 1.0}, {"grain direction y", 0.0}};
    else
      return {{"plastic strain", 0.0}};
  }
  static constexpr bool is_thermal = false;

  double mass_density() const { return law.density; }
  void deform(const StrainIncrement& l, BodyPoints& p) const {
    MaterialPoints points{p.xx, p.yy, p.zz, p.xy, p.memory[0], p.memory[1], p.memory[2]};
    const bool sound = law.update(l, points);
    p.xx = points.xx;
    p.yy = points.yy;
    p.zz = points.zz;
    p.xy = points.xy;
    p.memory = {points.plastic_strain, points.axis_x, points.axis_y, Lanes{}};
    if (!sound) p.xx = Lanes{} / Lanes{};
  }
  bool find_stress(const BodyPoints& p) const { return !any(!(abs(p.xx) < 1e300)); }
  double heat_capacity() const { return law.density * specific_heat; }
  /// Done on the body in yielding, MPa.
  Lanes plastic_work(const BodyPoints& p) const {
    return each_lane(p.memory[0], [this](double eps) { return law.plastic_work(eps); });
  }
  /// What Eq. (1) adds to theta, K; of a body with a temperature.
  Lanes warming(const BodyPoints& p) const { return taylor_quinney / heat_capacity() * plastic_work(p); }
  /// Stored and dissipated, and as heat from elsewhere, per reference volume.
  Lanes energy(const BodyPoints& p) const {
    Lanes all{};
    for (std::size_t i = 0; i < lane_count; ++i)
      all[i] = law.elastic_energy({p.xx[i], p.yy[i], p.zz[i], p.xy[i], p.memory[1][i], p.memory[2][i]}) +
               law.plastic_work(p.memory[0][i]);
    return all + heat_capacity() * (p.temperature - reference);
  }
  Lanes wave_speed(const BodyPoints& p) const {
    if constexpr (Law::has_axes) {
      Lanes speed{};
      for (std::size_t i = 0; i < lane_count; ++i)
        speed[i] =
            std::max(law.wave_speed(p.memory[1][i], -p.memory[2][i]), law.wave_speed(p.memory[2][i], p.memory[1][i]));
      return speed;
    } else {
      return all_lanes(law.wave_speed());
    }
  }
};

}  // namespace kerf::laws
