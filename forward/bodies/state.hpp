#pragma once

#include <string>
#include <vector>

#include "forward/bodies/scene.hpp"
#include "forward/mpm/state.hpp"

namespace kerf::forward::bodies {

/// Material points of one body, structure of arrays, padded to whole batches with points of no volume. Units as in a
/// cut: mm, mm/s, MPa; volume is the reference volume per unit width, mm^2. The grid lies in the reference
/// configuration (total Lagrangian): kernels are taken at the reference positions. In the current configuration
/// quadratic splines are unstable under a tension of a quarter of the modulus, which rubber exceeds.
struct Points {
  std::vector<double> reference_x, reference_y, x, y, velocity_x, velocity_y, volume;
  std::vector<double> F_xx, F_xy, F_yx, F_yy;                      ///< deformation gradient dx/dX
  std::vector<double> stress_xx, stress_yy, stress_zz, stress_xy;  ///< Kirchhoff stress
  std::vector<std::vector<double>> memory;                         ///< what the law keeps, see laws::Memory
  std::vector<double> temperature;                                 ///< K; only of thermal laws
  std::size_t size() const { return x.size(); }
  static constexpr std::size_t mechanical_numbers = 15;  ///< kept for every point, before memory and temperature
};

struct Body {
  laws::BodyLaw law;
  Points points;
  VelocityField field;
  bool is_thermal() const { return !points.temperature.empty(); }
};

/// What the walls have done so far, and do now. Per unit width: N/mm, N mm/mm.
struct Piston {
  double position, speed = 0;
  double force = 0;  ///< of the piston on the bodies, +x, in this step
  double work = 0;   ///< on the bodies
};

/// Heat that came in from outside, N mm/mm, and over its temperature, N mm/(mm K).
struct HeatBook {
  double heat = 0, entropy = 0;
};

struct State {
  Grid grid;  ///< in the reference configuration; its own velocity fields are not used
  std::vector<Body> bodies;
  Piston piston;
  HeatBook bath;
  double damping = 0;  ///< work lost to PIC, N mm/mm
  double time = 0, step = 0;
  double interface_energy = 0;
  std::string breakdown;  ///< why the run cannot go on; empty while it can
};

/// Lays the bodies into the box, at rest.
State lay_out(const Scene& scene);

/// The stable step for what the bodies are now.
double stable_step(const State& state, const Scene& scene);

}  // namespace kerf::forward::bodies
