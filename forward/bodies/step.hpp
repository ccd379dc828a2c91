#pragma once

#include <functional>
#include <string>
#include <vector>

#include "forward/bodies/interface.hpp"
#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// One thing done in every step. A scene without the effect has no such stage.
struct Stage {
  std::string name;
  std::string does;  ///< one plain-English sentence
  std::function<void(State&, const Stroke&)> apply;
};

/// The ordered stages of one explicit step, stresses first: built from the blocks that the scene has. `scene` and
/// `joint` must outlive them.
std::vector<Stage> plan(const Scene& scene, Joint& joint);

}  // namespace kerf::forward::bodies
