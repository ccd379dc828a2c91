#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "models/base/parameter.hpp"
#include "models/laws/body_point.hpp"

namespace kerf::laws {

/// A material law of the cut as a body's: it knows no heat.
template <class Law>
struct Mechanical {
  Law law;

  static std::string name() { return Law::block().variant; }
  static std::string meaning() { return Law::block().meaning; }
  static std::vector<Parameter> parameters() { return Law::block().parameters; }
  static Mechanical from(const Values& values) { return {Law::from(values)}; }
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
  /// Stored and dissipated, per reference volume.
  Lanes energy(const BodyPoints& p) const {
    Lanes all{};
    for (std::size_t i = 0; i < lane_count; ++i)
      all[i] = law.elastic_energy({p.xx[i], p.yy[i], p.zz[i], p.xy[i], p.memory[1][i], p.memory[2][i]}) +
               law.plastic_work(p.memory[0][i]);
    return all;
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
