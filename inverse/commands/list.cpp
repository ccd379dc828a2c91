#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "data/curve.hpp"
#include "forward/bodies/scene.hpp"
#include "forward/scene/preset.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/job.hpp"
#include "models/base/error.hpp"
#include "models/base/parameter.hpp"

namespace kerf::commands {
namespace {

struct Source {
  std::string name;
  std::string meaning;
  std::vector<Block> blocks;
};

/// Everything that an input file may hold, from the declarations that read it.
std::vector<Source> sources() {
  return {{"scene", "a cut to simulate (TOML)", forward::scene_blocks()},
          {"bodies", "an experiment on bodies in a box (TOML)", forward::bodies::scene_blocks()},
          {"job", "a calibration (TOML)", inverse::job_blocks()},
          {"curve", "a measured curve (CSV); header cells carry the unit, as in depth[um]", {data::curve_columns()}}};
}

std::string heading(const Block& block) {
  if (block.path.empty()) return "top of the file";
  if (block.path == data::curve_columns().path) return "columns";
  const std::string title = block.repeated ? fmt::format("[[{}]]", block.path) : fmt::format("[{}]", block.path);
  return block.variant.empty() ? title : fmt::format("{} law = \"{}\"", title, block.variant);
}

std::string allowed(const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::number:
      return allowed_range(parameter);
    case Parameter::Kind::quantity:
      return "a number with unit";
    case Parameter::Kind::flag:
      return "true or false";
    case Parameter::Kind::text:
    case Parameter::Kind::list:
      break;
  }
  const std::string kind = parameter.kind == Parameter::Kind::list ? "list of " : "";
  if (parameter.choices.empty()) return kind + "text";
  std::string choices;
  for (const std::string& choice : parameter.choices) choices += (choices.empty() ? "" : "|") + choice;
  return kind + choices;
}

std::string default_of(const Parameter& parameter) {
  if (parameter.fallback) return *parameter.fallback;
  return parameter.optional ? "-" : "required";
}

void print(const Block& block) {
  fmt::print("{}\n  {}{}\n", heading(block), block.meaning, block.required ? "" : " (optional)");
  std::size_t key = 3, range = 7, fallback = 7;
  for (const Parameter& parameter : block.parameters) {
    key = std::max(key, parameter.key.size());
    range = std::max(range, allowed(parameter).size());
    fallback = std::max(fallback, default_of(parameter).size());
  }
  if (!block.parameters.empty())
    fmt::print("    {:{}}  {:{}}  {:{}}  {}\n", "key", key, "allowed", range, "default", fallback, "meaning");
  for (const Parameter& parameter : block.parameters)
    fmt::print("    {:{}}  {:{}}  {:{}}  {}\n", parameter.key, key, allowed(parameter), range, default_of(parameter),
               fallback, parameter.meaning);
  fmt::print("\n");
}

/// What each preset gives to each knob.
void print_presets() {
  std::size_t path = 0;
  for (const forward::PresetKnob& knob : forward::preset_knobs())
    path = std::max(path, std::string_view(knob.path).size());
  fmt::print(
      "presets\n  preset = \"NAME\" at the top of a scene gives these values to the keys that the scene leaves out;\n"
      "  `kerf simulate --preset NAME`, and preset = \"NAME\" in a job, write them over the scene's own\n");
  const auto row = [&](const char* key, const std::array<const char*, forward::preset_count>& values) {
    fmt::print("    {:{}}", key, path);
    for (const char* value : values) fmt::print("  {:>10}", value);
    fmt::print("\n");
  };
  row("key", forward::preset_names);
  for (const forward::PresetKnob& knob : forward::preset_knobs()) row(knob.path, knob.values);
  fmt::print("\n");
}

/// A family is a kind of file ("scene"), a block ("cohesive.mode_I" or "mode_I"), a group of blocks ("cohesive") or a
/// law ("j2").
bool belongs(const Source& source, const Block& block, const std::string& family) {
  return family == source.name || family == block.path || block.path.starts_with(family + ".") ||
         block.path.ends_with("." + family) || (!block.variant.empty() && family == block.variant);
}

void list(const std::string& family) {
  std::vector<std::string> families{"preset"};
  if (family == families.front()) return print_presets();
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::find(families.begin(), families.end(), name) == families.end()) families.push_back(name);
  };
  bool found = false;
  for (const Source& source : sources()) {
    add(source.name);
    bool titled = false;
    for (const Block& block : source.blocks) {
      add(block.path.substr(0, block.path.find('.')));
      add(block.path);
      add(block.variant);
      if (!family.empty() && !belongs(source, block, family)) continue;
      if (!titled) fmt::print("== {}: {}\n\n", source.name, source.meaning);
      titled = found = true;
      print(block);
    }
  }
  if (family.empty() || family == "scene") print_presets();
  if (found) return;
  const auto near = nearest(family, families);
  std::string names;
  for (const std::string& name : families) names += (names.empty() ? "" : ", ") + name;
  throw InputError(fmt::format("kerf list: there is no family \"{}\"; {}", family,
                               near ? fmt::format("did you mean \"{}\"?", *near) : "families: " + names),
                   ExitCode::usage);
}

}  // namespace

void add_list(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("list", "Print the blocks and parameters that input files may hold");
  auto* family =
      command->add_option("family", "a file (scene, bodies, job, curve), a block, a law, or preset; all if left out");
  command->callback([family, &exit_code] {
    list(family->empty() ? "" : family->as<std::string>());
    exit_code = static_cast<int>(ExitCode::success);
  });
}

}  // namespace kerf::commands
