#pragma once

#include <string>

#include "models/base/atomic_file.hpp"

// Twin experiments with the cut of twin.toml.
namespace kerf::testing {

inline const std::string coarse_scene = read_file(KERF_SOURCE_DIR "/tests/recovery/twin.toml");

inline constexpr const char* coarse_job = R"(title = "twin by simulation"
scene = "scene.toml"
observables = ["F_c", "F_t"]
[[curve]]
file = "curve.csv"
[[free]]
path = "material.yield_stress"
lower = "15 MPa"
upper = "60 MPa"
start = "34 MPa"
key = true
[[free]]
path = "friction.coefficient"
lower = 0.05
upper = 0.6
start = 0.12
key = true
[budget]
max_runs = 60
)";

}  // namespace kerf::testing
