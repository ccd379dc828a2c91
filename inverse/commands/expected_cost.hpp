#pragma once

#include <vector>

#include "forward/plan.hpp"
#include "forward/scene/scene.hpp"

namespace kerf::commands {

/// What a cut will cost. It may stop anywhere between two travels.
struct ExpectedCost {
  double particles = 0;
  double least_steps = 0, most_steps = 0;
  double least() const { return least_steps * particles; }  ///< particle-steps
  double most() const { return most_steps * particles; }
};

/// `state` is the scene laid out.
ExpectedCost expected_cost(const forward::Scene& scene, const forward::State& state);
ExpectedCost expected_cost(const forward::Scene& scene);

/// Seconds that each stage took over the first steps of the cut: a measurement, not a model.
std::vector<double> time_stages(forward::State& state, const std::vector<forward::Stage>& stages, int steps);

/// Seconds per particle and step, measured on a few steps of this scene.
double seconds_per_particle_step(const forward::Scene& scene);

}  // namespace kerf::commands
