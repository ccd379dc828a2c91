#include "forward/scene/preset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "forward/scene/scene.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"
#include "models/base/units.hpp"

namespace kerf::forward {
namespace {

/// One line per knob; `kerf study` measures what each of them buys.
const std::vector<PresetKnob> knobs{
    // path                              draft   standard  reference
    {"resolution.cells_through_chip", {"4", "8", "10"}},
    {"resolution.courant_number", {"0.6", "0.75", "0.6"}},
    {"resolution.single_particle_below", {"1", "1", "100"}},
    {"steady_state.tolerance", {"0.01", "0.005", "0.002"}},
};

std::size_t place_of(std::string_view name) {
  return static_cast<std::size_t>(std::find(preset_names.begin(), preset_names.end(), name) - preset_names.begin());
}

void write(Document& scene, const char* path, const std::string& value) {
  const std::vector<Block>& known = scene_blocks();
  const Parameter parameter = Document::find_parameter(path, known, "preset");
  const std::string_view whole(path);
  if (const std::size_t dot = whole.rfind('.'); dot != whole.npos) scene.add_table(whole.substr(0, dot), known);
  if (parameter.kind != Parameter::Kind::number) return scene.set_text(path, value, known);
  const Quantity quantity = split_quantity(value);
  scene.set_number(path, in_range(quantity.number, quantity.unit.empty() ? "1" : quantity.unit, parameter), known);
}

}  // namespace

const std::vector<PresetKnob>& preset_knobs() {
  return knobs;
}

std::vector<PresetSetting> preset_settings(const Document& scene) {
  std::vector<PresetSetting> settings;
  const std::size_t place = place_of(scene.text_at("preset").value_or(""));
  if (place == preset_count) return settings;
  for (const PresetKnob& knob : knobs) settings.push_back({knob.path, knob.values[place], scene.has(knob.path)});
  return settings;
}

Document with_preset(Document scene) {
  for (const PresetSetting& setting : preset_settings(scene))
    if (!setting.overruled) write(scene, setting.path, setting.value);
  return scene;
}

void impose_preset(Document& scene, const std::string& name, std::string_view where) {
  const std::size_t place = place_of(name);
  if (place == preset_count) {
    const std::vector<std::string> names(preset_names.begin(), preset_names.end());
    const auto near = nearest(name, names);
    throw InputError(fmt::format("{}: there is no preset \"{}\"{} (allowed: {})", where, name,
                                 near ? fmt::format("; did you mean \"{}\"?", *near) : "", fmt::join(names, ", ")),
                     ExitCode::usage);
  }
  for (const PresetKnob& knob : knobs) write(scene, knob.path, knob.values[place]);
  scene.set_text("preset", name, scene_blocks());
}

}  // namespace kerf::forward
