#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "models/base/parameter.hpp"

namespace kerf::data {

/// A measured value with its scatter, in consistent units.
struct Measured {
  double value = 0.0;
  std::optional<double> sd;  ///< standard deviation of single repeats (not of their mean)
  int repeats = 1;           ///< number of repeats `value` is the mean of

  /// Standard error of the mean, sd / sqrt(repeats); absent when no scatter was given.
  std::optional<double> standard_error() const;
};

/// One row of a measured curve.
struct CurvePoint {
  double depth = 0.0;           ///< depth of cut, mm
  Measured F_c;                 ///< cutting force per unit width, N/mm
  std::optional<Measured> F_t;  ///< transverse force per unit width, N/mm; positive: tool pushed away from the work
  std::optional<Measured> chip_ratio;   ///< chip thickness / depth of cut
  std::optional<Measured> curl_radius;  ///< of the chip, mm; positive curls away from the tool
  double rake = 0.0;                    ///< rad
  std::optional<double> width;          ///< of cut, mm
  std::optional<double> speed;          ///< mm/s
  std::optional<double> tool_radius;    ///< mm
  std::string specimen;                 ///< empty when none is named
  int replicate = 1;                    ///< as given, else counted from 1 within equal depth, rake and specimen
  int line = 0;                         ///< of the file, for messages
};

/// Forces measured at several depths of cut, sorted by depth.
struct Curve {
  std::string name;
  std::vector<CurvePoint> points;
  std::vector<std::string> notes;  ///< what the reader did that the user should know (rows skipped, order changed)
};

/// Reads a CSV file whose header cells carry the unit: depth[um], Fc[N] or Fc[N/mm], Ft[...] and, optionally,
/// Fc_sd[...], Ft_sd[...], chip_ratio, chip_ratio_sd, curl_radius[mm], curl_radius_sd[mm], width[mm], rake[deg],
/// speed[m/min], tool_radius[um], specimen, replicate, repeats. `#` begins a comment line; `#: rake = 15 deg` gives a
/// column's constant value. Forces in N are divided by the width. Separators may be commas, semicolons (then decimals
/// may be commas) or tabs. Throws InputError with file:line:column for everything that cannot be read without guessing.
Curve read_curve(const std::filesystem::path& file);
Curve parse_curve(std::string_view text, const std::string& name);

/// What a curve file may hold, declared like a block of a document: the columns with their units and ranges.
const Block& curve_columns();

}  // namespace kerf::data
