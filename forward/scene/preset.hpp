#pragma once

#include <array>
#include <string>
#include <vector>

#include "models/base/document.hpp"

namespace kerf::forward {

/// A preset says with one word what accuracy may cost: it gives values to numerical knobs of a scene, never to physics.
inline constexpr std::size_t preset_count = 3;
inline constexpr std::array<const char*, preset_count> preset_names{"draft", "standard", "reference"};

/// A knob and its value under each preset, written as in a scene.
struct PresetKnob {
  const char* path;
  std::array<const char*, preset_count> values;
};

const std::vector<PresetKnob>& preset_knobs();

/// What the scene's `preset` asks of one knob.
struct PresetSetting {
  const char* path;
  const char* value;
  bool overruled;  ///< the scene holds this key itself, and that counts
};

/// Empty when the scene names no preset, or none that there is (which its reader refuses).
std::vector<PresetSetting> preset_settings(const Document& scene);

/// The scene with the knobs that its preset sets and it does not hold itself. Without a preset: the scene.
Document with_preset(Document scene);

/// Writes a preset over the scene's own keys, as the command line and jobs do. Throws InputError (usage), beginning
/// with `where`, when there is no such preset.
void impose_preset(Document& scene, const std::string& name, std::string_view where);

}  // namespace kerf::forward
