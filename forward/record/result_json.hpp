#pragma once

#include <nlohmann/json.hpp>

#include "forward/run.hpp"

namespace kerf::forward {

/// What `kerf simulate --json` prints and a cut's file keeps as its attribute `result`. Estimates are objects
/// {"value", "se", "unit"}; plain numbers have their unit in "units". Forces in N/m, energies in J/m, lengths in mm; a
/// number that is not finite becomes null.
nlohmann::ordered_json result_json(const CutResult& result);

}  // namespace kerf::forward
