#pragma once

#include <vector>

#include "forward/mpm/state.hpp"
#include "forward/scene/spiral.hpp"

namespace kerf::forward {

/// The spindle of a lathe: the log's core is held as a rigid body that turns, keeps pace with the tool and is fed
/// towards it. Its work on the log is part of the tool's (in the lathe's frame it is all of it: the knife stands
/// still).
class Spindle {
 public:
  explicit Spindle(const Scene& scene);
  /// Before strains are read off the grid: the core's nodes move with the spindle.
  void turn(State& state);
  /// Before forces become accelerations: whatever the core's nodes lack comes from the spindle.
  void drive(State& state) const;

 private:
  struct Held {
    std::size_t node;
    double velocity_x, velocity_y;
  };
  Spiral spiral_;
  double core_;  ///< radius up to which nodes are held, mm
  std::vector<Held> held_;
};

}  // namespace kerf::forward
