#pragma once

#include <string>

#include "models/base/error.hpp"

namespace kerf::commands {

/// Runs scripts/report.py on `target`; an empty `output` leaves the place to the script. It prints the page's name on
/// standard output, or on standard error when that is taken by a result. Throws InputError when there is no Python or
/// no script; what else goes wrong the script has said on standard error.
ExitCode draw_report(const std::string& target, const std::string& output, bool quiet = false);

}  // namespace kerf::commands
