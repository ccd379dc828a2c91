#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
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

/// A shipped scene as its author would see it in an editor.
inline std::string shipped_text(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(std::string(KERF_SOURCE_DIR "/data/scenes/") + name + ".toml").rdbuf();
  return text.str();
}

/// With the first `from` replaced, which has to be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

}  // namespace kerf::testing
