#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/base/estimate.hpp"
#include "models/chip/measured_cut.hpp"

namespace kerf::chip {

/// The line (3) of transverse against cutting force at one rake angle: its slope Z is friction, its intercept adhesion
/// or a force on the tool's bottom, and its scatter shows whether one law of friction holds at all depths.
struct FrictionLine {
  struct Outlier {
    int line;            ///< of the data file
    double depth;        ///< mm
    double studentized;  ///< residual over its standard error when left out of the fit
  };

  double rake = 0.0;  ///< rad
  int points = 0;
  Estimate slope;                 ///< Z
  Estimate intercept;             ///< N/mm
  Estimate friction;              ///< mu behind the slope
  double scatter = 0.0;           ///< residual standard deviation of F_t, N/mm
  std::optional<double> chi2;     ///< with measured errors, on points - 2 degrees of freedom
  std::vector<Outlier> outliers;  ///< beyond the 5 % point of the largest of all studentized residuals

  /// Square root R of the information on (Z, intercept): the line knows them to R (difference) = unit normal.
  Eigen::Matrix2d information_root = Eigen::Matrix2d::Zero();
};

/// One line per rake angle that has at least three cuts at two or more forces. Errors of both forces count: the
/// variance about the line is s_t^2 + Z^2 s_c^2. Empty without F_t.
std::vector<FrictionLine> friction_lines(const Measurements& measurements);

}  // namespace kerf::chip
