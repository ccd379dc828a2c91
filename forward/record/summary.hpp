#pragma once

#include <vector>

#include "forward/record/recorder.hpp"
#include "forward/run.hpp"

namespace kerf::forward {

/// True when the cut may stop: past `not_before`, steady, and the standard error of F_c within the scene's tolerance.
bool well_enough_known(const std::vector<ForceSample>& history, const Scene& scene);

/// Means with standard errors over the steady part, branch, mode mixity, fracture energy, chip shape and picture.
void summarise(CutResult& result, const Recorder& recorder, const State& state, const Scene& scene);

}  // namespace kerf::forward
