#pragma once

#include <string>

// A cut coarse enough for a calibration in seconds: 4 cells, a short window, a fast tool. Its forces are not converged;
// a twin experiment asks only whether the search finds what the same coarse cut was made with.
namespace kerf::testing {

inline constexpr const char* coarse_scene = R"(title = "coarse twin"
[material]
law = "j2"
elastic_modulus = "1000 MPa"
poisson_ratio = 0.33
density = "1 g/cm^3"
yield_stress = "25 MPa"
[cohesive]
[cohesive.mode_I]
law = "cubic"
strength = "30 MPa"
toughness = "2000 J/m^2"
[cohesive.mode_II]
law = "cubic"
strength = "30 MPa"
toughness = "2000 J/m^2"
[cut]
depth = "0.5 mm"
speed = "20 m/s"
ramp = "0.04 ms"
travel = 8
[tool]
rake = "30 deg"
[friction]
coefficient = 0.2
[pic_damping]
rate = 0.025
[window]
ahead = 4
behind = 2
below = 3
above = 3
[resolution]
cells_through_chip = 4
[steady_state]
not_before = 8
)";

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
