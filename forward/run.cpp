#include "forward/run.hpp"

#include <chrono>
#include <cmath>

#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "forward/record/acceptance.hpp"
#include "forward/record/recorder.hpp"
#include "forward/record/summary.hpp"

namespace kerf::forward {

CutResult run(const Scene& scene, const std::function<bool(const Progress&)>& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };

  State state = lay_out(scene);
  const std::vector<Stage> stages = plan(scene);
  Recorder recorder;
  CutResult result;
  const double length = scene.cut.travel * scene.cut.depth;
  double next_crossing = scene.cell();
  while (state.tool.x < length) {
    for (const Stage& stage : stages) stage.apply(state);
    state.time += state.step;
    recorder.add_step(state);
    ++result.cost.steps;
    result.cost.particle_steps += static_cast<std::int64_t>(state.particles.begin[2]);
    if (state.broken_down) break;
    if (state.tool.x < next_crossing) continue;

    recorder.add_crossing(state, scene);
    next_crossing += scene.cell();
    shift_window(state, scene);
    const ForceSample& last = recorder.history().back();
    if (progress && !progress({state.tool.x, length, last.F_c, elapsed()})) {
      result.refusals.emplace_back("interrupted");
      break;
    }
    if (!std::isfinite(last.F_c) || well_enough_known(recorder.history(), scene)) break;
  }
  if (state.broken_down)
    result.refusals.emplace_back("broke down: a particle left the grid or its position is not a number");
  result.cost.wall_seconds = elapsed();
  summarise(result, recorder, state, scene);
  judge(result, scene);
  return result;
}

}  // namespace kerf::forward
