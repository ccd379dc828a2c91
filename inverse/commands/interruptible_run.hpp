#pragma once

#include "forward/run.hpp"

namespace kerf::commands {

/// forward::run that Ctrl-C stops (see StopOnInterrupt): throws inverse::Interrupted instead of returning half a cut.
forward::CutResult run_unless_interrupted(const forward::Scene& scene);

}  // namespace kerf::commands
