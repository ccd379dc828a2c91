#include "forward/effects/xpic.hpp"

#include "forward/mpm/stencil.hpp"

namespace kerf::forward {

void filter_velocity(State& state, int order) {
  const Particles& p = state.particles;
  const Grid& grid = state.grid;
  Array term, mean, mass;
  for (std::size_t side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[side];
    term.resize(field.velocity.size());
    for (std::size_t k = 0; k < term.size(); ++k) term[k] = field.velocity[k] + field.change[k];
    field.filtered = term;
    for (int l = 1; l < order; ++l) {
      mean.assign(term.size(), 0.0);
      mass.assign(field.mass.size(), 0.0);
      for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; i += lane_count) {
        const Stencil stencil(grid, load(&p.x[i]), load(&p.y[i]));
        const auto [x, y] = stencil.sum(term.data());
        stencil.add_momentum(mean.data(), mass.data(), load(&p.volume[i]) * state.density, x, y);
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
