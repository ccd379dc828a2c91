#pragma once

#include <string>
#include <vector>

#include "models/chip/fit_method.hpp"
#include "models/chip/friction_line.hpp"

namespace kerf::chip {

/// A measured curve seen by every method that suits it, side by side.
struct Reduction {
  std::vector<MethodResult> methods;
  std::vector<FrictionLine> friction_lines;
  std::vector<std::string> warnings;  ///< what keeps these numbers from being believed, in words

  const MethodResult* find(std::string_view method) const;
};

/// Applies `methods` (all of fit_methods when empty; names must exist). Never throws for data that do not suit a
/// method: its result then says why.
Reduction reduce(const Measurements& measurements, const std::vector<std::string>& methods = {},
                 const FitOptions& options = {});

}  // namespace kerf::chip
