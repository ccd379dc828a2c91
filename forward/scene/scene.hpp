#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/base/document.hpp"
#include "models/laws/j2.hpp"
#include "models/laws/traction_law.hpp"

namespace kerf::forward {

/// A cut, as plain data in consistent units (mm, MPa, N, tonne, s, rad). An effect that a scene may leave out is an
/// optional block; absence is the only way to switch it off.

struct Cohesive {
  std::shared_ptr<const laws::TractionLaw> mode_I, mode_II;
  double exponent_n, exponent_m;  ///< failure at (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1
};

struct Cut {
  double depth;   ///< h: thickness of the layer above the crack plane
  double speed;   ///< of the tool, +x
  double ramp;    ///< time in which the tool reaches its speed
  double notch;   ///< length already separated when the tool arrives, in depths
  double travel;  ///< longest tool travel, in depths
};

struct Tool {
  double rake;       ///< alpha, from the crack plane's normal
  double clearance;  ///< between clearance face and crack plane
};

/// Coulomb friction on the rake face, tau = min(mu p, cap sigma_y/sqrt(3)).
struct Friction {
  double coefficient;
  double yield_cap;
};

/// The clearance side pressed into the freshly cut face, its height tied to that face (a worn edge).
struct EdgeContact {
  double press_in;     ///< delta: how far the edge sits below the face that comes towards it
  double edge_radius;  ///< R_L of the lower edge
  double friction;     ///< Coulomb coefficient there
};

/// FLIP blended towards PIC at a rate in cell transits of the elastic wave: beta = 1 - exp(-rate CFL) each step.
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
  double tolerance;   ///< relative standard error of F_c at which the cut may stop
  double not_before;  ///< tool travel, in depths, before which it never stops
};

struct Scene {
  std::string title;
  laws::J2 material;
  Cohesive cohesive;
  Cut cut;
  Tool tool;
  std::optional<Friction> friction;
  std::optional<EdgeContact> edge_contact;
  std::optional<PicDamping> pic_damping;
  Window window;
  Resolution resolution;
  SteadyState steady_state;

  double cell() const { return cut.depth / resolution.cells_through_chip; }
};

/// Every block a scene may hold, with its parameters; what `kerf list`, `kerf check` and calibrations read.
const std::vector<Block>& scene_blocks();

/// Throws InputError on anything that is not a valid scene.
Scene read_scene(const Document& document);

}  // namespace kerf::forward
