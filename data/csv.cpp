#include "data/csv.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "models/base/error.hpp"

namespace kerf::data {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view no_break_space = "\xC2\xA0";

[[noreturn]] void refuse(const std::string& name, int line, int column, std::string_view what) {
  throw InputError(fmt::format("{}:{}:{}: {}", name, line, column, what));
}

/// Number of bytes of the UTF-8 character at the front of `text`; 0 when there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool outside_unicode = (lead == 0xED && byte(1) >= 0xA0) || (lead == 0xF4 && byte(1) >= 0x90);
  return overlong || outside_unicode ? 0 : length;
}

std::string_view strip(std::string_view text) {
  constexpr std::string_view spaces[] = {" ", "\t", no_break_space};
  for (bool found = true; found;) {
    found = false;
    for (const std::string_view space : spaces) {
      if (text.starts_with(space)) {
        text.remove_prefix(space.size());
        found = true;
      }
      if (text.ends_with(space)) {
        text.remove_suffix(space.size());
        found = true;
      }
    }
  }
  return text;
}

/// One line of the file, read cell by cell.
class LineReader {
 public:
  LineReader(std::string_view text, int line, const std::string& name) : rest_(text), line_(line), name_(name) {}

  std::vector<Cell> cells(char separator) {
    std::vector<Cell> cells{next_cell(separator)};
    while (!rest_.empty()) {
      advance();  // the separator
      cells.push_back(next_cell(separator));
    }
    return cells;
  }

 private:
  /// Steps over one character and returns it.
  std::string_view advance() {
    const std::size_t length = character_length(rest_);
    const auto byte = static_cast<unsigned char>(rest_.front());
    if (length == 0)
      refuse(name_, line_, column_, fmt::format("byte 0x{:02X} is not UTF-8 text; save the file as UTF-8", byte));
    if ((byte < 0x20 && byte != '\t') || byte == 0x7F)
      refuse(name_, line_, column_, fmt::format("control character 0x{:02X}; a text file belongs here", byte));
    const std::string_view character = rest_.substr(0, length);
    rest_.remove_prefix(length);
    ++column_;
    return character;
  }

  bool at_space(char separator) const {
    return rest_.starts_with(' ') || (separator != '\t' && rest_.starts_with('\t')) ||
           rest_.starts_with(no_break_space);
  }

  Cell next_cell(char separator) {
    while (at_space(separator)) advance();
    Cell cell{"", line_, column_};
    if (rest_.starts_with('"')) {
      cell.text = strip(quoted_text());
      while (at_space(separator)) advance();
      if (!rest_.empty() && rest_.front() != separator)
        refuse(name_, line_, column_,
               fmt::format("text follows the closing quote; the separator here is {}",
                           separator == '\t' ? "a tab" : fmt::format("'{}'", separator)));
      return cell;
    }
    while (!rest_.empty() && rest_.front() != separator) cell.text += advance();
    cell.text = strip(cell.text);
    return cell;
  }

  std::string quoted_text() {
    const int opening = column_;
    std::string text;
    for (advance(); !rest_.empty();) {
      if (rest_.starts_with("\"\"")) {
        advance();
        text += advance();
      } else if (rest_.starts_with('"')) {
        advance();
        return text;
      } else {
        text += advance();
      }
    }
    refuse(name_, line_, opening, "this quote is not closed on its line");
  }

  std::string_view rest_;
  int line_;
  int column_ = 1;
  const std::string& name_;
};

char separator_of(std::string_view header) {
  bool in_quotes = false;
  bool semicolon = false;
  for (const char c : header) {
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == '\t') return '\t';
    if (c == ';') semicolon = true;
  }
  return semicolon ? ';' : ',';
}

/// A comment's text; spreadsheets put a comment that holds separators in quotes and pad it with separators.
std::string comment_text(std::string_view line) {
  const bool in_quotes = line.starts_with('"');
  line.remove_prefix(in_quotes ? 2 : 1);
  while (!line.empty() && (line.back() == ',' || line.back() == ';' || line.back() == '\t' || line.back() == ' '))
    line.remove_suffix(1);
  if (in_quotes && line.ends_with('"')) line.remove_suffix(1);
  return std::string(line);
}

bool is_blank(const std::vector<Cell>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const Cell& cell) { return cell.text.empty(); });
}

void drop_empty_end(std::vector<Cell>& cells, std::size_t keep) {
  while (cells.size() > keep && cells.back().text.empty()) cells.pop_back();
}

}  // namespace

Csv split_csv(std::string_view text, const std::string& name) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    refuse(name, 1, 1, "this is UTF-16 text; save the file as UTF-8");
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());

  Csv csv;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + (text.substr(end).starts_with("\r\n") ? 2 : 1), text.size()));

    const std::string_view content = strip(line);
    if (content.starts_with('#') || content.starts_with("\"#")) {
      const auto indent = static_cast<int>(content.data() - line.data());
      csv.comments.push_back({comment_text(content), number, indent + (content.front() == '"' ? 3 : 2)});
      continue;
    }
    if (csv.header.empty()) csv.separator = separator_of(line);
    std::vector<Cell> cells = LineReader(line, number, name).cells(csv.separator);
    if (is_blank(cells)) continue;
    drop_empty_end(cells, csv.header.size());
    if (!csv.header.empty() && cells.size() != csv.header.size())
      refuse(name, number, cells.back().column,
             fmt::format("this row has {} cells where the header names {} columns{}", cells.size(), csv.header.size(),
                         csv.separator == ',' && cells.size() > csv.header.size()
                             ? "; decimal commas need semicolons between the cells"
                             : ""));
    if (csv.header.empty())
      csv.header = std::move(cells);
    else
      csv.rows.push_back(std::move(cells));
  }
  return csv;
}

}  // namespace kerf::data
