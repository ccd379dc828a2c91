#pragma once

#include "inverse/sweep_folder.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// Runs or continues the sweep in `folder` and writes what it finds there: sweep.csv, sweep.json, sweep.h5, and the
/// report with its figures (*.svg). Results go to standard output, progress to standard error. Ctrl-C abandons the runs
/// under way, leaves a valid journal and a table of what there is, and says how to go on.
ExitCode run_sweep(inverse::SweepFolder& folder, const std::string& code, bool json);

/// How many runs, and what they will cost.
void print_sweep_cost(const inverse::Sweep& sweep, int jobs);

}  // namespace kerf::commands
