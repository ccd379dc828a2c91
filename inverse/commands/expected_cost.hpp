#pragma once

#include <vector>

#include "forward/plan.hpp"
#include "forward/run.hpp"
#include "forward/scene/scene.hpp"

namespace kerf::commands {

/// What a cut will cost. It may stop anywhere between two travels.
struct ExpectedCost {
  double particles = 0;  ///< at the longest travel, on average
  double least_steps = 0, most_steps = 0;
  double least = 0, most = 0;  ///< particle-steps
};

/// `state` is the scene laid out.
ExpectedCost expected_cost(const forward::Scene& scene, const forward::State& state);
ExpectedCost expected_cost(const forward::Scene& scene);

/// CPU seconds that each stage took over the first steps of the cut: a measurement, not a model.
std::vector<forward::StageTime> time_stages(forward::State state, const std::vector<forward::Stage>& stages, int steps);

/// CPU seconds per particle and step, measured on a few steps of this scene.
double seconds_per_particle_step(const forward::Scene& scene);

}  // namespace kerf::commands
