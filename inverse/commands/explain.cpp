#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "forward/bodies/step.hpp"
#include "forward/mpm/window.hpp"
#include "forward/plan.hpp"
#include "forward/record/cut_file.hpp"
#include "forward/record/stage_clock.hpp"
#include "forward/scene/preset.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/expected_cost.hpp"
#include "inverse/commands/job_study_session.hpp"

namespace kerf::commands {
namespace {

using forward::Scene;
using forward::State;
using Json = nlohmann::ordered_json;

constexpr double degrees = 57.29577951308232;

/// A line of the step: a stage, its sentence and its share of the time.
struct Line {
  std::string stage, does;
  double share;
};

/// What the scene does not hold, or what no scene can.
struct Absent {
  std::string block, meaning;
};
constexpr const char* never =
    "rate dependence, softening by heat, a deforming tool, a crack that leaves its plane, out-of-plane strain";

struct Explanation {
  Document document;
  Scene scene;
  State state;  ///< laid out
  std::vector<Line> step;
  bool from_run;  ///< the shares are those of a finished run, not of the first steps here and now
  std::vector<Absent> absent;
  ExpectedCost cost;
  double seconds_per_particle_step;
  Json run;  ///< what the finished run has cost
};

/// Every optional block that the document leaves out, in the words of its declaration.
std::vector<Absent> left_out(const Document& document) {
  const Contents contents = document.read(forward::scene_blocks());
  std::vector<Absent> absent;
  for (const Block& block : forward::scene_blocks())
    if (!block.required && !contents.has(block.path)) absent.push_back({block.path, block.meaning});
  return absent;
}

std::vector<Line> step_in_words(const std::vector<forward::Stage>& stages,
                                const std::vector<forward::StageTime>& times) {
  double total = 0;
  for (const forward::StageTime& time : times) total += time.seconds;
  std::vector<Line> lines;
  for (const forward::StageTime& time : times) {
    const auto stage = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.name == time.stage; });
    if (stage != stages.end())
      lines.push_back({stage->name, stage->does, time.seconds / total});
    else if (time.seconds > 0.0)
      lines.push_back({time.stage, "records, and the window follows the tool", time.seconds / total});
  }
  return lines;
}

/// Of a scene (.toml) or of a finished cut (.h5), which knows its own shares.
Explanation explanation_of(const std::string& file) {
  std::optional<forward::KeptCut> run;
  if (std::filesystem::path(file).extension() == ".h5") run = forward::read_cut(file);
  const Document document = run ? run->scene : Document::load(file);
  if (is_job(document))
    throw InputError(file + ": is a job; `kerf check` reads it, and `kerf explain` the scene that it names");
  Explanation all{.document = document,
                  .scene = forward::read_scene(document),
                  .state = {},
                  .step = {},
                  .from_run = false,
                  .absent = left_out(forward::with_preset(document)),
                  .cost = {},
                  .seconds_per_particle_step = 0,
                  .run = {}};
  all.state = forward::lay_out(all.scene);
  all.cost = expected_cost(all.scene, all.state);
  const std::vector<forward::Stage> stages = forward::plan(all.scene);
  std::vector<forward::StageTime> times;
  all.from_run = run && run->result.at("cost").contains("stages");
  if (all.from_run) {
    all.run = run->result.at("cost");
    for (const Json& time : all.run.at("stages"))
      times.push_back({time.at("stage").get<std::string>(), time.at("cpu_s").get<double>()});
  } else {
    constexpr int steps = 100;
    times = time_stages(all.state, stages, steps);
    double seconds = 0;
    for (const forward::StageTime& time : times) seconds += time.seconds;
    all.seconds_per_particle_step = seconds / steps / static_cast<double>(all.state.particles.begin[2]);
  }
  all.step = step_in_words(stages, times);
  return all;
}

std::size_t bytes_per_node(const State& state) {
  const forward::VelocityField& f = state.grid.side[0];
  const std::size_t numbers =
      f.mass.size() + f.momentum.size() + f.velocity.size() + f.change.size() + +f.force.size() + f.filtered.size();
  return 8 * (numbers / state.grid.nodes());
}

void print_cut(const Scene& scene) {
  fmt::print("{}\n\n", scene.title);
  if (scene.grips)
    fmt::print("A specimen with arms of {:g} and {:g} mm is pulled apart at {:g} m/s. The work is an\n",
               scene.cut.depth, scene.grips->lower_arm, scene.cut.speed / 1e3);
  else
    fmt::print("{} {:g} mm is {} at {:g} m/s by a rigid tool with a rake angle of {:g} deg. The work is an\n",
               scene.log ? "A veneer of" : "A layer of", scene.cut.depth, scene.log ? "peeled off a log" : "cut",
               scene.cut.speed / 1e3, scene.tool.rake * degrees);
  fmt::print("elastic-plastic solid in plane strain that separates along {}; the cohesive law passes on\n",
             scene.log ? "a spiral" : "the plane y = 0");
  fmt::print("at most {:g} MPa (mode I) and {:g} MPa (mode II), and takes {:g} and {:g} J/m^2 to break.\n\n",
             scene.cohesive.mode_I->strength(), scene.cohesive.mode_II->strength(),
             1e3 * scene.cohesive.mode_I->toughness(), 1e3 * scene.cohesive.mode_II->toughness());
}

void print_discretisation(const Scene& scene, const State& state) {
  const auto& window = scene.window;
  const int side = scene.resolution.particles_per_cell_side;
  fmt::print("Discretisation\n");
  fmt::print("  cells of {:g} mm, {} through the chip, {} x {} particles each: {} particles\n", scene.cell(),
             scene.resolution.cells_through_chip, scene.particles_along_cell(), side, state.particles.begin[2]);
  if (scene.fine_base_height() < scene.base_height())
    fmt::print("  one particle in a cell from {:g} depths under the crack plane on\n", scene.fine_base_height());
  if (scene.log)
    fmt::print("  the whole log, turning; the veneer up to {:g} depths above the tip\n", window.above);
  else
    fmt::print(
        "  window around the tip, in depths: {:g} ahead, {:g} behind, {:g} below, {:g} above; it travels along\n",
        window.ahead, window.behind, window.below, window.above);
  fmt::print("  time step {:.3g} us ({:g} of an elastic wave's transit of a cell)\n", 1e6 * state.step,
             scene.resolution.courant_number);
  // The mixed-mode zone is shorter still; this is the length over which mode I traction acts (Hillerborg).
  const double zone = laws::plane_strain_modulus(scene.material) * scene.cohesive.mode_I->toughness() /
                      std::pow(scene.cohesive.mode_I->strength(), 2);
  fmt::print("  the critical opening is {:.2g} cells, the elastic cohesive zone E'G/sigma^2 about {:.2g} cells\n\n",
             scene.cohesive.mode_I->critical_opening() / scene.cell(), zone / scene.cell());
}

void print_step(const Explanation& all) {
  fmt::print("One time step, in order (share of the time, {})\n",
             all.from_run ? "measured in this run" : "measured now on its first steps");
  int number = 0;
  for (const Line& line : all.step)
    fmt::print("  {:>2}. {:<13}{:>5.1f} %   {}\n", ++number, line.stage, 100 * line.share, line.does);
  fmt::print("\n");
}

void print_memory(State& state) {
  const auto fields = state.particles.fields();
  fmt::print("Each particle carries {} bytes, 8 for each of\n  ", 8 * fields.size());
  std::string list;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    list += fields[i].name;
    list += i + 1 == fields.size() ? "\n" : i % 4 == 3 ? ",\n  " : ", ";
  }
  fmt::print("{}Each of the {} grid nodes carries {} bytes for either side of the crack plane.\n", list,
             state.grid.nodes(), bytes_per_node(state));
  fmt::print("The crack is followed by {} pairs of markers.\n\n", state.crack.size());
}

void print_absent(const std::vector<Absent>& absent) {
  fmt::print("Not simulated, since the scene has no such block\n");
  for (const Absent& one : absent) fmt::print("  {:<16}{}\n", "[" + one.block + "]", one.meaning);
  fmt::print("Never simulated: {}\n\n", never);
}

void print_cost(const Explanation& all) {
  if (all.from_run) {
    fmt::print("Cost of this run: {} steps, {:.3g} particle-steps, {:.1f} s\n", all.run.at("steps").get<long>(),
               all.run.at("particle_steps").get<double>(), all.run.at("wall_s").get<double>());
    return;
  }
  const Scene& scene = all.scene;
  const ExpectedCost& cost = all.cost;
  fmt::print("Expected cost\n");
  if (scene.grips)
    fmt::print("  the grips move {:g} depths apart\n", scene.cut.travel);
  else if (scene.steady_state.not_before >= scene.cut.travel)
    fmt::print("  the tool travels {:g} depths\n", scene.cut.travel);
  else
    fmt::print(
        "  the cut stops between {:g} and {:g} depths of travel, once the standard error of F_c is below {:g} %\n",
        scene.steady_state.not_before, scene.cut.travel, 100 * scene.steady_state.tolerance);
  fmt::print(
      "  {:.3g} to {:.3g} steps, {:.2g} to {:.2g} particle-steps, {:.2g} to {:.2g} s at the speed measured now\n",
      cost.least_steps, cost.most_steps, cost.least, cost.most, cost.least * all.seconds_per_particle_step,
      cost.most * all.seconds_per_particle_step);
}

Json as_json(Explanation& all) {
  Json step = Json::array(), fields = Json::array(), absent = Json::array();
  for (const Line& line : all.step) step.push_back({{"stage", line.stage}, {"does", line.does}, {"share", line.share}});
  for (const auto& field : all.state.particles.fields()) fields.push_back(field.name);
  for (const Absent& one : all.absent) absent.push_back({{"block", one.block}, {"meaning", one.meaning}});
  Json json{
      {"title", all.scene.title},
      {"step", step},
      {"shares", all.from_run ? "of the run" : "of the first steps, measured now"},
      {"particle_fields", fields},
      {"bytes_per_particle", 8 * fields.size()},
      {"bytes_per_node_and_side", bytes_per_node(all.state)},
      {"particles", all.state.particles.begin[2]},
      {"marker_pairs", all.state.crack.size()},
      {"not_simulated", absent},
      {"never_simulated", never},
      {"expected",
       {{"steps", {all.cost.least_steps, all.cost.most_steps}}, {"particle_steps", {all.cost.least, all.cost.most}}}}};
  if (all.from_run)
    json["run"] = all.run;
  else
    json["expected"]["s"] = {all.cost.least * all.seconds_per_particle_step,
                             all.cost.most * all.seconds_per_particle_step};
  return json;
}

void print_preset(const Document& document) {
  const std::vector<forward::PresetSetting> settings = forward::preset_settings(document);
  if (settings.empty()) return;
  fmt::print("Preset {}\n", document.text_at("preset").value());
  for (const forward::PresetSetting& setting : settings)
    fmt::print("  {} = {}{}\n", setting.path, setting.value,
               setting.overruled ? ", but the scene's own value counts" : "");
  fmt::print("\n");
}

/// An experiment on bodies instead of a cut: its step, its memory, and what it leaves out.
void explain_bodies(const Document& document, bool json) {
  namespace bodies = forward::bodies;
  const bodies::Scene scene = bodies::read_scene(document);
  bodies::State state = bodies::lay_out(scene);
  bodies::Joint joint(state, scene);
  const std::vector<bodies::Stage> stages = bodies::plan(scene, joint);
  const Contents contents = document.read(bodies::scene_blocks());
  Json step = Json::array(), all_bodies = Json::array(), absent = Json::array();
  const double time_step = state.step;
  std::size_t points = 0;
  for (const bodies::Body& body : state.bodies) points += body.points.size();
  forward::StageClock clock(stages, 1);
  constexpr int timed = 50;
  for (int i = 0; i < timed; ++i) clock.step(state, scene.strokes[0]);
  std::vector<forward::StageTime> times = clock.times();
  double all_time = 0;
  for (const forward::StageTime& time : times) all_time += time.seconds;
  for (std::size_t i = 0; i < stages.size(); ++i)
    step.push_back(
        {{"stage", stages[i].name}, {"does", stages[i].does}, {"share", times[i].seconds / std::max(all_time, 1e-9)}});
  const double rate = timed * static_cast<double>(points) / std::max(all_time, 1e-9);
  for (const bodies::Body& body : state.bodies) {
    const std::size_t numbers = bodies::Points::mechanical_numbers + body.points.memory.size() +
                                (body.is_thermal() ? 1 : 0) +
                                (body.points.affine.xx.empty() ? 0 : bodies::Points::Affine::numbers);
    all_bodies.push_back(
        {{"law", std::visit([](const auto& law) { return std::decay_t<decltype(law)>::name(); }, body.law)},
         {"points", body.points.size()},
         {"bytes_per_point", sizeof(double) * numbers}});
  }
  for (const Block& block : bodies::scene_blocks())
    if (!block.required && !contents.has(block.path) && block.path != "numerics")
      absent.push_back({{"block", block.path}, {"meaning", block.meaning}});
  const std::string numerics = bodies::describe(scene.numerics);
  const Json whole{{"title", scene.title}, {"numerics", numerics},      {"step", step},
                   {"bodies", all_bodies}, {"time_step_s", state.step}, {"not_simulated", absent}};
  if (json) return fmt::print("{}\n", whole.dump(2));
  fmt::print("{}\n\nEvery step of {:.3g} s at the start, {:.2g} particle-steps per second: {}\n", scene.title,
             time_step, rate, numerics);
  for (const auto& line : step)
    fmt::print("  {:<12}{:>5.1f} %   {}\n", line.at("stage").get<std::string>(), 100 * line.at("share").get<double>(),
               line.at("does").get<std::string>());
  fmt::print("\nBodies\n");
  for (const auto& body : all_bodies)
    fmt::print("  {}: {} points of {} bytes\n", body.at("law").get<std::string>(), body.at("points").get<int>(),
               body.at("bytes_per_point").get<int>());
  fmt::print("\nNot simulated, because the scene does not ask for it\n");
  for (const auto& one : absent)
    fmt::print("  {:<14}{}\n", one.at("block").get<std::string>(), one.at("meaning").get<std::string>());
}

void explain(const std::string& file, bool json) {
  if (std::filesystem::path(file).extension() != ".h5")
    if (const Document document = Document::load(file); forward::bodies::has_bodies(document))
      return explain_bodies(document, json);
  Explanation all = explanation_of(file);
  if (json) return fmt::print("{}\n", as_json(all).dump(2));
  print_cut(all.scene);
  print_preset(all.document);
  print_discretisation(all.scene, all.state);
  print_step(all);
  print_memory(all.state);
  print_absent(all.absent);
  print_cost(all);
}

}  // namespace

void add_explain(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("explain", "Say in plain English what a scene makes the solver do, and its cost");
  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  command->add_option("file", *file, "a scene (.toml), or a finished cut (.h5) with the times of its own stages")
      ->required();
  command->add_flag("--json", *json, "print the same as JSON");
  command->callback([file, json, &exit_code] {
    explain(*file, *json);
    exit_code = 0;
  });
}

}  // namespace kerf::commands
