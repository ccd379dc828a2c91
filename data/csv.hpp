#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kerf::data {

/// A piece of text with the place where it begins; columns count characters from 1.
struct Cell {
  std::string text;
  int line = 1;
  int column = 1;
};

/// A CSV file taken apart into cells, without any idea of what they mean.
struct Csv {
  char separator = ',';
  std::vector<Cell> comments;  ///< what follows the `#`, in file order
  std::vector<Cell> header;    ///< first line that is neither blank nor a comment
  std::vector<std::vector<Cell>> rows;
};

/// Accepts a byte-order mark, LF, CRLF and CR line ends, quoted cells, blank lines, and separators at the end of a
/// line; the separator (tab, semicolon or comma) is the one that the header uses. Throws InputError
/// (`name`:line:column) for bytes that are not UTF-8 text, for unbalanced quotes and for rows that are longer or
/// shorter than the header.
Csv split_csv(std::string_view text, const std::string& name);

}  // namespace kerf::data
