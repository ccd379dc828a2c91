#include "forward/mpm/window.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "forward/mpm/transfer.hpp"

namespace kerf::forward {
namespace {

constexpr int margin = 4;  // cells around the window that stay free for the kernel

void push(Particles& p, double x, double y, double volume) {
  for (std::vector<double>* field : p.fields()) field->push_back(0.0);
  p.x.back() = x;
  p.y.back() = y;
  p.volume.back() = volume;
}

struct Point {
  double x, y;
};

/// A marker pair at reference position `at` of the crack plane; its upper marker may lie elsewhere.
void add_pair(Crack& crack, double at, Point upper, bool intact) {
  crack.reference_x.push_back(at);
  crack.intact.push_back(intact);
  if (!intact) crack.front = std::max(crack.front, at);
  for (auto* values : {&crack.largest_normal, &crack.largest_shear, &crack.traction_normal, &crack.traction_shear,
                       &crack.rake_slip, &crack.edge_slip})
    values->push_back(0.0);
  for (const Side side : {below, above}) {
    Face& face = crack.face[side];
    face.x.push_back(side == above ? upper.x : at);
    face.y.push_back(side == above ? upper.y : 0.0);
    for (auto* values : {&face.velocity_x, &face.velocity_y, &face.force_x, &face.force_y, &face.offset_x,
                         &face.offset_y, &face.inverse_mass})
      values->push_back(0.0);
    face.node_column.push_back(0);
    face.node_row.push_back(0);
  }
}

/// The tool meets the layer's end first: the upper face goes on around it, down the end to the corner at the origin.
/// These markers continue the crack plane outside the block, where nothing is opposite.
void wrap_end(State& state, const Scene& scene) {
  const double spacing = state.crack.spacing;
  const int count = scene.resolution.cells_through_chip * scene.resolution.markers_per_cell;
  for (int i = count - 1; i >= 0; --i) add_pair(state.crack, -spacing * (i + 0.5), {0.0, spacing * (i + 0.5)}, false);
}

/// One column of cells at rest, from x on, both sides of the plane. Particles are appended unsorted.
void feed_column(State& state, const Scene& scene, double x) {
  const double cell = state.grid.cell;
  const int per_side = scene.resolution.particles_per_cell_side;
  const double gap = cell / per_side;
  const int down = per_side * static_cast<int>(std::lround(scene.window.below * scene.resolution.cells_through_chip));
  const int up = per_side * scene.resolution.cells_through_chip;
  for (int j = -down; j < up; ++j)
    for (int i = 0; i < per_side; ++i) push(state.particles, x + gap * (i + 0.5), gap * (j + 0.5), gap * gap);

  for (int i = 0; i < scene.resolution.markers_per_cell; ++i) {
    const double at = x + state.crack.spacing * (i + 0.5);
    add_pair(state.crack, at, {at, 0.0}, at > scene.cut.notch * scene.cut.depth);
  }
  state.fed_to = x + cell;
}

template <class T>
void erase_front(std::vector<T>& values, std::size_t count) {
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Drops the leading pairs of which neither face is in the window any more.
void retire_markers(Crack& crack, const Grid& grid) {
  std::size_t gone = 0;
  const auto inside = [&](const Face& face, std::size_t k) {
    return grid.holds(grid.column_of(face.x[k]), grid.row_of(face.y[k])) && face.inverse_mass[k] > 0.0;
  };
  while (gone < crack.size() && !inside(crack.face[below], gone) && !inside(crack.face[above], gone)) ++gone;
  if (gone == 0) return;
  for (auto* values : {&crack.reference_x, &crack.largest_normal, &crack.largest_shear, &crack.traction_normal,
                       &crack.traction_shear, &crack.rake_slip, &crack.edge_slip})
    erase_front(*values, gone);
  erase_front(crack.intact, gone);
  for (Face& face : crack.face) {
    for (auto* values : {&face.x, &face.y, &face.velocity_x, &face.velocity_y, &face.force_x, &face.force_y,
                         &face.offset_x, &face.offset_y, &face.inverse_mass})
      erase_front(*values, gone);
    erase_front(face.node_column, gone);
    erase_front(face.node_row, gone);
  }
}

void book_retired(State& state, const laws::J2& material, std::size_t i) {
  const Particles& p = state.particles;
  const double volume = p.volume[i];
  state.work.retired_elastic +=
      volume * material.elastic_energy(p.stress_xx[i], p.stress_yy[i], p.stress_zz[i], p.stress_xy[i]);
  state.work.retired_plastic += volume * material.plastic_work(p.plastic_strain[i]);
  state.work.retired_kinetic +=
      0.5 * volume * state.density * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
}

/// Keeps the particles that stand inside the window, sorted by (side, cell row, cell), each side padded to whole
/// batches. The side of entry i is told by `side_of`.
void sort_into_batches(State& state, const Scene& scene, const std::vector<Side>& side_of) {
  Particles& p = state.particles;
  const Grid& grid = state.grid;
  const double left = grid.origin_x + margin * grid.cell;
  const double top = scene.window.above * scene.cut.depth;
  const std::size_t cells = grid.nodes();
  std::vector<std::size_t> bin(p.size());
  std::vector<std::size_t> start(2 * cells + 1, 0);
  constexpr auto nowhere = static_cast<std::size_t>(-1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    bin[i] = nowhere;
    if (p.volume[i] == 0.0) continue;
    if (p.x[i] < left || p.y[i] > top) {
      book_retired(state, scene.material, i);
      continue;
    }
    const auto node =
        grid.node(static_cast<int>(grid.column_of(p.x[i]) - 0.5), static_cast<int>(grid.row_of(p.y[i]) - 0.5));
    bin[i] = (side_of[i] == above ? cells : 0) + node;
    ++start[bin[i] + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  const std::size_t kept_below = start[cells], kept = start[2 * cells];
  const auto padded = [](std::size_t n) { return (n + lane_count - 1) / lane_count * lane_count; };
  const std::size_t shift_above = padded(kept_below) - kept_below;
  p.begin = {0, padded(kept_below), padded(kept_below) + padded(kept - kept_below)};

  std::vector<std::size_t> source(p.begin[2], nowhere);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (bin[i] == nowhere) continue;
    const std::size_t place = start[bin[i]]++;
    source[bin[i] >= cells ? place + shift_above : place] = i;
  }
  for (std::vector<double>* field : p.fields()) {
    std::vector<double> sorted(p.begin[2], 0.0);
    for (std::size_t i = 0; i < sorted.size(); ++i)
      if (source[i] != nowhere) sorted[i] = (*field)[source[i]];
    *field = std::move(sorted);
  }
  // Padding rides along with the last real particle of its side, without volume.
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = p.begin[side] + 1; i < p.begin[side + 1]; ++i)
      if (source[i] == nowhere)
        for (std::vector<double>* field : p.fields())
          if (field != &p.volume) (*field)[i] = (*field)[i - 1];
}

std::vector<Side> sides(const Particles& p) {
  std::vector<Side> side(p.size(), below);
  for (std::size_t i = p.begin[1]; i < p.begin[2]; ++i) side[i] = above;
  for (std::size_t i = p.begin[2]; i < p.size(); ++i) side[i] = p.y[i] > 0.0 ? above : below;  // freshly fed
  return side;
}

}  // namespace

State lay_out(const Scene& scene) {
  State state;
  Grid& grid = state.grid;
  const int through = scene.resolution.cells_through_chip;
  const auto cells = [&](double depths) { return static_cast<int>(std::lround(depths * through)); };
  grid.cell = scene.cell();
  grid.inverse_cell = 1.0 / grid.cell;
  grid.columns = cells(scene.window.behind) + cells(scene.window.ahead) + 2 * margin;
  grid.rows = cells(scene.window.below) + cells(scene.window.above) + 2 * margin;
  grid.origin_x = -(cells(scene.window.behind) + margin) * grid.cell;
  // Two node rows below the block's lower end hold it. The crack plane lies midway between two rows: with a row in the
  // plane the faces' nodes get half a cell of material each, and the forces converge three times more slowly.
  grid.origin_y = -(cells(scene.window.below) + 1.5) * grid.cell;
  const std::size_t nodes = grid.nodes();
  constexpr std::size_t overread = lane_count;  // a row of three nodes is read as eight numbers
  for (VelocityField& field : grid.side) {
    field.mass.assign(nodes + overread, 0.0);
    for (auto* values : {&field.momentum, &field.velocity, &field.next_velocity, &field.change, &field.force})
      values->assign(2 * nodes + overread, 0.0);
  }
  state.density = scene.material.density;
  const double gap = grid.cell / scene.resolution.particles_per_cell_side;
  state.smallest_mass = 1e-12 * state.density * gap * gap;
  state.step = scene.resolution.courant_number * grid.cell / (scene.material.wave_speed() + scene.cut.speed);
  state.crack.spacing = grid.cell / scene.resolution.markers_per_cell;
  wrap_end(state, scene);
  for (int i = 0; i < cells(scene.window.ahead); ++i) feed_column(state, scene, i * grid.cell);
  sort_into_batches(state, scene, sides(state.particles));
  gather_momentum(state);
  return state;
}

void shift_window(State& state, const Scene& scene) {
  state.grid.origin_x += state.grid.cell;
  feed_column(state, scene, state.fed_to);
  sort_into_batches(state, scene, sides(state.particles));
  gather_momentum(state);
  retire_markers(state.crack, state.grid);
}

}  // namespace kerf::forward
