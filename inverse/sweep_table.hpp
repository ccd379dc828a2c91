#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "inverse/run_record.hpp"
#include "inverse/sweep.hpp"
#include "inverse/table.hpp"
#include "models/chip/measured_cut.hpp"
#include "models/chip/reduction.hpp"

namespace kerf::inverse {

/// One record per run of a sweep; none: not run yet.
using SweepRecords = std::vector<std::optional<RunRecord>>;

/// Every run is a row, refused ones with their verdict: the swept values, what one looks at first, and then every other
/// number that forward::result_json holds.
std::vector<Column> sweep_columns(const Sweep& sweep, const SweepRecords& records);

/// F_c of runs that differ in the depth of cut only, extrapolated to zero depth as `kerf reduce` does it. The forces
/// count as if they were measured without known errors: the scatter about each fit sets its interval, because the
/// errors of simulated forces are far smaller than what an extrapolation gets wrong.
struct SweepIntercepts {
  std::vector<std::size_t> line;             ///< all runs along the depth
  std::vector<std::size_t> runs;             ///< those of them that were accepted
  std::string held;                          ///< what is the same in all of them: "rake = 30 deg"; may be empty
  double toughness_I = 0, toughness_II = 0;  ///< that were put into the scene, N/mm
  std::string not_applied;                   ///< empty, or why there is nothing to extrapolate
  std::optional<chip::Measurements> cuts;
  chip::Reduction reduction;
  std::vector<std::string> warnings;
};

/// One for each line along the depth of cut; none when that is not swept.
std::vector<SweepIntercepts> sweep_intercepts(const Sweep& sweep, const SweepRecords& records);

/// What goes into sweep.json beside the table.
struct SweepCost {
  double wall_seconds = 0;
  std::size_t simulated = 0;  ///< by this process
};

nlohmann::ordered_json sweep_json(const Sweep& sweep, const SweepRecords& records,
                                  const std::vector<SweepIntercepts>& intercepts, const SweepCost& cost,
                                  const nlohmann::ordered_json& manifest);

}  // namespace kerf::inverse
