#include "data/r_curve.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "data/csv.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf::data {
namespace {

constexpr std::array names{"crack_extension", "G", "G_sd"};
constexpr std::array units{"mm", "J/m^2", "J/m^2"};

struct Column {
  std::optional<std::size_t> index;
  double one = 1;  ///< consistent units in the column's unit
};

[[noreturn]] void refuse(const std::string& name, const Cell& at, const std::string& what) {
  throw InputError(fmt::format("{}:{}:{}: {}", name, at.line, at.column, what));
}

double number(const std::string& name, const Cell& cell) {
  double value = 0;
  const char* end = cell.text.data() + cell.text.size();
  const auto [stop, error] = std::from_chars(cell.text.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    refuse(name, cell, fmt::format("\"{}\" is not a number", cell.text));
  return value;
}

}  // namespace

std::vector<ResistanceRow> parse_r_curve(std::string_view text, const std::string& name) {
  const Csv csv = split_csv(text, name);
  if (csv.header.empty()) refuse(name, {}, "the file has no header line with column names");
  std::array<Column, names.size()> columns;
  for (std::size_t i = 0; i < csv.header.size(); ++i) {
    const Cell& title = csv.header[i];
    const std::size_t bracket = title.text.find('[');
    const std::string key = title.text.substr(0, bracket);
    std::size_t c = 0;
    while (c < names.size() && key != names[c]) ++c;
    if (c == names.size())
      refuse(name, title, fmt::format("there is no column \"{}\"; an R-curve has crack_extension, G and G_sd", key));
    if (columns[c].index) refuse(name, title, fmt::format("the column {} is there twice", key));
    if (bracket == std::string::npos || title.text.back() != ']')
      refuse(name, title, fmt::format("{} has no unit; write {}[{}]", key, key, units[c]));
    const std::string unit = title.text.substr(bracket + 1, title.text.size() - bracket - 2);
    try {
      if (!same_dimension(unit, units[c])) refuse(name, title, fmt::format("{} is not measured in {}", key, unit));
      columns[c] = {.index = i, .one = consistent_units_in(unit)};
    } catch (const std::invalid_argument& error) {
      refuse(name, title, error.what());
    }
  }
  for (const std::size_t c : {0, 1})
    if (!columns[c].index) refuse(name, csv.header.front(), fmt::format("the column \"{}\" is missing", names[c]));
  std::vector<ResistanceRow> rows;
  for (const auto& cells : csv.rows) {
    const auto value = [&](std::size_t c) { return number(name, cells[*columns[c].index]) * columns[c].one; };
    ResistanceRow row{
        .extension = value(0), .line = static_cast<int>(cells[*columns[0].index].line), .G = value(1), .sd = {}};
    if (columns[2].index) row.sd = value(2);
    if (row.extension < 0) refuse(name, cells[*columns[0].index], "a crack's extension is not below zero");
    if (row.G <= 0) refuse(name, cells[*columns[1].index], "an energy release rate is above zero");
    if (row.sd && *row.sd <= 0) refuse(name, cells[*columns[2].index], "a standard deviation is above zero");
    rows.push_back(row);
  }
  if (rows.size() < 3) refuse(name, csv.header.front(), "three unknowns want at least three rows");
  return rows;
}

std::vector<ResistanceRow> read_r_curve(const std::filesystem::path& file) {
  return parse_r_curve(read_file(file), file.string());
}

}  // namespace kerf::data
