#include "data/curve.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "data/csv.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"
#include "models/base/units.hpp"

namespace kerf::data {
namespace {

constexpr std::string_view force_unit = "N";  // beside the force per unit width that the columns declare

bool is_force(const Parameter& column) {
  return column.unit == "N/mm";
}

/// Quantities that may stand once, in a line `#: rake = 15 deg`, because they belong to the set-up and not to a row.
bool may_be_constant(const std::string& key) {
  static const std::set<std::string> keys{"width", "rake", "speed", "tool_radius", "specimen", "repeats"};
  return keys.contains(key);
}

/// What people write where nothing was measured.
bool is_absent(std::string_view cell) {
  static const std::vector<std::string> words{"", "-", "nan", "na", "n/a", "#n/a", "null", "none"};
  std::string lower(cell);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(words.begin(), words.end(), lower) != words.end();
}

/// The spelling of a number that the rest of the program reads: a hyphen for the typographic minus.
std::string plain_number(std::string text) {
  constexpr std::string_view minus = "\xE2\x88\x92";
  if (text.starts_with(minus)) text.replace(0, minus.size(), "-");
  return text;
}

class CurveReader {
 public:
  CurveReader(std::string_view text, const std::string& name) : name_(name), csv_(split_csv(text, name)) {}

  Curve read() {
    read_header();
    read_constants();
    check_columns();
    Curve curve;
    curve.name = name_;
    std::vector<int> skipped;
    for (const auto& row : csv_.rows) {
      if (is_absent(cell(row, "Fc").text) && is_absent(cell(row, "Ft").text))
        skipped.push_back(row.front().line);
      else
        curve.points.push_back(read_point(row));
    }
    if (!skipped.empty())
      curve.notes.push_back(fmt::format("left out for want of forces: line {}", fmt::join(skipped, ", ")));
    if (curve.points.empty()) refuse(header_, "there is no row with forces below this header");
    sort_by_depth(curve);
    number_replicates(curve);
    return curve;
  }

 private:
  struct Column {
    const Parameter* parameter = nullptr;
    std::string unit;       ///< as the header writes it; "1" for pure numbers
    std::size_t index = 0;  ///< in a row, unless `constant` holds the value
    std::optional<Cell> constant;
    std::string title() const { return unit == "1" ? parameter->key : fmt::format("{}[{}]", parameter->key, unit); }
  };

  [[noreturn]] void refuse(const Cell& at, std::string_view what) const {
    throw InputError(fmt::format("{}:{}:{}: {}", name_, at.line, at.column, what));
  }

  static const Parameter* find_parameter(std::string_view key) {
    for (const Parameter& parameter : curve_columns().parameters)
      if (parameter.key == key) return &parameter;
    return nullptr;
  }

  const Parameter& known_column(const Cell& at, const std::string& key) const {
    if (const Parameter* parameter = find_parameter(key)) return *parameter;
    std::vector<std::string> keys;
    for (const Parameter& parameter : curve_columns().parameters) keys.push_back(parameter.key);
    const auto near = nearest(key, keys);
    refuse(at, fmt::format("there is no column \"{}\"; {}", key,
                           near ? fmt::format("did you mean \"{}\"?", *near)
                                : fmt::format("known columns: {}", fmt::join(keys, ", "))));
  }

  void read_header() {
    if (csv_.header.empty()) refuse({"", 1, 1}, "the file has no header line with column names");
    header_ = csv_.header.front();
    if (csv_.header.size() == 1)
      refuse(header_, "the header has one column only; separate the cells by commas, semicolons or tabs");
    for (std::size_t i = 0; i < csv_.header.size(); ++i) {
      const Cell& title = csv_.header[i];
      if (title.text.empty()) refuse(title, fmt::format("column {} has no name", i + 1));
      const std::size_t bracket = title.text.find('[');
      if (bracket != title.text.npos && !title.text.ends_with(']'))
        refuse(title, fmt::format("\"{}\" lacks the closing bracket of its unit", title.text));
      const std::string key = title.text.substr(0, title.text.find_last_not_of(' ', bracket - 1) + 1);
      const Parameter& parameter = known_column(title, bracket == title.text.npos ? title.text : key);
      const std::string unit =
          bracket == title.text.npos ? "" : title.text.substr(bracket + 1, title.text.size() - bracket - 2);
      if (!columns_.emplace(parameter.key, Column{&parameter, checked_unit(title, parameter, unit), i, {}}).second)
        refuse(title, fmt::format("the column \"{}\" stands twice", parameter.key));
    }
  }

  std::string checked_unit(const Cell& title, const Parameter& parameter, const std::string& unit) const {
    if (parameter.kind == Parameter::Kind::text || parameter.unit == "1") {
      if (!unit.empty() && unit != "1" && unit != "-")
        refuse(title, fmt::format("\"{}\" has no unit; write {}", title.text, parameter.key));
      return "1";
    }
    const std::string wanted = is_force(parameter) ? fmt::format("{0}[N] or {0}[N/mm]", parameter.key)
                                                   : fmt::format("{}[{}]", parameter.key, parameter.unit);
    if (unit.empty()) refuse(title, fmt::format("the column \"{}\" lacks its unit; write {}", parameter.key, wanted));
    try {
      if (same_dimension(unit, parameter.unit) || (is_force(parameter) && same_dimension(unit, force_unit)))
        return unit;
    } catch (const std::invalid_argument& error) {
      refuse(title, fmt::format("{}{}", error.what(), unit_hint(unit, parameter.unit)));
    }
    refuse(title, fmt::format("\"{}\" does not measure this; write {}", unit, wanted));
  }

  void read_constants() {
    for (const Cell& comment : csv_.comments) {
      if (!comment.text.starts_with(':')) continue;
      const auto [key, value] = key_and_value(comment);
      const Parameter& parameter = known_column(comment, key);
      if (!may_be_constant(key)) refuse(comment, fmt::format("\"{}\" differs from row to row; it needs a column", key));
      if (columns_.contains(key)) refuse(comment, fmt::format("\"{}\" is given twice", key));
      columns_.emplace(key, Column{&parameter, "1", 0, Cell{value, comment.line, comment.column}});
    }
  }

  std::pair<std::string, std::string> key_and_value(const Cell& comment) const {
    const auto strip = [](std::string text) {
      text.erase(0, text.find_first_not_of(" \t"));
      text.erase(text.find_last_not_of(" \t") + 1);
      return text;
    };
    const std::size_t equals = comment.text.find('=');
    if (equals == comment.text.npos)
      refuse(comment, "a line that begins with #: gives a constant, such as `#: rake = 15 deg`");
    return {strip(comment.text.substr(1, equals - 1)), strip(comment.text.substr(equals + 1))};
  }

  /// What one column alone cannot tell: is everything there that the others need?
  void check_columns() const {
    for (const Parameter& parameter : curve_columns().parameters) {
      if (parameter.optional || parameter.fallback || columns_.contains(parameter.key)) continue;
      const bool constant = may_be_constant(parameter.key);
      refuse(header_,
             fmt::format("the column \"{}\" is missing ({}){}", parameter.key, parameter.meaning,
                         constant ? fmt::format("; a line `#: {} = 15 deg` serves as well", parameter.key) : ""));
    }
    for (const std::string shape : {"chip_ratio", "curl_radius"})
      if (columns_.contains(shape + "_sd") && !columns_.contains(shape))
        refuse(csv_.header[columns_.at(shape + "_sd").index], fmt::format("there is a {0}_sd but no {0}", shape));
    for (const char* force : {"Fc", "Ft", "Fc_sd", "Ft_sd"})
      if (const auto column = columns_.find(force);
          column != columns_.end() && !columns_.contains("width") && same_dimension(column->second.unit, force_unit))
        refuse(
            csv_.header[column->second.index],
            fmt::format("{} is a force, so the width of cut is needed; add a column width[mm] or a line `#: width = 1 "
                        "mm`, or give the force per width as {}[N/mm]",
                        column->second.title(), force));
  }

  const Cell& cell(const std::vector<Cell>& row, const std::string& key) const {
    const Column& column = columns_.at(key);
    return column.constant ? *column.constant : row[column.index];
  }

  bool given(const std::vector<Cell>& row, const std::string& key) const {
    return columns_.contains(key) && !is_absent(cell(row, key).text);
  }

  /// The number in a cell, in consistent units; forces in N per unit width.
  double number(const std::vector<Cell>& row, const std::string& key) {
    const Column& column = columns_.at(key);
    const Cell& at = cell(row, key);
    if (is_absent(at.text))
      refuse(at,
             fmt::format("{} {}; a number belongs here", column.title(),
                         at.text.empty() ? "is empty" : fmt::format("= {} says that nothing was measured", at.text)));
    try {
      if (column.constant) return read_constant(at, *column.parameter);
      const Quantity quantity = split_quantity(decimal_point(at));
      if (!quantity.unit.empty())
        throw std::invalid_argument("holds more than a number; the unit belongs in the header alone");
      if (is_force(*column.parameter) && same_dimension(column.unit, force_unit)) {
        const double width = number(row, "width");
        return in_range(quantity.number * consistent_units_in(column.unit) / width, "N/mm", *column.parameter);
      }
      return in_range(quantity.number, column.unit, *column.parameter);
    } catch (const std::invalid_argument& error) {
      refuse(at, fmt::format("{} = {} {}", column.title(), at.text, error.what()));
    }
  }

  static double read_constant(const Cell& at, const Parameter& parameter) {
    Node node;
    node.value = at.text;
    if (parameter.unit != "1") return read_number(node, parameter);
    const Quantity quantity = split_quantity(at.text);
    if (!quantity.unit.empty()) throw std::invalid_argument("is a pure number; it has no unit");
    return in_range(quantity.number, "1", parameter);
  }

  /// Turns a decimal comma into a point, where the file's other numbers leave no doubt that it is one.
  std::string decimal_point(const Cell& at) {
    std::string text = plain_number(at.text);
    const std::size_t mark = text.find_first_of(".,");
    if (mark == text.npos) return text;
    if (text.find_first_of(".,", mark + 1) != text.npos)
      throw std::invalid_argument("has two decimal marks; write numbers without thousands separators");
    if (text[mark] == ',' && csv_.separator == ',')
      throw std::invalid_argument("has a decimal comma; separate the cells by semicolons or write a decimal point");
    if (decimal_mark_ && *decimal_mark_ != text[mark])
      throw std::invalid_argument(
          fmt::format("has a decimal '{}', but the file began with decimal '{}'", text[mark], *decimal_mark_));
    decimal_mark_ = text[mark];
    text[mark] = '.';
    return text;
  }

  std::optional<double> optional_number(const std::vector<Cell>& row, const std::string& key) {
    return given(row, key) ? std::optional(number(row, key)) : std::nullopt;
  }

  std::optional<Measured> optional_measured(const std::vector<Cell>& row, const std::string& key, int repeats) {
    if (given(row, key)) return Measured{number(row, key), optional_number(row, key + "_sd"), repeats};
    if (given(row, key + "_sd"))
      refuse(cell(row, key + "_sd"), fmt::format("there is a {0}_sd but no {0} in this row", key));
    return std::nullopt;
  }

  int whole_number(const std::vector<Cell>& row, const std::string& key, int otherwise) {
    if (!given(row, key)) return otherwise;
    const double value = number(row, key);
    if (value != std::floor(value))
      refuse(cell(row, key), fmt::format("{} = {} is not a whole number", key, cell(row, key).text));
    return static_cast<int>(value);
  }

  CurvePoint read_point(const std::vector<Cell>& row) {
    CurvePoint point;
    point.line = row.front().line;
    const int repeats = whole_number(row, "repeats", 1);
    point.depth = number(row, "depth");
    point.rake = number(row, "rake");
    point.width = optional_number(row, "width");
    point.speed = optional_number(row, "speed");
    point.tool_radius = optional_number(row, "tool_radius");
    point.F_c = {number(row, "Fc"), optional_number(row, "Fc_sd"), repeats};
    point.F_t = optional_measured(row, "Ft", repeats);
    point.chip_ratio = optional_measured(row, "chip_ratio", repeats);
    point.curl_radius = optional_measured(row, "curl_radius", repeats);
    if (point.curl_radius && point.curl_radius->value == 0)
      refuse(cell(row, "curl_radius"),
             "a chip of curl radius 0 does not exist; leave the cell of a straight chip empty");
    if (given(row, "specimen")) point.specimen = cell(row, "specimen").text;
    point.replicate = whole_number(row, "replicate", unnumbered);
    return point;
  }

  static void sort_by_depth(Curve& curve) {
    const auto shallower = [](const CurvePoint& a, const CurvePoint& b) { return a.depth < b.depth; };
    if (std::is_sorted(curve.points.begin(), curve.points.end(), shallower)) return;
    std::stable_sort(curve.points.begin(), curve.points.end(), shallower);
    curve.notes.emplace_back("rows were not in order of depth; they are sorted");
  }

  /// Rows of one depth and set-up are replicates, counted in file order unless the file numbers them itself.
  void number_replicates(Curve& curve) const {
    using Setup = std::tuple<double, double, double, std::string>;
    std::map<Setup, std::map<int, int>> taken;  // replicate -> line
    for (const bool numbered : {true, false})
      for (CurvePoint& point : curve.points) {
        if ((point.replicate != unnumbered) != numbered) continue;
        auto& lines = taken[{point.depth, point.rake, point.speed.value_or(0.0), point.specimen}];
        if (!numbered)
          for (point.replicate = 1; lines.contains(point.replicate);) ++point.replicate;
        if (const auto [entry, fresh] = lines.emplace(point.replicate, point.line); !fresh)
          refuse({"", point.line, 1}, fmt::format("replicate {} of this depth and set-up stands already in line {}",
                                                  point.replicate, entry->second));
      }
  }

  static constexpr int unnumbered = 0;

  const std::string& name_;
  Csv csv_;
  Cell header_;
  std::map<std::string, Column> columns_;
  std::optional<char> decimal_mark_;
};

}  // namespace

std::optional<double> Measured::standard_error() const {
  return sd ? std::optional(*sd / std::sqrt(static_cast<double>(repeats))) : std::nullopt;
}

const Block& curve_columns() {
  static const Block columns{
      .path = "columns",
      .variant = "",
      .meaning = "columns of a measured curve, a CSV file",
      .parameters =
          {kerf::number("depth", "mm", 1e-6, 100, "depth of cut (uncut chip thickness)"),
           kerf::number("Fc", "N/mm", 0, 1e5, "cutting force, along the tool's motion; N or N per width"),
           kerf::number("Ft", "N/mm", -1e5, 1e5,
                        "transverse force, positive when the tool is pushed away from the work")
               .if_given(),
           kerf::number("Fc_sd", "N/mm", 1e-9, 1e5, "standard deviation of Fc between repeats").if_given(),
           kerf::number("Ft_sd", "N/mm", 1e-9, 1e5, "standard deviation of Ft between repeats").if_given(),
           kerf::number("chip_ratio", "1", 0.05, 50, "chip thickness / depth of cut").if_given(),
           kerf::number("chip_ratio_sd", "1", 1e-9, 50, "standard deviation of chip_ratio between repeats").if_given(),
           kerf::number("curl_radius", "mm", -1e5, 1e5,
                        "radius the chip curls with, positive away from the tool; compared as the curvature 1/radius")
               .if_given(),
           kerf::number("curl_radius_sd", "mm", 1e-9, 1e5, "standard deviation of curl_radius between repeats")
               .if_given(),
           kerf::number("width", "mm", 1e-3, 1e4, "width of cut").if_given(),
           kerf::number("rake", "deg", -60, 85, "rake angle, from the normal of the cut plane"),
           kerf::number("speed", "m/min", 1e-9, 1e6, "cutting speed").if_given(),
           kerf::number("tool_radius", "um", 0, 1e4, "radius of the cutting edge").if_given(),
           text("specimen", "name of the specimen").if_given(),
           kerf::number("replicate", "1", 1, 1e6, "number of this row among those of its depth").if_given(),
           kerf::number("repeats", "1", 1, 1e6, "number of repeats that the values are the mean of").or_else("1")},
      .required = true};
  return columns;
}

Curve parse_curve(std::string_view text, const std::string& name) {
  return CurveReader(text, name).read();
}

Curve read_curve(const std::filesystem::path& file) {
  return parse_curve(read_file(file), file.string());
}

}  // namespace kerf::data
