#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "forward/mpm/array.hpp"
#include "forward/scene/scene.hpp"
#include "forward/scene/tool_face.hpp"

namespace kerf::forward {

/// Particles and nodes belong to one side of the crack plane, told once by a label: a velocity field each.
enum Side { below = 0, above = 1 };

/// Material points, structure of arrays, sorted by (side, cell row, cell); each side is padded to whole batches of
/// `lane_count` with points of zero volume. Units mm, mm/s, MPa; volume is the reference volume per unit width, mm^2.
struct Particles {
  Array x, y, velocity_x, velocity_y;
  Array stress_xx, stress_yy, stress_zz, stress_xy;  ///< Kirchhoff stress
  Array plastic_strain, volume;
  Array axis_x, axis_y;  ///< direction of the grain; only for materials that have one
  Array conducted;       ///< temperature that conduction and friction have added, K; only with either
  std::array<std::size_t, 3> begin{0, 0, 0};  ///< side s owns [begin[s], begin[s + 1])
  bool has_axes = false, keeps_heat = false;

  struct Field {
    Array* values;
    const char* name;
    double at_rest;  ///< of material that nothing has happened to
  };
  std::vector<Field> fields() {
    std::vector<Field> all{{&x, "position x", 0},
                           {&y, "position y", 0},
                           {&velocity_x, "velocity x", 0},
                           {&velocity_y, "velocity y", 0},
                           {&stress_xx, "Kirchhoff stress xx", 0},
                           {&stress_yy, "Kirchhoff stress yy", 0},
                           {&stress_zz, "Kirchhoff stress zz", 0},
                           {&stress_xy, "Kirchhoff stress xy", 0},
                           {&plastic_strain, "plastic strain", 0},
                           {&volume, "reference volume", 0}};
    if (has_axes) {
      all.push_back({&axis_x, "grain direction x", 1});
      all.push_back({&axis_y, "grain direction y", 0});
    }
    if (keeps_heat) all.push_back({&conducted, "conducted temperature", 0});
    return all;
  }
  std::size_t size() const { return x.size(); }

  /// The eight points from `first` on, as a material law wants them.
  template <bool with_axes>
  laws::MaterialPoints material_points(std::size_t first) const {
    laws::MaterialPoints points{load(&stress_xx[first]),
                                load(&stress_yy[first]),
                                load(&stress_zz[first]),
                                load(&stress_xy[first]),
                                load(&plastic_strain[first]),
                                {},
                                {}};
    if constexpr (with_axes) {
      points.axis_x = load(&axis_x[first]);
      points.axis_y = load(&axis_y[first]);
    }
    return points;
  }
  template <bool with_axes>
  void set(std::size_t first, const laws::MaterialPoints& points) {
    store(&stress_xx[first], points.xx);
    store(&stress_yy[first], points.yy);
    store(&stress_zz[first], points.zz);
    store(&stress_xy[first], points.xy);
    store(&plastic_strain[first], points.plastic_strain);
    if constexpr (with_axes) {
      store(&axis_x[first], points.axis_x);
      store(&axis_y[first], points.axis_y);
    }
  }
  laws::StressPoint stress(std::size_t i) const {
    laws::StressPoint point{stress_xx[i], stress_yy[i], stress_zz[i], stress_xy[i]};
    if (has_axes) {
      point.axis_x = axis_x[i];
      point.axis_y = axis_y[i];
    }
    return point;
  }
};

/// One side's nodes, row-major; vectors are interleaved (x, y), so that three nodes of a row lie side by side.
struct VelocityField {
  Array mass, momentum, velocity, force;
  Array change;    ///< of the velocity in this step
  Array filtered;  ///< what XPIC blends towards; empty without it
  struct Span {
    int begin = 0, end = 0;  ///< columns, multiples of `lane_count`
  };
  std::vector<Span> spans;  ///< of each row: where the side has material, with room to move until the next sort
};

/// The regular grid that travels with the tool in whole cells. Node (i, j) stands at origin + (i cell_x, j cell_y);
/// cells may be longer along the cut than they are high.
struct Grid {
  int columns = 0, rows = 0;
  int stride = 0;  ///< from one row to the next: the columns, rounded up to whole batches
  double cell_x = 0, cell_y = 0, inverse_cell_x = 0, inverse_cell_y = 0, origin_x = 0, origin_y = 0;
  double left = 0, top = 0;  ///< material beyond these leaves the window at its next shift
  std::array<VelocityField, 2> side;
  bool clamps_end = false;  ///< the far end is held across the crack plane too, not only along it

  std::size_t nodes() const { return static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows); }
  std::size_t node(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(i);
  }
  /// Calls visit(first node) for every batch of eight nodes of a row at which the field may have material.
  template <class Visit>
  void each_batch(const VelocityField& field, Visit&& visit) const {
    for (int j = 0; j < rows; ++j) {
      const VelocityField::Span& span = field.spans[static_cast<std::size_t>(j)];
      for (int i = span.begin; i < span.end; i += static_cast<int>(lane_count)) visit(node(i, j));
    }
  }
  double column_of(double x) const { return (x - origin_x) * inverse_cell_x; }
  double row_of(double y) const { return (y - origin_y) * inverse_cell_y; }
  /// True when all nodes that a point at these grid coordinates touches exist (false for NaN).
  bool holds(double column, double row) const {
    return column >= 1.0 && row >= 1.0 && column < columns - 2.0 && row < rows - 2.0;
  }
  /// True where a marker has material all around: at the edges of the window it would follow what is left of it.
  bool carries(double x, double y) const { return x > left + cell_x && y < top - cell_y; }
};

/// Markers on a surface of the work, in the order of their reference position.
struct Face {
  std::vector<double> x, y, velocity_x, velocity_y;
  std::vector<double> force_x, force_y;    ///< N/mm, on the body
  std::vector<int> node_column, node_row;  ///< first node of the mass-weighted kernel ...
  std::vector<double> offset_x, offset_y;  ///< ... and the spline offsets there
  std::vector<double> inverse_mass;        ///< 1 / sum w m; zero where the face has left the window
  std::vector<double> moved_mass;          ///< tonne/mm that a force on the marker moves: (sum w m)^2 / sum w^2 m
  std::vector<std::vector<double>> slip;   ///< elastic part of the sliding (mm), one list per frictional contact
  std::size_t size() const { return x.size(); }

  void add(double at_x, double at_y);
  void drop_first(std::size_t count);
  bool is_in(const Grid& grid, std::size_t k) const {
    return inverse_mass[k] > 0.0 && grid.holds(grid.column_of(x[k]), grid.row_of(y[k]));
  }
};

/// Marker pairs along the crack plane: entry k of one face is opposite entry k of the other.
struct Crack {
  std::array<Face, 2> face;
  std::vector<double> reference_x;                    ///< along the path
  std::vector<double> largest_normal, largest_shear;  ///< openings so far, mm
  std::vector<double> largest_share;                  ///< of the critical openings so far, where the laws are coupled
  std::vector<double> traction_normal, traction_shear;
  std::vector<double> taken;  ///< work of the tractions, N/mm
  std::vector<std::uint8_t> intact;
  double spacing = 0;
  double front = 0;              ///< reference position of the foremost broken pair
  std::optional<Spiral> spiral;  ///< that the path follows in a log; absent: the plane y = 0
  /// What a pair remembers; zero to begin with.
  std::array<std::vector<double>*, 6> memory() {
    return {&largest_normal, &largest_shear, &largest_share, &traction_normal, &traction_shear, &taken};
  }
  std::size_t size() const { return reference_x.size(); }
  /// Normal of the crack path at pair k, from the lower to the upper side, when the tool has travelled so far.
  Spiral::Direction normal(std::size_t k, double travel) const {
    return spiral ? spiral->normal(reference_x[k], travel) : Spiral::Direction{0.0, 1.0};
  }
};

struct ToolState {
  double x = 0, y = 0, speed = 0, vertical_speed = 0;
  double start = 0;                       ///< x where the run began
  double overlap = 0;                     ///< mean penetration of the lower face in the last step, mm
  double sink = 0;                        ///< by how much the edge is lowered to make up for it, mm
  double tip_radius = 0, tip_growth = 0;  ///< mm, and its change in this step
};

/// Force of the tool on the work this step, N/mm, and the deepest penetration (mm).
struct ToolForce {
  std::array<FaceForce, tool_face_count> face;
  double on_work_x = 0, on_work_y = 0;
  double penetration = 0;
  double bottom_overlap = 0;  ///< sum of pressure times penetration on the lower face, N/mm mm
  double at_edge = 0;         ///< sum of the pressures on the chip near the edges where the window cuts it, N/mm
  double release = 0;         ///< energy release rate of a specimen in grips, N/mm
};

/// Work done since the start, N mm/mm; what cannot be read off the state is added up here.
struct Work {
  double tool = 0, mode_I = 0, mode_II = 0, friction = 0, damping = 0;
  double friction_heat = 0;  ///< part of `friction` that stays in the work as heat
  double retired_elastic = 0, retired_plastic = 0, retired_kinetic = 0;
  double broken_length = 0;  ///< mm of crack path whose bonds are gone
  double lost_length = 0;    ///< ... of path that left the window with bonds that still held
  double broken_energy = 0;  ///< what these had taken, N mm/mm
};

/// Everything that a step reads and writes.
struct State {
  Particles particles;
  Grid grid;
  Crack crack;
  Face top;  ///< outer surface of the layer; followed only where something may touch it
  bool follows_top = false;
  ToolState tool;
  ToolForce force;
  Work work;
  /// Of friction in this step, at each side's nodes, over their mass: mm^2/s^2. Empty unless friction heats.
  std::array<std::vector<double>, 2> friction_heat;
  double contact_energy = 0;  ///< stored in contact springs this instant, N mm/mm
  double time = 0, step = 0;  ///< step: the time step
  double spin = 0;            ///< of a log, rad/s
  double density = 0;         ///< tonne/mm^3
  double smallest_mass = 0;   ///< nodes below it are empty
  double fed_to = 0;          ///< right end of the material laid so far
  double next_crossing = 0;   ///< tool position at which the window follows next
  std::string breakdown;      ///< why the run cannot go on; empty while it can
};

/// The stiffest penalty spring (MPa/mm) that the time step can follow on a marker that moves this mass: where stretched
/// material leaves little mass at its surface, its vibration would be faster. Several markers share the mass.
inline double stiffest_spring(const State& state, double moved_mass) {
  return 0.25 * moved_mass / (state.step * state.step * state.grid.cell_x);
}

}  // namespace kerf::forward
