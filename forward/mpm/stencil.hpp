#pragma once

#include <array>
#include <cstddef>

#include "forward/mpm/shape_function.hpp"
#include "forward/mpm/state.hpp"

namespace kerf::forward {

// Which of these a compiler takes inline must not depend on how much else a file holds.

/// From eight rows of six numbers (and two that do not count) to six columns of eight.
[[gnu::always_inline]] inline std::array<Lanes, 6> columns_of(const std::array<Lanes, 8>& row) {
  std::array<Lanes, 6> column;
  Lanes even[4], odd[4];  // of two rows each: {a0 b0 a2 b2 a4 b4 - -}, {a1 b1 a3 b3 a5 b5 - -}
  for (int k = 0; k < 4; ++k) {
    even[k] = __builtin_shufflevector(row[2 * k], row[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    odd[k] = __builtin_shufflevector(row[2 * k], row[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  const auto collect = [](const Lanes* pair, Lanes& first, Lanes& second, Lanes& third) {
    const Lanes a = __builtin_shufflevector(pair[0], pair[1], 0, 1, 4, 5, 8, 9, 12, 13);
    const Lanes b = __builtin_shufflevector(pair[2], pair[3], 0, 1, 4, 5, 8, 9, 12, 13);
    const Lanes c = __builtin_shufflevector(pair[0], pair[1], 2, 3, 2, 3, 10, 11, 10, 11);
    const Lanes d = __builtin_shufflevector(pair[2], pair[3], 2, 3, 2, 3, 10, 11, 10, 11);
    first = __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13);
    third = __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15);
    second = __builtin_shufflevector(c, d, 0, 1, 4, 5, 8, 9, 12, 13);
  };
  collect(even, column[0], column[2], column[4]);
  collect(odd, column[1], column[3], column[5]);
  return column;
}

/// And back; the last two numbers of each row are zero.
[[gnu::always_inline]] inline std::array<Lanes, 8> rows_of(const std::array<Lanes, 6>& column) {
  std::array<Lanes, 8> row;
  Lanes low[3], high[3];  // of a pair of columns: rows 0 2 4 6, rows 1 3 5 7
  for (int k = 0; k < 3; ++k) {
    low[k] = __builtin_shufflevector(column[2 * k], column[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    high[k] = __builtin_shufflevector(column[2 * k], column[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  const auto spread = [](const Lanes* pair, Lanes& first, Lanes& second, Lanes& third, Lanes& fourth) {
    constexpr LaneMask counts{-1, -1, -1, -1, -1, -1, 0, 0};
    Lanes a = __builtin_shufflevector(pair[0], pair[1], 0, 1, 4, 5, 8, 9, 12, 13);
    Lanes b = __builtin_shufflevector(pair[0], pair[1], 2, 3, 6, 7, 10, 11, 14, 15);
    first = counts ? __builtin_shufflevector(a, pair[2], 0, 1, 4, 5, 8, 9, 8, 9) : Lanes{};
    second = counts ? __builtin_shufflevector(b, pair[2], 0, 1, 4, 5, 10, 11, 10, 11) : Lanes{};
    third = counts ? __builtin_shufflevector(a, pair[2], 2, 3, 6, 7, 12, 13, 12, 13) : Lanes{};
    fourth = counts ? __builtin_shufflevector(b, pair[2], 2, 3, 6, 7, 14, 15, 14, 15) : Lanes{};
  };
  spread(low, row[0], row[2], row[4], row[6]);
  spread(high, row[1], row[3], row[5], row[7]);
  return row;
}

/// The three by three nodes around each of eight particles, with a shape function. Sums over the nodes run along rows
/// of the grid: of a row, three nodes with two components each are one load or one store. Along x the weights belong to
/// lanes (one particle each), along y they multiply whole rows.
template <class Shape>
struct StencilOf {
  [[no_unique_address]] Shape shape;
  std::array<Lanes, 3> weight_x, slope_x;  ///< w_i(x), d w_i / d f
  alignas(64) std::array<std::array<double, lane_count>, 3> weight_y, slope_y;
  alignas(64) std::array<double, lane_count> offset_x;
  alignas(64) std::array<std::ptrdiff_t, lane_count> node;  ///< first of the nine
  std::ptrdiff_t stride;                                    ///< of the grid's rows
  Lanes f_x, f_y;

  StencilOf() = default;
  [[gnu::always_inline]] StencilOf(const Grid& grid, Lanes x, Lanes y, const Shape& with = {})
      : shape(with), stride(grid.stride) {
    const Lanes column = (x - grid.origin_x) * grid.inverse_cell_x, row = (y - grid.origin_y) * grid.inverse_cell_y;
    const LaneInts i = inside(column, grid.columns), j = inside(row, grid.rows);
    f_x = column - __builtin_convertvector(i, Lanes);
    f_y = row - __builtin_convertvector(j, Lanes);
    const auto first = __builtin_convertvector(j * grid.stride + i, LaneMask);
    __builtin_memcpy(node.data(), &first, sizeof first);
    store(offset_x.data(), f_x);
    shape.weigh(f_x, weight_x, slope_x);
    std::array<Lanes, 3> weight, slope;
    shape.weigh(f_y, weight, slope);
    for (std::size_t k = 0; k < 3; ++k) {
      store(weight_y[k].data(), weight[k]);
      store(slope_y[k].data(), slope[k]);
    }
  }

  /// `so_far`, with a one for each particle whose nodes do not all exist (or whose position is not a number).
  Lanes outside(Lanes so_far) const {
    // Half a cell to either side, with room for rounding.
    const auto holds = (f_x > 0.49) & (f_x < 1.51) & (f_y > 0.49) & (f_y < 1.51);
    return holds ? so_far : Lanes{} + 1.0;
  }

  /// Puts first moments, w_i (i - f), in the place of the slopes. Returns sum w_i (i - f)^2 along x and y.
  std::array<Lanes, 2> take_moments() {
    std::array<Lanes, 2> spread{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Lanes along = static_cast<double>(k) - f_x, up = static_cast<double>(k) - f_y,
                  weight = load(weight_y[k].data());
      slope_x[k] = weight_x[k] * along;
      store(slope_y[k].data(), weight * up);
      spread[0] += weight_x[k] * along * along;
      spread[1] += weight * up * up;
    }
    return spread;
  }

  /// Sum over the rows of a nodal vector field, weighted along y: the six numbers of a row, for each particle.
  std::array<Lanes, 6> value(const double* nodal) const {
    std::array<Lanes, lane_count> sums;
#pragma GCC unroll 8
    for (std::size_t p = 0; p < lane_count; ++p) {
      const double* at = row(nodal, p, 0);
      sums[p] =
          weight_y[0][p] * load(at) + weight_y[1][p] * load(at + 2 * stride) + weight_y[2][p] * load(at + 4 * stride);
    }
    return columns_of(sums);
  }
  /// The same, and with the slopes along y.
  std::array<std::array<Lanes, 6>, 2> value_and_rise(const double* nodal) const {
    std::array<Lanes, lane_count> sums, rises;
#pragma GCC unroll 8
    for (std::size_t p = 0; p < lane_count; ++p) {
      const double* at = row(nodal, p, 0);
      const Lanes a = load(at), b = load(at + 2 * stride), c = load(at + 4 * stride);
      sums[p] = weight_y[0][p] * a + weight_y[1][p] * b + weight_y[2][p] * c;
      rises[p] = slope_y[0][p] * a + slope_y[1][p] * b + slope_y[2][p] * c;
    }
    return {columns_of(sums), columns_of(rises)};
  }
  /// Of a nodal vector field by x and y, in cells: d_x of its x part, d_y of it, d_x of its y part, d_y of it.
  std::array<Lanes, 4> gradient(const double* nodal) const {
    const auto [value, rise] = value_and_rise(nodal);
    Lanes xx{}, xy{}, yx{}, yy{};
    for (std::size_t i = 0; i < 3; ++i) {
      xx += slope_x[i] * value[2 * i];
      yx += slope_x[i] * value[2 * i + 1];
      xy += weight_x[i] * rise[2 * i];
      yy += weight_x[i] * rise[2 * i + 1];
    }
    return {xx, xy, yx, yy};
  }
  /// A nodal vector field at the particles.
  std::array<Lanes, 2> sum(const double* nodal) const {
    const std::array<Lanes, 6> of = value(nodal);
    return {weight_x[0] * of[0] + weight_x[1] * of[2] + weight_x[2] * of[4],
            weight_x[0] * of[1] + weight_x[1] * of[3] + weight_x[2] * of[5]};
  }

  /// Adds to a nodal vector field what each particle gives to the nodes of a row, weighted along y.
  void add(double* nodal, const std::array<Lanes, 6>& by_weight) const {
    const std::array<Lanes, lane_count> share = rows_of(by_weight);
#pragma GCC unroll 8
    for (std::size_t p = 0; p < lane_count; ++p)
      for (int j = 0; j < 3; ++j) {
        double* to = row(nodal, p, j);
        store(to, load(to) + weight_y[static_cast<std::size_t>(j)][p] * share[p]);
      }
  }
  void add(double* nodal, const std::array<Lanes, 6>& by_weight, const std::array<Lanes, 6>& by_slope) const {
    const std::array<Lanes, lane_count> w = rows_of(by_weight), s = rows_of(by_slope);
#pragma GCC unroll 8
    for (std::size_t p = 0; p < lane_count; ++p)
      for (int j = 0; j < 3; ++j) {
        double* to = row(nodal, p, j);
        const auto k = static_cast<std::size_t>(j);
        store(to, load(to) + weight_y[k][p] * w[p] + slope_y[k][p] * s[p]);
      }
  }
  /// Adds the mass and momentum of each particle to the nodes around it.
  void add_momentum(double* momentum, double* masses, Lanes mass, Lanes velocity_x, Lanes velocity_y) const {
    std::array<Lanes, 6> share;
    for (std::size_t i = 0; i < 3; ++i) {
      const Lanes part = weight_x[i] * mass;
      share[2 * i] = part * velocity_x;
      share[2 * i + 1] = part * velocity_y;
    }
    add(momentum, share);
    add_mass(masses, mass);
  }
  void add_mass(double* masses, Lanes mass) const {
    alignas(64) std::array<double, lane_count> each;
    store(each.data(), mass);
#pragma GCC unroll 8
    for (std::size_t p = 0; p < lane_count; ++p) {
      const Quad row_masses = each[p] * shape.row(offset_x[p]);
      for (int j = 0; j < 3; ++j)
        add_row((masses + j * stride) + node[p], weight_y[static_cast<std::size_t>(j)][p] * row_masses);
    }
  }

  /// Asks for the nodes of a field (of so many components) that the eight particles' walk along their rows meets next
  /// and for the first time: those of the third row, a cache line ahead. Large grids do not stay in the nearer caches,
  /// and eight walks at once are more than the processor follows by itself.
  template <std::ptrdiff_t components>
  [[gnu::always_inline]] void prefetch(const double* nodal) const {
    constexpr std::ptrdiff_t line = 8;
#pragma GCC unroll 8
    for (std::size_t p = 0; p < lane_count; ++p) __builtin_prefetch(nodal + components * (2 * stride + node[p]) + line);
  }

 private:
  static LaneInts inside(Lanes at, int count) {
    const LaneInts first = __builtin_convertvector(at - 0.5, LaneInts);
    const LaneInts low = first > 0 ? first : 0;
    return low < count - 3 ? low : count - 3;
  }
  template <class T>
  T* row(T* nodal, std::size_t p, int j) const {
    return (nodal + 2 * j * stride) + 2 * node[p];
  }
};

using Stencil = StencilOf<QuadraticSpline>;

}  // namespace kerf::forward
