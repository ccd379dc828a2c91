#pragma once

namespace kerf {

/// A number with its standard error, in consistent units.
struct Estimate {
  double value = 0.0;
  double standard_error = 0.0;
};

}  // namespace kerf
