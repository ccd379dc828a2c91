#include "forward/effects/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf::forward {
namespace {

/// The segments of the outer surface by the grid columns that they lie in, so that a marker asks only its own.
std::vector<std::vector<std::size_t>> segments_by_column(const Face& top, const Grid& grid) {
  std::vector<std::vector<std::size_t>> columns(static_cast<std::size_t>(grid.columns));
  for (std::size_t j = 0; j + 1 < top.size(); ++j) {
    if (top.inverse_mass[j] == 0.0 || top.inverse_mass[j + 1] == 0.0) continue;
    const auto [low, high] = std::minmax({grid.column_of(top.x[j]), grid.column_of(top.x[j + 1])});
    for (int c = static_cast<int>(low); c <= static_cast<int>(high); ++c)
      columns[static_cast<std::size_t>(c)].push_back(j);
  }
  return columns;
}

}  // namespace

void touch_itself(State& state, double stiffness, double reach) {
  Face &cut = state.crack.face[above], &top = state.top;
  const double length = state.crack.spacing;
  const auto columns = segments_by_column(top, state.grid);
  for (std::size_t k = 0; k < cut.size(); ++k) {
    if (cut.inverse_mass[k] == 0.0) continue;
    double nearest = -reach, t = 0.0, normal_x = 0.0, normal_y = 0.0;
    std::size_t at = top.size();
    for (const std::size_t j : columns[static_cast<std::size_t>(state.grid.column_of(cut.x[k]))]) {
      const double along_x = top.x[j + 1] - top.x[j], along_y = top.y[j + 1] - top.y[j];
      const double squared = along_x * along_x + along_y * along_y;
      const double dx = cut.x[k] - top.x[j], dy = cut.y[k] - top.y[j];
      const double share = (dx * along_x + dy * along_y) / squared;
      if (share < 0.0 || share > 1.0) continue;
      const double distance = (dy * along_x - dx * along_y) / std::sqrt(squared);  // outwards positive
      if (distance >= 0.0 || distance <= nearest) continue;
      nearest = distance;
      at = j;
      t = share;
      normal_x = -along_y / std::sqrt(squared);
      normal_y = along_x / std::sqrt(squared);
    }
    if (at == top.size()) continue;
    const double spring = std::min({stiffness, stiffest_spring(state, cut.moved_mass[k]),
                                    stiffest_spring(state, std::min(top.moved_mass[at], top.moved_mass[at + 1]))});
    const double push = -spring * nearest * length;
    cut.force_x[k] += push * normal_x;
    cut.force_y[k] += push * normal_y;
    for (const auto& [j, share] : {std::pair{at, 1.0 - t}, std::pair{at + 1, t}}) {
      top.force_x[j] -= share * push * normal_x;
      top.force_y[j] -= share * push * normal_y;
    }
    state.contact_energy -= 0.5 * push * nearest;
  }
}

}  // namespace kerf::forward
