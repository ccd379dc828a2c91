#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "inverse/sweep_table.hpp"

namespace kerf::inverse {

/// sweep.h5, for those who go on computing:
///   /columns/NAME    the columns of the table with their attribute `unit`; numbers (NaN: not known) or strings
///   /runs/NNN        the force history of that run with its ledger, copied from the file of the cut where there is one
///   attributes       title, code_version, scene (canonical text)
/// The file appears whole or not at all. `cut_files` are one per row, whether they exist or not.
void write_sweep(const std::filesystem::path& h5, const Sweep& sweep, const std::vector<Column>& columns,
                 const std::vector<std::filesystem::path>& cut_files);

}  // namespace kerf::inverse
