#pragma once

#include "inverse/folder.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// What goes to standard output.
enum class Show { table, json, nothing };

/// Runs or continues the calibration in `folder` and writes what it finds there: result.json, manifest.json,
/// reduction.json, cuts/NNN.h5 and .json. Progress goes to standard error. Every run is a process of its own (see
/// inverse/child_runs.hpp). Ctrl-C, a stop file and `max_seconds` (0: none) abandon the runs under way; what is known
/// by then becomes a partial result.json, and standard error says how to go on.
ExitCode run_session(inverse::Folder& folder, const std::string& code, Show show, double max_seconds = 0);

}  // namespace kerf::commands
