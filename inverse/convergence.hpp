#pragma once

#include <string>
#include <vector>

#include "models/base/estimate.hpp"

namespace kerf::inverse {

/// A force at one cell size.
struct ForceAtCell {
  double cell;     ///< > 0, any unit
  Estimate force;  ///< any unit; an error that is not positive makes all of them count as unknown
};

/// How a force converges as cells shrink: F = F_0 + C h^p by weighted least squares (Roache 1998, ch. 5, with the
/// observed order fitted instead of taken from three grids).
struct Convergence {
  std::string not_resolved;                 ///< empty, or why the forces tell no order
  Estimate order;                           ///< p
  double order_lower = 0, order_upper = 0;  ///< 95 %
  Estimate limit;  ///< F_0, the Richardson value; without a resolved trend the weighted mean of all forces
  double limit_lower = 0, limit_upper = 0;  ///< 95 %
  double amplitude = 0;                     ///< C h^p at the largest cell
  double scatter = 1;  ///< of the forces about the fit in standard errors; when too large the errors are widened by it
  int freedom = 0;     ///< forces less the three unknowns; with none the errors are those of the forces alone
};

Convergence convergence(const std::vector<ForceAtCell>& forces);

}  // namespace kerf::inverse
