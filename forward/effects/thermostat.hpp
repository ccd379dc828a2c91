#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Kinetic-energy thermostat: all particles are damped, v <- v exp(-a), with a rate that follows the kinetic energy K,
///     da = gain (K / K_wanted - 1) per transit of a wave through a cell,  0 <= a <= 10 gain,
/// and what it takes is booked as damping. Acts after particles have passed on their momentum, on both alike. Source:
/// the feedback damping named in Nairn 2013.
class KineticThermostat {
 public:
  KineticThermostat(const Thermostat& thermostat, const Scene& scene)
      : thermostat_(thermostat), material_(scene.material), courant_number_(scene.resolution.courant_number) {}
  void operator()(State& state);

 private:
  Thermostat thermostat_;
  laws::Material material_;
  double courant_number_;
  double rate_ = 0;  ///< a
};

}  // namespace kerf::forward
