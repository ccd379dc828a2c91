#include "inverse/sweep_axis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <set>
#include <stdexcept>

#include "forward/scene/preset.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

constexpr std::string_view leave_out = "-";
constexpr std::string_view preset_path = "preset";
constexpr double most_values = 1000;

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    std::string_view part = text.substr(0, end);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    parts.emplace_back(part);
    if (end == text.npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// A number as written, its unit still to be found when it has none.
struct Written {
  double number;
  std::string unit;
};

/// What a person would have typed: 0.1 + 2 * 0.1 is 0.3.
double tidy(double value) {
  return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr);
}

/// from:to:count, with an optional unit behind each of them; log:... in equal ratios.
std::vector<Written> read_range(std::string_view item) {
  const bool logarithmic = item.starts_with("log:");
  if (logarithmic) item.remove_prefix(4);
  const std::vector<std::string> parts = split(item, ':');
  if (parts.size() != 3) throw std::invalid_argument("is no range; write FROM:TO:COUNT, or log:FROM:TO:COUNT");
  Quantity from = split_quantity(parts[0]), to = split_quantity(parts[1]);
  const Quantity count = split_quantity(parts[2]);
  if (to.unit.empty()) to.unit = count.unit;
  if (from.unit.empty()) from.unit = to.unit;
  if (from.unit != to.unit) throw std::invalid_argument("has two units; write both ends in the same one");
  if (!(count.number >= 2 && count.number <= most_values) || count.number != std::floor(count.number))
    throw std::invalid_argument(fmt::format("asks for {:g} values; a range holds a whole number of them, 2 to {:g}",
                                            count.number, most_values));
  if (from.number == to.number) throw std::invalid_argument("begins where it ends");
  if (logarithmic && !(from.number > 0 && to.number > 0))
    throw std::invalid_argument("must have positive ends to be divided in equal ratios");
  std::vector<Written> values;
  const auto last = static_cast<int>(count.number) - 1;
  for (int i = 0; i <= last; ++i) {
    const double part = static_cast<double>(i) / last;
    const double between = logarithmic ? from.number * std::pow(to.number / from.number, part)
                                       : from.number + (to.number - from.number) * part;
    values.push_back({tidy(between), to.unit});
  }
  return values;
}

std::vector<Written> read_item(const std::string& item) {
  if (item.find(':') != item.npos) return read_range(item);
  const Quantity quantity = split_quantity(item);
  return {{quantity.number, quantity.unit}};
}

/// The value in the unit all are shown in; a number that was typed in that unit stays as it was typed.
double shown_in(const std::string& unit, const Written& written, double number) {
  return written.unit == unit ? written.number : tidy(number / consistent_units_in(unit));
}

void read_numbers(SweepAxis& axis, const std::vector<std::string>& items, const Parameter& parameter) {
  struct Entry {
    std::optional<Written> written;  ///< none: left out
    const std::string* item;
  };
  std::vector<Entry> entries;
  for (const std::string& item : items) {
    if (item == leave_out) {
      entries.push_back({std::nullopt, &item});
      continue;
    }
    try {
      for (const Written& written : read_item(item)) entries.push_back({written, &item});
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("\"{}\" is refused: {}", item, error.what()));
    }
  }
  // The unit of the last value holds for all before it that have none.
  std::string unit;
  for (auto entry = entries.rbegin(); entry != entries.rend() && unit.empty(); ++entry)
    if (entry->written) unit = entry->written->unit;
  axis.unit = parameter.unit == "1" || unit.empty() ? parameter.unit : unit;
  for (auto& [written, item] : entries) {
    if (!written) {
      axis.values.push_back({.text = std::string(leave_out), .shown = {}, .absent = true});
      continue;
    }
    if (written->unit.empty()) written->unit = unit;
    if (parameter.unit == "1" && !written->unit.empty())
      throw std::invalid_argument(fmt::format("\"{}\" has a unit, but a pure number belongs here", *item));
    if (parameter.unit != "1" && written->unit.empty())
      throw std::invalid_argument(
          fmt::format("\"{}\" has no unit; write for example {}{}", *item, written->number, parameter.unit));
    SweepValue value;
    try {
      value.number = in_range(written->number, written->unit.empty() ? "1" : written->unit, parameter);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("\"{}\" {}", *item, error.what()));
    }
    value.shown = parameter.unit == "1" ? written->number : shown_in(axis.unit, *written, value.number);
    value.text = fmt::format("{}", *value.shown);
    axis.values.push_back(std::move(value));
  }
}

void refuse_repeats(const SweepAxis& axis) {
  for (auto value = axis.values.begin(); value != axis.values.end(); ++value)
    for (auto other = axis.values.begin(); other != value; ++other)
      if (other->absent == value->absent && other->number == value->number &&
          (axis.numeric || other->text == value->text))
        throw std::invalid_argument(fmt::format("holds {} twice", value->text + (axis.unit == "1" ? "" : axis.unit)));
}

/// Tables that may be missing as a whole: `friction=-`.
bool is_optional_table(std::string_view path, const std::vector<Block>& known) {
  return std::any_of(known.begin(), known.end(), [&](const Block& block) {
    return block.path == path && !path.empty() && !block.required && !block.repeated;
  });
}

std::string block_of(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == path.npos ? "" : std::string(path.substr(0, dot));
}

void read_table_axis(const std::string& path, const std::vector<std::string>& items) {
  for (const std::string& item : items)
    if (item != leave_out)
      throw std::invalid_argument(
          fmt::format("\"{}\" is refused: {} is a table, which can only be left out: {}=-", item, path, path));
}

void require_alike(const Parameter& first, const Parameter& other, const std::string& path) {
  const bool numbers = first.kind == Parameter::Kind::number;
  if (numbers != (other.kind == Parameter::Kind::number) || (numbers && !same_dimension(first.unit, other.unit)))
    throw std::invalid_argument(fmt::format("\"{}\" measures something else and cannot be given the same value", path));
}

SweepAxis read_axis(const std::vector<std::string>& paths, const std::vector<std::string>& items,
                    const std::vector<Block>& known, std::string_view where) {
  SweepAxis axis;
  axis.paths = paths;
  if (paths.size() == 1 && is_optional_table(paths.front(), known)) {
    read_table_axis(paths.front(), items);
    axis.numeric = false;
    axis.values.push_back({.text = std::string(leave_out), .shown = {}, .absent = true});
    return axis;
  }
  const Parameter parameter = Document::find_parameter(paths.front(), known, where);
  for (const std::string& path : paths) require_alike(parameter, Document::find_parameter(path, known, where), path);
  axis.numeric = parameter.kind == Parameter::Kind::number;
  if (axis.numeric) {
    read_numbers(axis, items, parameter);
    for (const std::string& path : paths)  // the others may allow less
      for (const SweepValue& value : axis.values)
        if (!value.absent)
          in_range(value.number, consistent_unit(parameter.unit), Document::find_parameter(path, known, where));
  } else {
    for (const std::string& item : items)
      axis.values.push_back({.text = item, .shown = {}, .absent = item == leave_out});
  }
  return axis;
}

/// Leaves out a key; a key that must stand takes its table along, if that may be missing.
void leave_out_key(const std::string& path, Document& scene, const std::vector<Block>& known) {
  if (is_optional_table(path, known)) return scene.remove(path);
  const Parameter parameter = Document::find_parameter(path, known, scene.name());
  const std::string block = block_of(path);
  if (parameter.fallback || parameter.optional || !is_optional_table(block, known)) return scene.remove(path);
  scene.remove(block);
}

}  // namespace

std::string SweepAxis::name() const {
  return fmt::format("{}", fmt::join(paths, "+"));
}

std::string SweepAxis::heading() const {
  return unit == "1" ? name() : fmt::format("{}[{}]", name(), unit);
}

std::string SweepAxis::label(const SweepValue& value) const {
  const std::string& what = short_name.empty() ? paths.front() : short_name;
  if (value.absent) return "no " + what;
  return fmt::format("{} = {}{}{}", what, value.text, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

bool SweepAxis::varies(std::string_view path) const {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

void name_axes(std::vector<SweepAxis>& axes) {
  std::vector<std::string> names;
  for (const SweepAxis& axis : axes) {
    const std::string& path = axis.paths.front();
    const std::string key = path.substr(path.rfind('.') + 1);
    // "coefficient" says nothing alone: friction.coefficient is friction.
    const std::string part = key == "coefficient" || key == "law" ? block_of(path) : path;
    names.push_back(part.substr(part.rfind('.') + 1));
  }
  for (std::size_t i = 0; i < axes.size(); ++i)
    axes[i].short_name = std::count(names.begin(), names.end(), names[i]) > 1 ? axes[i].name() : names[i];
}

SweepAxis parse_axis(std::string_view text, const std::vector<Block>& known, std::string_view where, bool repeats) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}: {}", where, text, why), ExitCode::usage);
  };
  const std::size_t equals = text.find('=');
  if (equals == text.npos || equals == 0) refuse("is not PATH=VALUES, as in cut.depth=0.25,0.5,1mm");
  const std::vector<std::string> paths = split(text.substr(0, equals), '+');
  const std::vector<std::string> items = split(text.substr(equals + 1), ',');
  if (std::set<std::string>(paths.begin(), paths.end()).size() != paths.size()) refuse("names a path twice");
  if (items.size() == 1 && items.front().empty()) refuse("has no values");
  if (std::find(items.begin(), items.end(), "") != items.end()) refuse("has an empty value between its commas");
  SweepAxis axis;
  try {
    axis = read_axis(paths, items, known, where);
    if (!repeats) refuse_repeats(axis);
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  } catch (const InputError& error) {
    throw InputError(error.what(), ExitCode::usage);
  }
  if (axis.values.size() > static_cast<std::size_t>(most_values))
    refuse(fmt::format("has {} values, more than {:g}", axis.values.size(), most_values));
  return axis;
}

void apply(const SweepAxis& axis, const SweepValue& value, Document& scene, const std::vector<Block>& known) {
  for (const std::string& path : axis.paths) {
    if (path == preset_path && !value.absent) {
      forward::impose_preset(scene, value.text, scene.name());
      continue;
    }
    if (value.absent) {
      leave_out_key(path, scene, known);
      continue;
    }
    if (const std::string block = block_of(path); !block.empty()) scene.add_table(block, known);
    if (axis.numeric)
      scene.set_number(path, value.number, known);
    else
      scene.set_text(path, value.text, known);
  }
}

std::vector<std::size_t> order_of_writing(const std::vector<SweepAxis>& axes) {
  std::vector<std::size_t> order(axes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(), [&](std::size_t a) { return axes[a].varies(preset_path); });
  return order;
}

void apply_settings(const std::vector<std::string>& settings, Document& scene, const std::vector<Block>& known,
                    std::string_view where) {
  std::set<std::string> set;
  std::vector<SweepAxis> axes;
  for (const std::string& setting : settings) {
    const SweepAxis& axis = axes.emplace_back(parse_axis(setting, known, where));
    const auto refuse = [&](const std::string& why) {
      throw InputError(fmt::format("{}: {}: {}", where, setting, why), ExitCode::usage);
    };
    if (axis.values.size() != 1) refuse("one value belongs here; `kerf sweep` takes several");
    for (const std::string& path : axis.paths)
      if (!set.insert(path).second) refuse(fmt::format("\"{}\" is set twice", path));
  }
  for (const std::size_t a : order_of_writing(axes)) apply(axes[a], axes[a].values.front(), scene, known);
}

}  // namespace kerf::inverse
