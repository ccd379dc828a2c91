#pragma once

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {

/// Calls visit(node, weight, slope along x, slope along y) for the nine nodes of `grid` around a point, one point at a
/// time: what conducts heat is no part of the hot kernel.
template <class Grid, class Visit>
void each_node(const Grid& grid, double x, double y, Visit&& visit) {
  const Spline along(grid.column_of(x)), up(grid.row_of(y));
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      visit(grid.node(along.base + i, up.base + j), along.weight(i) * up.weight(j),
            along.slope(i) * up.weight(j) * grid.inverse_cell_x, along.weight(i) * up.slope(j) * grid.inverse_cell_y);
}

}  // namespace kerf::forward
