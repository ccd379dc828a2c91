// The bare kernel, the scalar reference, and the cut that runs on it. Rates are particle-steps per second of CPU time.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "forward/run.hpp"
#include "tests/bench/block.hpp"
#include "tests/bench/scalar.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::bench {
namespace {

constexpr std::size_t standard = 16384;

/// Long enough to time, short enough that the block stays on its grid.
int steps_per_sample(std::size_t particles) {
  return std::max(4, static_cast<int>(1638400 / particles));
}

void count(benchmark::State& bench, std::size_t particles) {
  const double steps = static_cast<double>(bench.iterations()) * steps_per_sample(particles);
  bench.SetItemsProcessed(static_cast<std::int64_t>(steps * static_cast<double>(particles)));
  bench.counters["particles"] = static_cast<double>(particles);
}

void kernel(benchmark::State& bench, const laws::Material& material, Flow flow) {
  const auto particles = static_cast<std::size_t>(bench.range(0));
  const forward::State start = block(material, particles, flow);
  forward::State state = start, before;
  for (int i = 0; i < steps_per_sample(particles); ++i) {
    before.particles.plastic_strain = state.particles.plastic_strain;
    kernel_step(state, material);
  }
  const double share = yielding_share(before, state);
  if (!state.breakdown.empty() || (flow == Flow::elastic ? share != 0.0 : share < 0.999))
    return bench.SkipWithError("the block does not flow as it should");
  for (auto _ : bench) {
    bench.PauseTiming();
    state = start;
    bench.ResumeTiming();
    for (int i = 0; i < steps_per_sample(particles); ++i) kernel_step(state, material);
  }
  count(bench, particles);
  bench.counters["yielding"] = share;
}

void scalar(benchmark::State& bench) {
  const laws::Material material = polymer();
  const auto& law = std::get<laws::J2<laws::LinearHardening>>(material);
  const forward::State start = block(material, standard, Flow::plastic);
  ScalarKernel<Counted> counted(start, law, pic_share());
  Counted::operations = 0;
  counted.step();
  for (auto _ : bench) {
    bench.PauseTiming();
    ScalarKernel<double> reference(start, law, pic_share());
    bench.ResumeTiming();
    for (int i = 0; i < steps_per_sample(standard); ++i) reference.step();
  }
  count(bench, standard);
  bench.counters["flops_per_particle_step"] = static_cast<double>(Counted::operations) / standard;
}

/// A shipped scene up to this travel (in depths of cut), as `kerf simulate` runs it; several side by side with
/// `Threads(n)`, one simulation each.
void cut(benchmark::State& bench, const char* scene_name, double travel) {
  const forward::Scene scene = testing::shipped(scene_name, {{"cut.travel", travel}});
  std::int64_t particle_steps = 0;
  for (auto _ : bench) particle_steps += forward::run(scene).cost.particle_steps;
  bench.SetItemsProcessed(particle_steps);
}

// What is compared stands side by side: one after the other in time.
BENCHMARK(scalar)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, j2, polymer(), Flow::plastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, hencky, hencky(), Flow::plastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, hill, wood(), Flow::plastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, j2_below_yield, polymer(), Flow::elastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, hencky_below_yield, hencky(), Flow::elastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, elastic, elastic(), Flow::elastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cut, verification_45, "verification_45", 2.0)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, hill_below_yield, wood(), Flow::elastic)->Arg(standard)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cut, wood_rl, "wood_rl", 2.0)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(kernel, scaling, polymer(), Flow::plastic)
    ->RangeMultiplier(4)
    ->Range(4096, 1048576)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cut, side_by_side, "verification_45", 1.0)
    ->ThreadRange(1, 2)
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kerf::bench
