#include "forward/mpm/window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "forward/effects/heat.hpp"
#include "forward/mpm/tool.hpp"
#include "forward/mpm/transfer.hpp"

namespace kerf::forward {
namespace {

constexpr int margin = 4;  // cells around the window that stay free for the kernel

void push(Particles& p, double x, double y, double volume) {
  for (const Particles::Field& field : p.fields()) field.values->push_back(field.at_rest);
  p.x.back() = x;
  p.y.back() = y;
  p.volume.back() = volume;
}

struct Point {
  double x, y;
};

/// A marker pair at reference position `at` of the crack path.
void add_pair(Crack& crack, double at, Point lower, Point upper, bool intact) {
  crack.reference_x.push_back(at);
  crack.intact.push_back(intact);
  if (!intact) crack.front = std::max(crack.front, at);
  for (auto* values : crack.memory()) values->push_back(0.0);
  crack.face[below].add(lower.x, lower.y);
  crack.face[above].add(upper.x, upper.y);
}

/// The tool meets the layer's end first: the upper face goes on around it, down the end to the corner at the origin.
/// These markers continue the crack plane outside the block, where nothing is opposite.
void wrap_end(State& state, const Scene& scene) {
  const double spacing = state.crack.spacing;
  const int count = std::max(1, static_cast<int>(std::lround(scene.cut.depth / spacing)));
  const double along_end = scene.cut.depth / count;
  for (int i = count - 1; i >= 0; --i) {
    const double at = -spacing * (i + 0.5);
    add_pair(state.crack, at, {at, 0.0}, {0.0, along_end * (i + 0.5)}, false);
  }
}

/// One column of cells at rest, from x on, both sides of the plane. Particles are appended unsorted.
void feed_column(State& state, const Scene& scene, double x) {
  const int up_cell = scene.resolution.particles_per_cell_side, along_cell = scene.particles_along_cell();
  const double gap_x = state.grid.cell_x / along_cell, gap_y = state.grid.cell_y / up_cell;
  const double per_depth = up_cell * scene.resolution.cells_through_chip;
  const int down = static_cast<int>(std::lround(scene.fine_base_height() * per_depth));
  const int up = up_cell * scene.resolution.cells_through_chip;
  for (int j = -down; j < up; ++j)
    for (int i = 0; i < along_cell; ++i) push(state.particles, x + gap_x * (i + 0.5), gap_y * (j + 0.5), gap_x * gap_y);
  // Below, one particle stands between four nodes: on a row of nodes it would not feel a strain that alternates across
  // it. The lowest, in material that is held, stands for what is left.
  const double bottom = -scene.base_height() * scene.cut.depth, height = state.grid.cell_y;
  for (double top = -down * gap_y; top > bottom + 0.25 * height; top -= height) {
    const double low = std::max(top - height, bottom);
    push(state.particles, x + 0.5 * state.grid.cell_x, 0.5 * (top + low), state.grid.cell_x * (top - low));
  }

  for (int i = 0; i < scene.resolution.markers_per_cell; ++i) {
    const double at = x + state.crack.spacing * (i + 0.5);
    add_pair(state.crack, at, {at, 0.0}, {at, 0.0}, at > scene.cut.notch * scene.cut.depth);
    if (state.follows_top) state.top.add(at, scene.cut.depth);
  }
  state.fed_to = x + state.grid.cell_x;
}

/// The whole log at rest, from the spindle outwards, in rows along the spiral, and the sides of its particles. Where
/// the path is not prepared to part, the layer belongs to the lower side.
std::vector<Side> lay_log(State& state, const Scene& scene) {
  const Spiral& path = scene.log->path;
  const int per_cell = scene.resolution.particles_per_cell_side;
  const double gap = scene.cell() / per_cell, deepest = scene.log->core - 1.5 * scene.cell();
  const auto at_height = [&](double s, double height) {
    const double angle = path.angle_at(s), r = path.radius_at(s) + height;
    return Point{r * std::sin(angle), r * std::cos(angle) - path.radius()};
  };
  std::vector<Side> side_of;
  Particles& p = state.particles;
  const auto columns = static_cast<int>(std::lround(path.turn_length() / gap));
  const double column = path.turn_length() / columns;
  const int up = per_cell * scene.resolution.cells_through_chip;
  const int down = static_cast<int>(std::ceil((path.radius() - deepest) / gap));
  for (int i = 0; i < columns; ++i) {
    const double s = column * (i + 0.5), r = path.radius_at(s), angle = path.angle_at(s);
    for (int j = -down; j < up; ++j) {
      const double height = gap * (j + 0.5);
      if (r + height < deepest) continue;
      const auto [x, y] = at_height(s, height);
      push(p, x, y, gap * column * (r + height) / r);
      if (p.has_axes) {
        p.axis_x.back() = std::cos(angle);
        p.axis_y.back() = -std::sin(angle);
      }
      side_of.push_back(j >= 0 && s < scene.log->length ? above : below);
    }
  }
  const auto pairs = static_cast<int>(scene.log->length / state.crack.spacing);
  for (int i = 0; i < pairs; ++i) {
    const double at = state.crack.spacing * (i + 0.5);
    const Point place = at_height(at, 0.0), top = at_height(at, scene.cut.depth);
    add_pair(state.crack, at, place, place, at > scene.cut.notch * scene.cut.depth);
    if (state.follows_top) state.top.add(top.x, top.y);
  }
  state.crack.spiral = path;
  return side_of;
}

template <class T>
void erase_front(std::vector<T>& values, std::size_t count) {
  values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}

/// Drops the leading markers that are not in the window any more; of a pair, when neither is.
void retire_markers(State& state) {
  Crack& crack = state.crack;
  std::size_t gone = 0;
  while (gone < crack.size() && !crack.face[below].is_in(state.grid, gone) &&
         !crack.face[above].is_in(state.grid, gone))
    ++gone;
  if (gone > 0) {
    for (std::size_t k = 0; k < gone; ++k)
      if (crack.intact[k]) state.work.lost_length += crack.spacing;
    erase_front(crack.reference_x, gone);
    for (auto* values : crack.memory()) erase_front(*values, gone);
    erase_front(crack.intact, gone);
    for (Face& face : crack.face) face.drop_first(gone);
  }
  gone = 0;
  while (gone < state.top.size() && !state.top.is_in(state.grid, gone)) ++gone;
  if (gone > 0) state.top.drop_first(gone);
}

void book_retired(State& state, const laws::Material& material, std::size_t i) {
  const Particles& p = state.particles;
  const double volume = p.volume[i];
  std::visit(
      [&](const auto& law) {
        state.work.retired_elastic += volume * law.elastic_energy(p.stress(i));
        state.work.retired_plastic += volume * law.plastic_work(p.plastic_strain[i]);
      },
      material);
  state.work.retired_kinetic +=
      0.5 * volume * state.density * (p.velocity_x[i] * p.velocity_x[i] + p.velocity_y[i] * p.velocity_y[i]);
}

/// How far material may move between two sorts, in cell lengths: the tool moves one.
constexpr int largest_move = 2;

/// The part of each row that particles can touch until the next sort. `count` holds how many have each node as the
/// first of their three by three. A specimen in grips is sorted once and may touch every node.
void find_spans(const Grid& grid, VelocityField& field, std::span<const std::size_t> count, bool everywhere) {
  using Span = VelocityField::Span;
  field.spans.assign(static_cast<std::size_t>(grid.rows), everywhere ? Span{0, grid.stride} : Span{grid.stride, 0});
  if (everywhere) return;
  const int across = largest_move * static_cast<int>(std::ceil(grid.cell_x / grid.cell_y));
  for (int j = 0; j < grid.rows; ++j) {
    int first = grid.stride, last = -1;
    for (int i = 0; i < grid.columns; ++i)
      if (count[grid.node(i, j)] > 0) {
        first = std::min(first, i);
        last = i;
      }
    if (last < 0) continue;
    constexpr int batch = static_cast<int>(lane_count);
    const int begin = std::max(0, first - largest_move) / batch * batch;
    const int end = std::min(grid.stride, (last + 3 + largest_move + batch - 1) / batch * batch);
    for (int row = std::max(0, j - across); row <= std::min(grid.rows - 1, j + 2 + across); ++row) {
      Span& span = field.spans[static_cast<std::size_t>(row)];
      span = {std::min(span.begin, begin), std::max(span.end, end)};
    }
  }
}

/// Were all nodes of a particle within the spans? The grid has moved by a column since they were laid.
bool has_room(const Grid& grid, const VelocityField& field, int column, int row) {
  const auto in_span = [&](int j) {
    const VelocityField::Span& span = field.spans[static_cast<std::size_t>(j)];
    return column + 1 >= span.begin && column + 4 <= span.end;
  };
  return row >= 0 && row + 2 < grid.rows && in_span(row) && in_span(row + 2);
}

/// Keeps the particles that stand inside the window, sorted by (side, cell row, cell), each side dealt out in whole
/// batches. The side of entry i is told by `side_of`.
void sort_into_batches(State& state, const Scene& scene, const std::vector<Side>& side_of) {
  Particles& p = state.particles;
  const Grid& grid = state.grid;
  const std::size_t cells = grid.nodes();
  std::vector<std::size_t> bin(p.size());
  std::vector<std::size_t> start(2 * cells + 1, 0);
  constexpr auto nowhere = static_cast<std::size_t>(-1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    bin[i] = nowhere;
    if (p.volume[i] == 0.0) continue;
    if (p.x[i] < grid.left || p.y[i] > grid.top) {
      book_retired(state, scene.material, i);
      continue;
    }
    const int column = static_cast<int>(grid.column_of(p.x[i]) - 0.5);
    const int row = static_cast<int>(grid.row_of(p.y[i]) - 0.5);
    const bool was_here = i < p.begin[2];  // and not fed just now
    if (was_here && !has_room(grid, state.grid.side[side_of[i]], column, row)) [[unlikely]]
      state.breakdown = fmt::format("material moved more than {} cells while the tool moved one", largest_move);
    const std::size_t node = grid.node(column, row);
    bin[i] = (side_of[i] == above ? cells : 0) + node;
    ++start[bin[i] + 1];
  }
  for (std::size_t side = 0; side < 2; ++side)
    find_spans(grid, state.grid.side[side], std::span(start).subspan(side * cells + 1, cells), scene.grips.has_value());
  std::partial_sum(start.begin(), start.end(), start.begin());
  const std::size_t kept_below = start[cells], kept = start[2 * cells];
  const auto padded = [](std::size_t n) { return (n + lane_count - 1) / lane_count * lane_count; };
  p.begin = {0, padded(kept_below), padded(kept_below) + padded(kept - kept_below)};

  std::vector<std::size_t> source(p.begin[2], nowhere);
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (bin[i] == nowhere) continue;
    const std::size_t place = start[bin[i]]++;
    const std::size_t side = bin[i] >= cells ? 1 : 0, first = p.begin[side];
    // Each lane walks through its own part of the side: a batch then never adds twice to one node, which would wait.
    const std::size_t rank = place - (side ? kept_below : 0), batches = (p.begin[side + 1] - first) / lane_count;
    source[first + rank % batches * lane_count + rank / batches] = i;
  }
  for (const Particles::Field& field : p.fields()) {
    Array sorted(p.begin[2], field.at_rest);
    for (std::size_t i = 0; i < sorted.size(); ++i)
      if (source[i] != nowhere) sorted[i] = (*field.values)[source[i]];
    *field.values = std::move(sorted);
  }
  // Padding rides along with the last real particle of its side, without volume.
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = p.begin[side] + 1; i < p.begin[side + 1]; ++i)
      if (source[i] == nowhere)
        for (const Particles::Field& field : p.fields())
          if (field.values != &p.volume) (*field.values)[i] = (*field.values)[i - 1];
}

std::vector<Side> sides(const Particles& p) {
  std::vector<Side> side(p.size(), below);
  for (std::size_t i = p.begin[1]; i < p.begin[2]; ++i) side[i] = above;
  for (std::size_t i = p.begin[2]; i < p.size(); ++i) side[i] = p.y[i] > 0.0 ? above : below;  // freshly fed
  return side;
}

/// Cells of the window around the tip.
struct Extent {
  int ahead, behind, below, above;
};

Extent extent_of(const Scene& scene) {
  const int through = scene.resolution.cells_through_chip;
  const auto up = [&](double depths) { return static_cast<int>(std::lround(depths * through)); };
  const auto along = [&](double depths) {
    return static_cast<int>(std::lround(depths * through / scene.resolution.cell_stretch));
  };
  const Window& window = scene.window;
  if (scene.log) {  // with a cell of room all around, and half a depth for its growing surface
    const double radius = scene.log->path.radius() / scene.cut.depth + 1.5;
    return {up(radius), up(std::max(radius, window.behind)), up(2.0 * radius), up(window.above)};
  }
  return {along(window.ahead), along(window.behind), up(window.below), up(window.above)};
}

/// The stable time step in the directions that the grain has now.
double stable_step(const State& state, const Scene& scene) {
  double step = stable_step(scene, 1.0, 0.0);
  const Particles& p = state.particles;
  if (p.has_axes)
    for (std::size_t i = p.begin[scene.log ? below : above]; i < p.begin[above + 1]; ++i)
      step = std::min(step, stable_step(scene, p.axis_x[i], p.axis_y[i]));
  return scene.thermal && scene.thermal->conductivity > 0.0 ? std::min(step, longest_conduction_step(state.grid, scene))
                                                            : step;
}

}  // namespace

double stable_step(const Scene& scene, double grain_x, double grain_y) {
  return std::visit(
      [&](const auto& law) {
        const double along = (law.wave_speed(grain_x, -grain_y) + scene.cut.speed) / scene.cell_length(),
                     across = (law.wave_speed(grain_y, grain_x) + scene.cut.speed) / scene.cell();
        return scene.resolution.courant_number / std::max(along, across);
      },
      scene.material);
}

State lay_out(const Scene& scene) {
  State state;
  Grid& grid = state.grid;
  const Extent extent = extent_of(scene);
  grid.cell_x = scene.cell_length();
  grid.cell_y = scene.cell();
  grid.clamps_end = scene.grips.has_value();
  grid.inverse_cell_x = 1.0 / grid.cell_x;
  grid.inverse_cell_y = 1.0 / grid.cell_y;
  grid.columns = extent.behind + extent.ahead + 2 * margin;
  constexpr int batch = static_cast<int>(lane_count);
  grid.stride = (grid.columns + batch - 1) / batch * batch;
  grid.rows = extent.below + extent.above + 2 * margin;
  grid.origin_x = -(extent.behind + margin) * grid.cell_x;
  // Two node rows below the block's lower end hold it. The crack plane lies midway between two rows: with a row in the
  // plane the faces' nodes get half a cell of material each, and the forces converge three times more slowly.
  grid.origin_y = -(extent.below + 1.5) * grid.cell_y;
  grid.left = grid.origin_x + margin * grid.cell_x;
  grid.top = scene.window.above * scene.cut.depth;
  const std::size_t nodes = grid.nodes();
  constexpr std::size_t overread = lane_count;  // a row of three nodes is read as eight numbers
  for (VelocityField& field : grid.side) {
    field.mass.assign(nodes + overread, 0.0);
    for (auto* values : {&field.momentum, &field.velocity, &field.change, &field.force})
      values->assign(2 * nodes + overread, 0.0);
  }
  state.density = laws::density(scene.material);
  state.particles.has_axes = laws::has_axes(scene.material);
  state.particles.keeps_heat = scene.thermal && scene.thermal->is_kept();
  if (scene.thermal && scene.thermal->friction_share > 0.0)
    for (std::vector<double>& heat : state.friction_heat) heat.assign(nodes, 0.0);
  state.smallest_mass = 1e-12 * state.density * grid.cell_x * grid.cell_y / scene.particles_per_cell();
  state.crack.spacing = scene.marker_spacing();
  const std::vector<Contact> touching = contacts(scene);
  state.follows_top = needs_top(touching);
  for (const Contact& contact : touching)
    if (contact.friction > 0.0) surface(state, contact.surface).slip.emplace_back();
  if (scene.face_friction) state.crack.face[above].slip.emplace_back();  // behind those of the tool
  if (!scene.grips) wrap_end(state, scene);
  if (scene.log) {
    sort_into_batches(state, scene, lay_log(state, scene));
  } else {
    for (int i = 0; i < extent.ahead; ++i) feed_column(state, scene, i * grid.cell_x);
    sort_into_batches(state, scene, sides(state.particles));
  }
  settle(state, scene);
  return state;
}

void settle(State& state, const Scene& scene) {
  state.step = stable_step(state, scene);
  gather_momentum(state);
}

void shift_window(State& state, const Scene& scene) {
  state.grid.origin_x += state.grid.cell_x;
  state.grid.left += state.grid.cell_x;
  if (!scene.log) feed_column(state, scene, state.fed_to);
  sort_into_batches(state, scene, sides(state.particles));
  settle(state, scene);
  retire_markers(state);
}

}  // namespace kerf::forward
