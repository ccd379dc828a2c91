#pragma once

#include <cstddef>

#include "forward/mpm/state.hpp"

namespace kerf::bench {

enum class Flow {
  elastic,  ///< strains far below yield
  plastic   ///< every particle on its yield surface, and loading on
};

/// A block of the verification cut's material (or another one), without tool, crack or markers, that is pulled upwards
/// at a steady rate: what a step of the bare kernel is timed on.
///
/// v_y grows linearly from the held bottom, with a slow wave on it. The time step is a ten-thousandth of the stable
/// one, so that inertia carries the flow through whatever the stresses do, while one step strains as much as one step
/// of a cut does. Particles stand up to half a cell from where they were sorted, as they do between two shifts of the
/// window.
/// `particles` is 16 times a square: 4096, 16384, 65536, 262144, 1048576.
forward::State block(const laws::Material& material, std::size_t particles, Flow flow);

/// One step of the bare kernel: project, stress, accelerate, advance with the verification cut's PIC damping.
void kernel_step(forward::State& state, const laws::Material& material);

/// The PIC share of `kernel_step`.
double pic_share();

/// Share of the particles whose plastic strain grew from one state to the other.
double yielding_share(const forward::State& before, const forward::State& after);

laws::Material polymer();  ///< J2 of the verification cut, yields at 25 MPa
laws::Material elastic();  ///< the same, yield stress out of reach
laws::Material hencky();   ///< the first one, hyperelastic
laws::Material wood();     ///< Hill, Douglas-fir RL

}  // namespace kerf::bench
