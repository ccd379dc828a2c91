#pragma once

#include <functional>
#include <string>
#include <vector>

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// One thing done in every step. A scene without the effect has no such stage.
struct Stage {
  std::string name;
  std::string does;  ///< one plain-English sentence
  std::function<void(State&)> apply;
};

/// The ordered stages of one time step: built from the blocks the scene has. `scene` must outlive the stages.
std::vector<Stage> plan(const Scene& scene);

}  // namespace kerf::forward
