#include "inverse/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kerf::inverse {
namespace {

using Json = nlohmann::ordered_json;

std::string cell_text(const Json& cell) {
  if (cell.is_null()) return "";
  if (cell.is_number_float()) return fmt::format("{}", cell.get<double>());
  if (!cell.is_string()) return cell.dump();
  auto text = cell.get<std::string>();
  if (text.find_first_of(",;\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

std::string Column::heading() const {
  return unit == "1" ? name : fmt::format("{}[{}]", name, unit);
}

std::string csv(const std::vector<Column>& columns) {
  std::vector<std::string> cells;
  cells.reserve(columns.size());
  for (const Column& column : columns) cells.push_back(cell_text(column.heading()));
  std::string csv = fmt::format("{}\n", fmt::join(cells, ","));
  for (std::size_t row = 0; row < columns.front().cells.size(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) cells[c] = cell_text(columns[c].cells[row]);
    csv += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return csv;
}

}  // namespace kerf::inverse
