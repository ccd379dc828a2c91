#include "forward/bodies/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "forward/bodies/closed_form.hpp"
#include "forward/bodies/measures.hpp"
#include "forward/bodies/step.hpp"
#include "forward/bodies/totals.hpp"
#include "forward/record/stage_clock.hpp"

namespace kerf::forward::bodies {
namespace {

constexpr double readings_per_length = 200;   // of the box at the start
constexpr int steps_between_time_steps = 16;  // the stable step is looked for again so often

/// Is the stroke over? `before` and `now` are the last two looks at the bodies.
class StrokeEnd {
 public:
  StrokeEnd(const Stroke& stroke, double start_time, double first_length, double start_entropy)
      : stroke_(stroke), start_time_(start_time), first_length_(first_length), start_entropy_(start_entropy) {}

  bool reached(const State& state) {
    if (state.time - start_time_ >= stroke_.longest) return true;
    if (stroke_.until_stretch) {
      const double stretch = state.piston.position / first_length_;
      if (stroke_.speed > 0 ? stretch >= *stroke_.until_stretch : stretch <= *stroke_.until_stretch) return true;
    }
    if (!stroke_.until_temperature && !stroke_.until_entropy_returns) return false;
    const Totals now = totals(state);
    const bool done =
        (stroke_.until_temperature && crosses(temperature_, now.temperature - *stroke_.until_temperature)) ||
        (stroke_.until_entropy_returns && crosses(entropy_, now.entropy - start_entropy_));
    return done;
  }

 private:
  /// Has the sign changed since the last look?
  static bool crosses(double& last, double value) {
    const bool crossed = last * value < 0.0 || (value == 0.0 && last != 0.0);
    last = value;
    return crossed;
  }

  const Stroke& stroke_;
  double start_time_, first_length_, start_entropy_;
  double temperature_ = 0, entropy_ = 0;
};

class Recorder {
 public:
  Recorder(const State& state, const Scene& scene)
      : first_(totals(state)), gravity_(scene.gravity.value_or(Place{0, 0})), last_length_(state.piston.position) {}

  void add_step(const State& state) {
    impulse_ += state.piston.force * state.step;
    if (!state.contact.rigids.empty()) {
      rigid_impulse_.x += state.contact.rigids[0].force_x * state.step;
      rigid_impulse_.y += state.contact.rigids[0].force_y * state.step;
    }
    duration_ += state.step;
  }
  bool is_due(const State& state, double spacing) const {
    return std::abs(state.piston.position - last_length_) >= spacing;
  }
  /// Reads nothing from energies that are no longer numbers; false then.
  bool read(const State& state, std::size_t stroke, std::vector<Reading>& history) {
    const Totals now = totals(state);
    if (!std::isfinite(now.kinetic + now.internal + state.damping + state.piston.work + state.time)) return false;
    history.push_back(
        {.stroke = stroke,
         .time = state.time,
         .length = state.piston.position,
         .force = duration_ > 0.0 ? impulse_ / duration_ : 0.0,
         .temperature = now.temperature,
         .stress_xx = now.stress_xx,
         .stress_yy = now.stress_yy,
         .piston_work = state.piston.work,
         .heat = state.bath.heat,
         .bath_entropy = state.bath.entropy,
         .entropy = now.entropy - first_.entropy,
         .internal = now.internal - first_.internal,
         .kinetic = now.kinetic,
         .damping = state.damping,
         .interface = state.interface_energy,
         .start_kinetic = first_.kinetic,
         .plastic_work = now.plastic_work,
         .gravity_work = gravity_.x * (now.moment_x - first_.moment_x) + gravity_.y * (now.moment_y - first_.moment_y),
         .rigid_work = state.contact.rigid_work,
         .friction_heat = state.contact.friction_heat,
         .impact = state.contact.impact,
         .warmed = state.contact.warmed,
         .velocity_x = now.momentum_x / now.mass,
         .velocity_y = now.momentum_y / now.mass,
         .rigid_force_x = duration_ > 0.0 ? rigid_impulse_.x / duration_ : 0.0,
         .rigid_force_y = duration_ > 0.0 ? rigid_impulse_.y / duration_ : 0.0});
    last_length_ = state.piston.position;
    impulse_ = duration_ = 0.0;
    rigid_impulse_ = {0, 0};
    return true;
  }
  const Totals& first() const { return first_; }

 private:
  Totals first_;
  Place gravity_;
  Place rigid_impulse_{0, 0};
  double last_length_, impulse_ = 0, duration_ = 0;
};

std::vector<BodiesResult::Pressure> pressed_nodes(const State& state) {
  std::vector<BodiesResult::Pressure> nodes;
  const ContactState::Pressed& pressed = state.contact.pressed;
  const Grid& grid = state.grid;
  if (pressed.impulse.empty() || !(state.time > pressed.since)) return nodes;
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < grid.columns; ++i)
      if (const double impulse = pressed.impulse[grid.node(i, j)]; impulse != 0.0)
        nodes.push_back({.x = grid.origin_x + i * grid.cell_x,
                         .y = grid.origin_y + j * grid.cell_y,
                         .force = impulse / (state.time - pressed.since)});
  return nodes;
}

/// What may have made a run break down.
const char* remedy(const Scene& scene) {
  if (std::holds_alternative<Linear>(scene.numerics.shape) &&
      (std::holds_alternative<Apic>(scene.numerics.transfer) || scene.numerics.stress_update == StressUpdate::last))
    return "; linear shape functions give a node that points hardly reach all of their force and hardly any mass: take "
           "spline or uGIMP";
  return "";
}

/// Refuses what no reading should be taken from.
void judge(BodiesResult& result, const Scene& scene) {
  if (result.history.empty()) return;
  double largest = 0.0, most_kinetic = 0.0;
  for (const Reading& r : result.history) {
    largest = std::max({largest, std::abs(r.piston_work), std::abs(r.heat), std::abs(r.internal),
                        std::abs(r.gravity_work), std::abs(r.rigid_work), r.start_kinetic});
    most_kinetic = std::max(most_kinetic, r.kinetic);
  }
  constexpr double most_residue = 0.01, most_moving = 0.05;
  const double residue = std::abs(result.history.back().residue());
  if (!(residue <= most_residue * largest))
    result.refusals.push_back(fmt::format("the energy ledger leaves {:.2g} % open (allowed {:.0f} %)",
                                          100 * residue / largest, 100 * most_residue));
  // Bodies that meet and part, or that move from the start, may move.
  if (!scene.contact && result.history.front().kinetic == 0.0 && !(most_kinetic <= most_moving * largest))
    result.refusals.push_back(
        fmt::format("kinetic energy reaches {:.2g} % of the largest (allowed {:.0f} %): move the "
                    "piston more slowly or damp",
                    100 * most_kinetic / largest, 100 * most_moving));
  if (result.stroke_ends.size() == scene.strokes.size()) result.measures = measure(result, scene);
}

}  // namespace

BodiesResult run(const Scene& scene, const std::function<bool(std::size_t, double)>& progress) {
  const auto begin = std::chrono::steady_clock::now();
  BodiesResult result;
  State state = lay_out(scene);
  Joint joint(state, scene);
  const std::vector<Stage> stages = plan(scene, joint);
  StageClock clock(stages);
  Recorder recorder(state, scene);
  for (const Body& body : state.bodies) result.particles += body.points.size();
  const double spacing = scene.length / readings_per_length;
  const double start_temperature = recorder.first().temperature;
  recorder.read(state, 0, result.history);

  for (std::size_t s = 0; s < scene.strokes.size() && result.refusals.empty() && state.breakdown.empty(); ++s) {
    const Stroke& stroke = scene.strokes[s];
    StrokeEnd end(stroke, state.time, scene.length, recorder.first().entropy);
    // A stroke that only waits is read in time.
    double next_in_time = state.time;
    const double wait = std::isfinite(stroke.longest) ? stroke.longest / readings_per_length : stroke.longest;
    const bool last = s + 1 == scene.strokes.size();
    const double middle = state.time + 0.5 * stroke.longest;
    while (state.breakdown.empty()) {
      if (last && scene.contact && state.contact.pressed.since == 0.0 && state.time >= middle)
        state.contact.pressed = {.impulse = {}, .since = state.time};
      const double towards = stroke.ramp > 0.0 ? 1.0 - std::exp(-state.step / stroke.ramp) : 1.0;
      state.piston.speed += towards * (stroke.speed - state.piston.speed);
      clock.step(state, stroke);
      recorder.add_step(state);
      result.particle_steps += static_cast<std::int64_t>(result.particles);
      if (result.steps == 0) result.first_step_temperature_change = totals(state).temperature - start_temperature;
      if (++result.steps % steps_between_time_steps == 0) state.step = stable_step(state, scene);
      const bool over = end.reached(state);
      if (!over && !recorder.is_due(state, spacing) && state.time < next_in_time + wait) continue;
      next_in_time = state.time;
      if (!recorder.read(state, s, result.history)) {
        if (state.breakdown.empty()) state.breakdown = "its energy is no longer a number";
        break;
      }
      if (over) {
        result.stroke_ends.push_back(result.history.size() - 1);
        break;
      }
      if (!(state.piston.position > 1e-2 * scene.length && state.piston.position < 1e2 * scene.length))
        state.breakdown = fmt::format("stroke {} passed {:.3g} times the box's length without meeting its end", s + 1,
                                      state.piston.position / scene.length);
      if (progress && !progress(s, state.piston.position / scene.length)) {
        result.refusals.emplace_back("interrupted");
        break;
      }
    }
  }
  result.pressed = pressed_nodes(state);
  if (state.breakdown.empty())
    judge(result, scene);
  else
    result.refusals.push_back(
        fmt::format("broke down after {:.3g} ms: {}{}", 1e3 * state.time, state.breakdown, remedy(scene)));
  result.accepted = result.refusals.empty();
  result.processor_seconds = clock.processor_seconds();
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

nlohmann::ordered_json cost_json(const BodiesResult& result) {
  return {{"wall_s", result.wall_seconds},
          {"processor_s", result.processor_seconds},
          {"steps", result.steps},
          {"particles", result.particles},
          {"particle_steps", result.particle_steps}};
}

nlohmann::ordered_json result_json(const BodiesResult& result, const Scene& scene) {
  nlohmann::ordered_json json;
  json["accepted"] = result.accepted;
  json["refusals"] = result.refusals;
  json["results"] = result.measures;
  const auto column = [&](const char* name, auto value) {
    auto& values = json["history"][name] = nlohmann::ordered_json::array();
    for (const Reading& reading : result.history) values.push_back(value(reading));
  };
  column("stroke", [](const Reading& r) { return r.stroke + 1; });
  column("time", [](const Reading& r) { return r.time; });
  column("length", [](const Reading& r) { return r.length; });
  column("force", [](const Reading& r) { return r.force; });
  column("stress_xx", [](const Reading& r) { return r.stress_xx; });
  column("stress_yy", [](const Reading& r) { return r.stress_yy; });
  column("temperature", [](const Reading& r) { return r.temperature; });
  column("piston_work", [](const Reading& r) { return r.piston_work; });
  column("heat", [](const Reading& r) { return r.heat; });
  column("entropy", [](const Reading& r) { return r.entropy; });
  column("internal", [](const Reading& r) { return r.internal; });
  column("kinetic", [](const Reading& r) { return r.kinetic; });
  column("damping", [](const Reading& r) { return r.damping; });
  column("interface", [](const Reading& r) { return r.interface; });
  column("plastic_work", [](const Reading& r) { return r.plastic_work; });
  column("residue", [](const Reading& r) { return r.residue(); });
  for (const auto& [name, values] : closed_forms(result, scene)) json["closed_forms"][name] = values;
  if (scene.contact) {
    column("gravity_work", [](const Reading& r) { return r.gravity_work; });
    column("rigid_work", [](const Reading& r) { return r.rigid_work; });
    column("friction_heat", [](const Reading& r) { return r.friction_heat; });
    column("warmed", [](const Reading& r) { return r.warmed; });
    column("impact", [](const Reading& r) { return r.impact; });
    column("velocity_x", [](const Reading& r) { return r.velocity_x; });
    column("velocity_y", [](const Reading& r) { return r.velocity_y; });
    column("rigid_force_x", [](const Reading& r) { return r.rigid_force_x; });
    column("rigid_force_y", [](const Reading& r) { return r.rigid_force_y; });
    for (const BodiesResult::Pressure& node : result.pressed) {
      json["pressed"]["x"].push_back(node.x);
      json["pressed"]["y"].push_back(node.y);
      json["pressed"]["force"].push_back(node.force);
    }
  }
  json["units"] = {{"time", "s"},        {"length", "mm"},        {"force", "N/mm"},         {"stress", "MPa"},
                   {"temperature", "K"}, {"energies", "N mm/mm"}, {"entropy", "N mm/(mm K)"}};
  json["cost"] = cost_json(result);
  return json;
}

}  // namespace kerf::forward::bodies
