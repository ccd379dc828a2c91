#pragma once

#include <string>

#include "forward/bodies/run.hpp"

namespace kerf::forward::bodies {

/// What becomes of a scene of bodies.
inline BodiesResult result_of(const std::string& text) {
  return run(read_scene(Document::parse(text, "scene.toml")));
}

/// A number that the scene is for.
inline double number(const BodiesResult& result, const char* name) {
  return result.measures.at(name).get<double>();
}

}  // namespace kerf::forward::bodies
