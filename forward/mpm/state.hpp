#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "forward/scene/scene.hpp"

namespace kerf::forward {

/// Particles and nodes belong to one side of the crack plane, told once by a label: a velocity field each.
enum Side { below = 0, above = 1 };

constexpr std::size_t lane_count = 8;

/// Material points, structure of arrays, sorted by (side, cell row, cell); each side is padded to whole batches of
/// `lane_count` with points of zero volume. Units mm, mm/s, MPa; volume is the reference volume per unit width, mm^2.
struct Particles {
  std::vector<double> x, y, velocity_x, velocity_y;
  std::vector<double> stress_xx, stress_yy, stress_zz, stress_xy;  ///< Kirchhoff stress
  std::vector<double> plastic_strain, volume;
  std::array<std::size_t, 3> begin{0, 0, 0};  ///< side s owns [begin[s], begin[s + 1])

  std::array<std::vector<double>*, 10> fields() {
    return {&x, &y, &velocity_x, &velocity_y, &stress_xx, &stress_yy, &stress_zz, &stress_xy, &plastic_strain, &volume};
  }
  std::size_t size() const { return x.size(); }
};

/// One side's nodes, row-major; vectors are interleaved (x, y), so that three nodes of a row lie side by side.
struct VelocityField {
  std::vector<double> mass, momentum, velocity, next_velocity, change, force;
};

/// The regular grid that travels with the tool in whole cells. Node (i, j) stands at origin + cell (i, j).
struct Grid {
  int columns = 0, rows = 0;
  double cell = 0, inverse_cell = 0, origin_x = 0, origin_y = 0;
  std::array<VelocityField, 2> side;

  std::size_t nodes() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t node(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
  }
  double column_of(double x) const { return (x - origin_x) * inverse_cell; }
  double row_of(double y) const { return (y - origin_y) * inverse_cell; }
  /// True when all nodes that a point at these grid coordinates touches exist (false for NaN).
  bool holds(double column, double row) const {
    return column >= 1.0 && row >= 1.0 && column < columns - 2.0 && row < rows - 2.0;
  }
};

/// Markers on one face of the crack; entry k faces entry k of the other side.
struct Face {
  std::vector<double> x, y, velocity_x, velocity_y;
  std::vector<double> force_x, force_y;    ///< N/mm, on the body
  std::vector<int> node_column, node_row;  ///< first node of the mass-weighted kernel ...
  std::vector<double> offset_x, offset_y;  ///< ... and the spline offsets there
  std::vector<double> inverse_mass;        ///< 1 / sum w m; zero where the face has left the window
};

/// Marker pairs along the crack plane in the order of their reference position.
struct Crack {
  std::array<Face, 2> face;
  std::vector<double> reference_x;
  std::vector<double> largest_normal, largest_shear;  ///< openings so far, mm
  std::vector<double> traction_normal, traction_shear;
  std::vector<double> rake_slip, edge_slip;  ///< elastic part of the sliding on the tool, mm
  std::vector<double> rake_pressure;         ///< of this step, MPa
  std::vector<std::uint8_t> intact;
  double spacing = 0;
  double front = 0;  ///< reference position of the foremost broken pair
  std::size_t size() const { return reference_x.size(); }
};

struct ToolState {
  double x = 0, y = 0, speed = 0, vertical_speed = 0;
};

/// Force of the tool on the work this step, N/mm, and the deepest penetration (mm).
struct ToolForce {
  double rake_normal = 0, rake_tangential = 0, bottom_normal = 0, bottom_tangential = 0;
  double slip_limit = 0;  ///< rake_tangential when every point slides
  double on_work_x = 0, on_work_y = 0;
  double penetration = 0;
};

/// Work done since the start, N mm/mm; what cannot be read off the state is added up here.
struct Work {
  double tool = 0, mode_I = 0, mode_II = 0, friction = 0, damping = 0;
  double retired_elastic = 0, retired_plastic = 0, retired_kinetic = 0;
};

/// Everything that a step reads and writes.
struct State {
  Particles particles;
  Grid grid;
  Crack crack;
  ToolState tool;
  ToolForce force;
  Work work;
  double contact_energy = 0;  ///< stored in contact springs this instant, N mm/mm
  double time = 0, step = 0;  ///< step: the time step
  double density = 0;         ///< tonne/mm^3
  double smallest_mass = 0;   ///< nodes below it are empty
  double fed_to = 0;          ///< right end of the material laid so far
  bool broken_down = false;   ///< a particle left the grid or is not a number
};

}  // namespace kerf::forward
