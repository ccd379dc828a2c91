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

/// Lets travel and energies count from here.
void begin_here(State& state, const laws::Material& material) {
  state.tool.start = state.tool.x;
  state.work = {};
  const Ledger now = take_stock(state, material);
  state.work.retired_elastic = -now.elastic;
  state.work.retired_plastic = -now.plastic;
  state.work.retired_kinetic = -now.kinetic;
}

/// The scene as its record has to be read: a chained run has neither a ramp nor a notch behind it.
Scene as_recorded(Scene scene, bool chained) {
  if (chained) scene.cut.ramp = scene.cut.notch = 0.0;
  return scene;
}

}  // namespace

CutResult run(const Scene& scene, const std::function<bool(const Progress&)>& progress, const Chain& chain) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };

  State state = chain.from ? *chain.from : lay_out(scene);
  if (chain.from) begin_here(state, scene.material);
  const Scene recorded = as_recorded(scene, chain.from);
  const std::vector<Stage> stages = plan(scene);
  StageClock clock(stages);
  Recorder recorder;
  CutResult result;
  result.chained = chain.from;
  const double length = scene.cut.travel * scene.cut.depth;
  const double crossing = scene.grips ? length / specimen_readings : scene.cell_length();
  if (!chain.from) state.next_crossing = crossing;
  const auto travel = [&] { return state.tool.x - state.tool.start; };
  while (travel() < length) {
    clock.step(state);
    state.time += state.step;
    recorder.add_step(state);
    ++result.cost.steps;
    result.cost.particle_steps += static_cast<std::int64_t>(state.particles.begin[2]);
    if (!state.breakdown.empty()) break;
    if (state.tool.x < state.next_crossing) continue;

    state.next_crossing += crossing;
    clock.between_steps([&] {
      recorder.add_crossing(state, scene);
      if (!scene.grips) shift_window(state, scene);
    });
    if (chain.to) *chain.to = state;
    const ForceSample& last = recorder.history().back();
    if (progress && !progress({travel(), length, last.F_c, elapsed()})) {
      result.refusals.emplace_back("interrupted");
      break;
    }
    if (!std::isfinite(last.F_c) || (!scene.grips && well_enough_known(recorder.history(), recorded))) break;
  }
  if (!state.breakdown.empty())
    result.refusals.push_back(fmt::format("broke down after {:.3g} mm: {}", travel(), state.breakdown));
  result.cost.wall_seconds = elapsed();
  result.cost.stages = clock.times();
  result.cost.processor_seconds = clock.processor_seconds();
  summarise(result, recorder, state, recorded);
  judge(result, scene);
  return result;
}

const FaceResult& CutResult::face(ToolFace which) const {
  const auto found = std::find_if(faces.begin(), faces.end(), [&](const FaceResult& f) { return f.face == which; });
  if (found == faces.end()) throw std::out_of_range(std::string("this tool has no ") + forward::name(which));
  return *found;
}

}  // namespace kerf::forward
