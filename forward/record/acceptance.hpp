#pragma once

#include "forward/run.hpp"

namespace kerf::forward {

/// Blow-ups, torn layers and false branches give smooth, believable forces. These tests tell them apart; each failed
/// one adds a sentence with its number to `result.refusals`, and `accepted` is set when there is none.
void judge(CutResult& result, const Scene& scene);

}  // namespace kerf::forward
