#include "inverse/commands/expected_cost.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "forward/mpm/window.hpp"

namespace kerf::commands {

using forward::Scene;
using forward::Stage;
using forward::State;

std::vector<double> time_stages(State& state, const std::vector<Stage>& stages, int steps) {
  std::vector<double> seconds(stages.size(), 0.0);
  for (int step = 0; step < steps; ++step) {
    for (std::size_t i = 0; i < stages.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      stages[i].apply(state);
      seconds[i] += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    state.time += state.step;
  }
  return seconds;
}

ExpectedCost expected_cost(const Scene& scene, const State& state) {
  // The ramp costs half its time.
  const auto steps_to = [&](double depths) {
    return (depths * scene.cut.depth / scene.cut.speed + 0.5 * scene.cut.ramp) / state.step;
  };
  return {.particles = static_cast<double>(state.particles.begin[2]),
          .least_steps = steps_to(std::min(scene.steady_state.not_before, scene.cut.travel)),
          .most_steps = steps_to(scene.cut.travel)};
}

ExpectedCost expected_cost(const Scene& scene) {
  return expected_cost(scene, forward::lay_out(scene));
}

double seconds_per_particle_step(const Scene& scene) {
  State state = forward::lay_out(scene);
  constexpr int steps = 50;
  const std::vector<double> stages = time_stages(state, forward::plan(scene), steps);
  return std::accumulate(stages.begin(), stages.end(), 0.0) / steps / static_cast<double>(state.particles.begin[2]);
}

}  // namespace kerf::commands
