#include "inverse/commands/expected_cost.hpp"

#include <algorithm>

#include "forward/mpm/window.hpp"
#include "forward/record/stage_clock.hpp"

namespace kerf::commands {

using forward::Scene;
using forward::Stage;
using forward::State;

std::vector<forward::StageTime> time_stages(State state, const std::vector<Stage>& stages, int steps) {
  forward::StageClock clock(stages, 1);
  for (int step = 0; step < steps; ++step) {
    clock.step(state);
    state.time += state.step;
  }
  return clock.times();
}

namespace {

/// Mean of min(travel, full) while the travel grows from zero to `longest`.
double mean_of_filling(double longest, double full) {
  return longest < full ? 0.5 * longest : full - 0.5 * full * full / longest;
}

}  // namespace

ExpectedCost expected_cost(const Scene& scene, const State& state) {
  // The ramp costs half its time.
  const auto steps_to = [&](double depths) {
    return (depths * scene.cut.depth / scene.cut.speed + 0.5 * scene.cut.ramp) / state.step;
  };
  // Behind the tool the window fills with the base, and above it with the chip, taken to be as thick as the layer.
  const auto window = scene.window;
  const double laid = window.ahead * (scene.base_height() + 1.0);
  const auto particles_until = [&](double depths) {
    const double more = scene.grips || scene.log ? 0.0
                                                 : mean_of_filling(depths, window.behind) * window.below +
                                                       mean_of_filling(depths, window.above);
    return static_cast<double>(state.particles.begin[2]) * (1.0 + more / laid);
  };
  const double least = std::min(scene.steady_state.not_before, scene.cut.travel), most = scene.cut.travel;
  return {.particles = particles_until(most),
          .least_steps = steps_to(least),
          .most_steps = steps_to(most),
          .least = steps_to(least) * particles_until(least),
          .most = steps_to(most) * particles_until(most)};
}

ExpectedCost expected_cost(const Scene& scene) {
  return expected_cost(scene, forward::lay_out(scene));
}

double seconds_per_particle_step(const Scene& scene) {
  const State state = forward::lay_out(scene);
  constexpr int steps = 50;
  double seconds = 0;
  for (const auto& stage : time_stages(state, forward::plan(scene), steps)) seconds += stage.seconds;
  return seconds / steps / static_cast<double>(state.particles.begin[2]);
}

}  // namespace kerf::commands
