#pragma once

#include <string>
#include <utility>
#include <vector>

#include "forward/scene/scene.hpp"

namespace kerf::testing {

/// A shipped scene with some of its keys replaced: {{"cut.depth", 0.5}, ...} in consistent units.
inline forward::Scene shipped(const std::string& name,
                              const std::vector<std::pair<std::string, double>>& changes = {}) {
  Document document = Document::load(std::string(KERF_SOURCE_DIR "/data/scenes/") + name + ".toml");
  for (const auto& [path, value] : changes) document.set_number(path, value, forward::scene_blocks());
  return forward::read_scene(document);
}

}  // namespace kerf::testing
