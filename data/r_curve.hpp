#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::data {

/// One row of a measured R-curve.
struct ResistanceRow {
  double extension = 0;      ///< of the crack, mm
  int line = 0;              ///< of the file
  double G = 0;              ///< energy release rate, N/mm
  std::optional<double> sd;  ///< N/mm
};

/// Reads a CSV file with the columns crack_extension[mm], G[J/m^2] and, optionally, G_sd[J/m^2], in any order and any
/// unit of the same kind. Throws InputError with file:line:column.
std::vector<ResistanceRow> read_r_curve(const std::filesystem::path& file);
std::vector<ResistanceRow> parse_r_curve(std::string_view text, const std::string& name);

}  // namespace kerf::data
