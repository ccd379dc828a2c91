#pragma once

#include "inverse/scene_folder.hpp"
#include "inverse/sweep.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// Runs or continues the sweep in `folder` and writes what it finds there: sweep.csv, sweep.json, sweep.h5, and the
/// report with its figures (*.svg). Results go to standard output, progress to standard error. Ctrl-C abandons the runs
/// under way, leaves a valid journal and a table of what there is, and says how to go on.
ExitCode run_sweep(inverse::SceneFolder& folder, const inverse::Sweep& sweep, const std::string& code, bool json);

/// The sweep that a folder's request asks for.
inverse::Sweep sweep_in(const inverse::SceneFolder& folder);

}  // namespace kerf::commands
