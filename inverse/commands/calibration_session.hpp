#pragma once

#include "inverse/folder.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// What goes to standard output.
enum class Show { table, json, nothing };

/// Runs or continues the calibration in `folder` and writes what it finds there: result.json, manifest.json,
/// reduction.json, cuts/NNN.h5 and .json. Progress goes to standard error. Ctrl-C abandons the runs under way, leaves a
/// valid journal and says how to go on.
ExitCode run_session(inverse::Folder& folder, const std::string& code, Show show);

}  // namespace kerf::commands
