#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/document.hpp"

namespace kerf::inverse {

/// One value that a swept key takes.
struct SweepValue {
  std::string text;             ///< as it is shown, without its unit: "0.25", "cuts", "-"
  std::optional<double> shown;  ///< numbers: in the axis' unit
  double number = 0;            ///< numbers: in consistent units
  bool absent = false;          ///< "-": the key is left out
};

/// What a sweep varies: one key of the scene, or several that are given the same value.
struct SweepAxis {
  std::vector<std::string> paths;
  std::string short_name;  ///< for tables and labels: "depth", "friction"; distinct within a sweep
  std::string unit = "1";  ///< in which numbers are shown; "1" also for words
  bool numeric = true;
  std::vector<SweepValue> values;  ///< in the order given

  std::string name() const;                          ///< "cut.depth", "cohesive.mode_I.toughness+cohesive.mode_II..."
  std::string heading() const;                       ///< with the unit, as a column of a table: "cut.depth[mm]"
  std::string label(const SweepValue& value) const;  ///< "depth = 0.25 mm"
  bool varies(std::string_view path) const;          ///< is it among the paths?
};

/// Gives each axis its short name, or the whole path where two would be alike.
void name_axes(std::vector<SweepAxis>& axes);

/// Reads `PATH=v1,v2,...` against what a scene may hold:
///   cut.depth=0.25,0.5,1mm        a unit behind each value, or behind the last one for all that have none
///   cut.depth=0.1:1:10mm          from : to : how many, evenly spaced; log:0.1:1:10mm in equal ratios
///   cohesive.mode_I.strength+cohesive.mode_II.strength=20,40MPa      several keys with one value
///   bridging.tool=cuts,ignores    words
///   friction.coefficient=-,0.2    "-" leaves the key out, and its table when it cannot be without the key
/// Throws InputError (usage) that begins with `where` and says what is wrong; a value that stands there twice is wrong
/// unless `repeats` are allowed.
SweepAxis parse_axis(std::string_view text, const std::vector<Block>& known, std::string_view where,
                     bool repeats = false);

/// Writes the value into the scene. A table that the scene lacks is added; what else must stand there says the reader.
/// A preset is written over the scene's own keys (see forward/scene/preset.hpp).
void apply(const SweepAxis& axis, const SweepValue& value, Document& scene, const std::vector<Block>& known);

/// Indices of the axes in the order to `apply` them: a preset comes first, so that keys given beside it count.
std::vector<std::size_t> order_of_writing(const std::vector<SweepAxis>& axes);

/// The scene with `PATH=value` written in, as `kerf simulate --set` does: one value each, no path twice.
void apply_settings(const std::vector<std::string>& settings, Document& scene, const std::vector<Block>& known,
                    std::string_view where);

}  // namespace kerf::inverse
