#pragma once

#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// The tool's edge takes away the bonds that it has passed: those whose lower end lies behind the front of the tool at
/// the height of their upper end. What they have not spent yet is never spent, and the ledger shows it.
void cut_bonds(State& state, const Scene& scene);

}  // namespace kerf::forward
