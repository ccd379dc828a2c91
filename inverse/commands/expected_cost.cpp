#include "inverse/commands/expected_cost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// The time step once the chip's grain has turned by up to this angle.
double step_when_turned(const Scene& scene, const State& state, double angle) {
  constexpr int parts = 90;
  double step = state.step;
  if (state.particles.has_axes && !scene.grips)
    for (int k = 1; k <= parts; ++k)
      step = std::min(step, forward::stable_step(scene, std::cos(angle * k / parts), std::sin(angle * k / parts)));
  return step;
}

}  // namespace

ExpectedCost expected_cost(const Scene& scene, const State& state) {
  // The ramp costs half its time.
  const auto steps_to = [&](double depths, double step) {
    return (depths * scene.cut.depth / scene.cut.speed + 0.5 * scene.cut.ramp) / step;
  };
  // Behind the tool the window fills with the base, and above it with the chip, taken to be as thick as the layer.
  const auto window = scene.window;
  const double fine = scene.fine_base_height(), base = fine + (scene.base_height() - fine) / scene.particles_per_cell();
  const double laid = window.ahead * (base + 1.0);
  const auto particles_until = [&](double depths) {
    const double more = scene.grips || scene.log
                            ? 0.0
                            : mean_of_filling(depths, window.behind) * base + mean_of_filling(depths, window.above);
    return static_cast<double>(state.particles.begin[2]) * (1.0 + more / laid);
  };
  const double least = std::min(scene.steady_state.not_before, scene.cut.travel), most = scene.cut.travel;
  // The chip lies along the rake face, at the latest when it has grown to the window's top; at most, it curls until its
  // grain stands upright.
  constexpr double right = 0.5 * std::numbers::pi;
  const double flat = std::min(least, window.above);
  const double turned = step_when_turned(scene, state, right - scene.tool.rake);
  const double least_steps = steps_to(flat, state.step) + steps_to(least, turned) - steps_to(flat, turned);
  const double most_steps = steps_to(most, step_when_turned(scene, state, right));
  return {.particles = particles_until(most),
          .least_steps = least_steps,
          .most_steps = most_steps,
          .least = least_steps * particles_until(least),
          .most = most_steps * particles_until(most)};
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
