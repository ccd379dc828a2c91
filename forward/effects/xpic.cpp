#include "forward/effects/xpic.hpp"

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {

void filter_velocity(State& state, int order) {
  const Particles& p = state.particles;
  const Grid& grid = state.grid;
  std::vector<double> term, mean, mass;
  for (std::size_t side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[side];
    field.filtered = field.next_velocity;
    term = field.next_velocity;
    for (int l = 1; l < order; ++l) {
      mean.assign(term.size(), 0.0);
      mass.assign(field.mass.size(), 0.0);
      for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; ++i) {
        const Spline sx(grid.column_of(p.x[i])), sy(grid.row_of(p.y[i]));
        const Lanes weights = sx.row_weights();
        Lanes value{};
        for (int j = 0; j < 3; ++j) value += sy.weight(j) * load(&term[2 * grid.node(sx.base, sy.base + j)]);
        value *= weights;
        const double m = p.volume[i] * state.density;
        const Lanes momentum = m * weights * pairs(sum_x(value), sum_y(value));
        const Quad masses = m * Quad{weights[0], weights[2], weights[4], 0.0};
        for (int j = 0; j < 3; ++j) {
          const std::size_t node = grid.node(sx.base, sy.base + j);
          add_row(&mass[node], sy.weight(j) * masses);
          store(&mean[2 * node], load(&mean[2 * node]) + sy.weight(j) * momentum);
        }
      }
      for (std::size_t node = 0; node < grid.nodes(); ++node) {
        const double inverse = mass[node] > state.smallest_mass ? 1.0 / mass[node] : 0.0;
        for (std::size_t k = 2 * node; k < 2 * node + 2; ++k) {
          term[k] -= mean[k] * inverse;
          if (inverse == 0.0) term[k] = 0.0;
          field.filtered[k] += term[k];
        }
      }
    }
  }
}

}  // namespace kerf::forward
