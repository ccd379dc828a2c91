#pragma once

#include <filesystem>

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Keeps the state of a cut at a cell crossing in an HDF5 file, for other cuts to begin with: particles with all they
/// remember, crack faces with their bonds, tool and window, in the solver's units. What follows from these (grid,
/// time step, work done) is not kept. The file appears whole or not at all.
///
/// A state fits a scene of the same geometry: work, tool, speed and mesh, one law with the same memory, friction on the
/// same parts. Free are all other numbers: of the material, of its bonds, of friction, damping, time step, tolerance.

/// Throws InputError when the scene is one whose state is not kept: a specimen, a log, one with a thermostat (which
/// remembers more than the state holds). `name` is the scene's.
void require_chainable(const Scene& scene, const std::string& name);

/// Throws InputError when the place cannot be written.
void write_state(const std::filesystem::path& h5, const State& state, const Scene& scene);

/// Throws InputError when the file is not there, is not a whole state or does not fit the scene, saying in what.
State read_state(const std::filesystem::path& h5, const Scene& scene);

}  // namespace kerf::forward
