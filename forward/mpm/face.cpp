#include "forward/mpm/state.hpp"

namespace kerf::forward {

void Face::add(double at_x, double at_y) {
  x.push_back(at_x);
  y.push_back(at_y);
  for (auto* values : {&velocity_x, &velocity_y, &force_x, &force_y, &offset_x, &offset_y, &inverse_mass, &moved_mass})
    values->push_back(0.0);
  node_column.push_back(0);
  node_row.push_back(0);
  for (std::vector<double>& list : slip) list.push_back(0.0);
}

void Face::drop_first(std::size_t count) {
  const auto drop = [count](auto& values) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
  };
  for (auto* values :
       {&x, &y, &velocity_x, &velocity_y, &force_x, &force_y, &offset_x, &offset_y, &inverse_mass, &moved_mass})
    drop(*values);
  drop(node_column);
  drop(node_row);
  for (std::vector<double>& list : slip) drop(list);
}

}  // namespace kerf::forward
