#pragma once

#include <vector>

#include "forward/mpm/state.hpp"
#include "forward/run.hpp"

namespace kerf::forward {

/// Energies of this instant, N mm/mm: what particles and springs hold, what has left with them, what was done.
Ledger take_stock(const State& state, const laws::Material& material);

/// Thickness ratio h_c/h and curvature (1/mm, positive away from the tool) of the chip between 1.25 and 2.75 depths
/// above the plane: a parabola x(y) fitted to its particles is the centre line, and their volume is the thickness times
/// its length. Velocities would tell the same with more noise.
struct ChipShape {
  double ratio, curvature;
};
ChipShape measure_chip(const State& state, double depth);

/// The state of a specimen in grips, with the energy release rate that its grips read.
Extension measure_extension(const State& state, const Scene& scene, double release);

/// Averages what every step reports over whole cell crossings of the tool: the raw force is periodic in the cell.
class Recorder {
 public:
  void add_step(const State& state);
  /// Closes the current crossing.
  void add_crossing(const State& state, const Scene& scene);

  const std::vector<ForceSample>& history() const { return history_; }
  const std::vector<ChipShape>& chip() const { return chip_; }

 private:
  ToolForce sum_;
  double steps_ = 0;
  std::vector<ForceSample> history_;
  std::vector<ChipShape> chip_;
};

}  // namespace kerf::forward
