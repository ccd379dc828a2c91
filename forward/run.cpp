#include "forward/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "forward/record/acceptance.hpp"
#include "forward/record/recorder.hpp"
#include "forward/record/stage_clock.hpp"
#include "forward/record/summary.hpp"

namespace kerf::forward {
namespace {

constexpr double specimen_readings = 200;  // along the opening of a specimen

}  // namespace

CutResult run(const Scene& scene, const std::function<bool(const Progress&)>& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };

  State state = lay_out(scene);
  const std::vector<Stage> stages = plan(scene);
  StageClock clock(stages);
  Recorder recorder;
  CutResult result;
  const double length = scene.cut.travel * scene.cut.depth;
  const double crossing = scene.grips ? length / specimen_readings : scene.cell_length();
  double next_crossing = crossing;
  while (state.tool.x < length) {
    clock.step(state);
    state.time += state.step;
    recorder.add_step(state);
    ++result.cost.steps;
    result.cost.particle_steps += static_cast<std::int64_t>(state.particles.begin[2]);
    if (!state.breakdown.empty()) break;
    if (state.tool.x < next_crossing) continue;

    next_crossing += crossing;
    clock.between_steps([&] {
      recorder.add_crossing(state, scene);
      if (!scene.grips) shift_window(state, scene);
    });
    const ForceSample& last = recorder.history().back();
    if (progress && !progress({state.tool.x, length, last.F_c, elapsed()})) {
      result.refusals.emplace_back("interrupted");
      break;
    }
    if (!std::isfinite(last.F_c) || (!scene.grips && well_enough_known(recorder.history(), scene))) break;
  }
  if (!state.breakdown.empty())
    result.refusals.push_back(fmt::format("broke down after {:.3g} mm: {}", state.tool.x, state.breakdown));
  result.cost.wall_seconds = elapsed();
  result.cost.stages = clock.times();
  result.cost.processor_seconds = clock.processor_seconds();
  summarise(result, recorder, state, scene);
  judge(result, scene);
  return result;
}

const FaceResult& CutResult::face(ToolFace which) const {
  const auto found = std::find_if(faces.begin(), faces.end(), [&](const FaceResult& f) { return f.face == which; });
  if (found == faces.end()) throw std::out_of_range(std::string("this tool has no ") + forward::name(which));
  return *found;
}

}  // namespace kerf::forward
