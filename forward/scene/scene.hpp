#pragma once

#include <optional>
#include <vector>

#include "models/base/document.hpp"

namespace kerf::forward {

/// A cut, as plain data in consistent units (mm, MPa, N, tonne, s, rad). An effect that a scene may leave out is an
/// optional block; absence is the only way to switch it off.
struct Material {
  double elastic_modulus, poisson_ratio, density;
  double yield_stress, hardening_modulus;
};

struct CohesiveMode {
  double strength, toughness;
};

struct Cohesive {
  CohesiveMode mode_I, mode_II;
  double exponent_n, exponent_m;  ///< (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1 at failure
};

struct Cut {
  double depth;
  double speed;
  double ramp;    ///< the tool reaches its speed after this time
  double notch;   ///< length already cut when the tool arrives
  double length;  ///< the longest tool travel
};

struct Tool {
  double rake;
  double friction;   ///< Coulomb coefficient of the rake face
  double shear_cap;  ///< friction never exceeds shear_cap * shear yield stress
};

/// The clearance side pressed against the freshly cut face, its height tied to that face.
struct BottomContact {
  double press_in, edge_radius, clearance, friction;
};

/// FLIP blended towards PIC, as a rate in units of wave transits of a cell: beta = 1 - exp(-rate * CFL) each step.
struct PicDamping {
  double rate;
};

/// Extent of the simulated material around the tool tip, in depths of cut.
struct Window {
  double ahead, behind, below, above;
};

struct Resolution {
  int cells_through_chip, particles_per_cell_side, markers_per_cell;
  double courant_number;
};

struct SteadyState {
  double tolerance;  ///< relative standard error of F_c at which the cut may stop
  double shortest;   ///< tool travel, in depths of cut, before which it never stops
};

struct Scene {
  std::string title;
  Material material;
  Cohesive cohesive;
  Cut cut;
  Tool tool;
  std::optional<BottomContact> bottom_contact;
  std::optional<PicDamping> pic_damping;
  Window window;
  Resolution resolution;
  SteadyState steady_state;
};

/// Every block a scene may hold, with its parameters; what `kerf list`, `kerf check` and calibrations read.
const std::vector<Block>& scene_blocks();

/// Throws InputError on anything that is not a valid scene.
Scene read_scene(const Document& document);

}  // namespace kerf::forward
