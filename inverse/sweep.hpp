#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "inverse/run_database.hpp"
#include "inverse/sweep_axis.hpp"
#include "models/base/document.hpp"

namespace kerf::inverse {

/// One scene of a sweep.
struct SweepRun {
  std::vector<std::size_t> choice;  ///< of each axis, the index of its value
  Document scene;
  std::string label;  ///< "depth = 0.25 mm, rake = 30 deg"
};

/// A scene and all its variants: virtual experiments.
struct Sweep {
  Document scene;
  std::vector<SweepAxis> axes;
  bool zip = false;            ///< values are paired, a single one holds for all; else every value meets every other
  std::vector<SweepRun> runs;  ///< the last axis changes fastest

  const SweepValue& value(const SweepRun& run, std::size_t axis) const { return axes[axis].values[run.choice[axis]]; }
};

/// Lays out the variants of `scene`. `axes` are as on the command line (see parse_axis). A value with which no variant
/// can be read is an error; a single combination that its reader refuses stays a run, whose result is that refusal.
/// Throws InputError.
Sweep lay_out_sweep(const Document& scene, const std::vector<std::string>& axes, bool zip, std::string_view where);

std::vector<RunRequest> requests_of(const Sweep& sweep);

/// Runs that differ in axis `axis` only, in order of appearance; with `zip` all of them, since nothing else is held.
std::vector<std::vector<std::size_t>> lines_along(const Sweep& sweep, std::size_t axis);

}  // namespace kerf::inverse
