#include "forward/effects/thermostat.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::forward {

void KineticThermostat::operator()(State& state) {
  Particles& p = state.particles;
  double kinetic = 0.0, elastic = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i)
    kinetic +=
        0.5 * p.volume[i] * state.density * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
  std::visit(
      [&](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) elastic += p.volume[i] * law.elastic_energy(p.stress(i));
      },
      material_);
  const double wanted = thermostat_.kinetic_share * elastic;
  if (wanted <= 0.0) return;
  // The gain is the damping reached in one transit at twice the wanted energy; more than ten of it would be a brake.
  rate_ =
      std::clamp(rate_ + thermostat_.gain * courant_number_ * (kinetic / wanted - 1.0), 0.0, 10.0 * thermostat_.gain);
  if (rate_ == 0.0) return;
  const double keep = std::exp(-rate_ * courant_number_);
  for (std::size_t i = 0; i < p.size(); ++i) {
    p.velocity_x[i] *= keep;
    p.velocity_y[i] *= keep;
  }
  for (VelocityField& field : state.grid.side)
    for (double& momentum : field.momentum) momentum *= keep;
  state.work.damping += kinetic * (1.0 - keep * keep);
}

}  // namespace kerf::forward
