#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace kerf::inverse {

/// A column of a table; cells are numbers, words, booleans, or null for what a row does not have.
struct Column {
  std::string name;
  std::string unit = "1";
  std::vector<nlohmann::ordered_json> cells;

  std::string heading() const;  ///< "F_c[N/m]"
};

/// The unit in the header, empty cells for what is not known. All columns are of one length.
std::string csv(const std::vector<Column>& columns);

}  // namespace kerf::inverse
