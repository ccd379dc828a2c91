#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "forward/scene/spiral.hpp"
#include "forward/scene/tool_face.hpp"
#include "models/base/document.hpp"
#include "models/laws/material.hpp"
#include "models/laws/traction_law.hpp"

namespace kerf::forward {

/// A cut, as plain data in consistent units (mm, MPa, N, tonne, s, rad). An effect that a scene may leave out is an
/// optional block; absence is the only way to switch it off.

/// When a pair of crack faces fails, in terms of the modes' shares of their toughness.
enum class MixedMode {
  areas,       ///< G_I, G_II are the areas under the laws up to the largest openings
  dissipated,  ///< ... without what unloading to the origin would give back
  coupled      ///< both laws at one common share of the critical openings (Tvergaard 1990); the exponents do not count
};

struct Cohesive {
  std::shared_ptr<const laws::TractionLaw> mode_I, mode_II;
  double exponent_n, exponent_m;  ///< failure at (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1
  MixedMode mixed_mode = MixedMode::areas;
};

struct Cut {
  double depth;   ///< h: thickness of the layer above the crack plane
  double speed;   ///< of the tool, +x
  double ramp;    ///< time in which the tool reaches its speed
  double notch;   ///< length already separated when the tool arrives, in depths
  double travel;  ///< longest tool travel, in depths
};

struct Tool {
  double rake;              ///< alpha, from the crack plane's normal
  double clearance;         ///< between clearance face and crack plane
  double tip_radius = 0;    ///< of a tip rounded on both sides; 0 is sharp
  double separation = 2.0;  ///< of a round tip's normal from straight down, ahead positive: above it, work flows up
  double blunting = 5;      ///< travel, in depths, over which the radius grows to its value
  std::optional<double> lead_in;  ///< angle of a face from the tip up ahead, against a lower face that rises there

  /// x of the lowest point of a tip of this radius, behind the apex that it would have if it were sharp.
  double lowest_point(double radius) const;
};

/// A second iron on the rake face.
struct ChipBreaker {
  double distance;  ///< b, from the tip up along the rake face
  double angle;     ///< of its face from the crack plane's normal, like a rake angle
  double land;      ///< length of its face
};

/// The sole of a plane on the uncut surface, its mouth open towards the tool.
struct Sole {
  double opening;        ///< m, from the tip to the mouth's front edge along the cut
  double corner_radius;  ///< of that edge
};

/// A round bar pressing on the uncut surface.
struct NoseBar {
  double lead;  ///< of its lowest point ahead of the tip
  double radius;
  double compression;  ///< how far its lowest point lies below the uncut surface
};

/// Coulomb friction tau = min(mu p, cap tau_y), with a coefficient for each part of the tool.
struct Friction {
  double coefficient;  ///< of the rake face and the tip
  double yield_cap;
  double chip_breaker = 0, sole = 0, nose_bar = 0;
};

/// The tool's edge takes away the bonds that it passes.
struct Bridging {
  bool cut;
};

/// Coulomb friction between crack faces that close on each other again.
struct FaceFriction {
  double coefficient;
};

/// The clearance side pressed into the freshly cut face, its height tied to that face (a worn edge).
struct EdgeContact {
  double press_in;     ///< delta: how far the edge sits below the face that comes towards it
  double edge_radius;  ///< R_L of the lower edge
  double friction;     ///< Coulomb coefficient there
};

/// A cracked specimen is pulled apart instead of cut: see effects/grips.hpp.
struct Grips {
  bool both_arms;    ///< double cantilever beam; or the upper arm alone, the far end clamped
  double position;   ///< of the grips from the specimen's end
  double width;      ///< of a grip along the arm
  double gauge;      ///< length over which an arm's rotation is read
  double lower_arm;  ///< its height; the upper arm's is the depth of cut
};

/// A log that turns against the tool instead of a flat piece of work: the layer is a veneer.
struct Log {
  Spiral path;
  double core;    ///< radius that the spindle holds, mm
  double length;  ///< of the path that is prepared to part, mm
};

/// FLIP blended towards PIC at a rate in cell transits of the elastic wave: beta = 1 - exp(-rate CFL) each step.
struct PicDamping {
  double rate;
};

/// FLIP blended towards XPIC(m): like PIC damping, but it leaves the m - 1 smoothest orders of the velocity alone.
struct XpicDamping {
  double rate;
  int order;
};

/// Feedback damping of all particles that holds the kinetic energy near a share of the elastic energy.
struct Thermostat {
  double kinetic_share, gain;
};

/// A share beta of the plastic work heats the material, and a share of the friction on the tool; elastic strains cool
/// and warm what expands, and heat flows where there is a conductivity: effects/heat.
struct Thermal {
  double start;           ///< temperature of the work before the cut, K
  double specific_heat;   ///< c, mm^2/(s^2 K)
  double taylor_quinney;  ///< beta
  double conductivity;    ///< k, N/(s K); zero: adiabatic
  double friction_share;  ///< of the work of friction on the tool, that stays in the work as heat; zero: none
  double expansion;       ///< alpha, linear thermal expansion, 1/K; zero: elastic strains leave the temperature alone
  /// Do particles keep a temperature of their own, beside what plastic work and stress tell?
  bool is_kept() const { return conductivity > 0.0 || friction_share > 0.0; }
};

/// Extent of the simulated material around the tool tip, in depths of cut.
struct Window {
  double ahead, behind, below, above;
};

struct Resolution {
  int cells_through_chip, particles_per_cell_side, markers_per_cell;
  double courant_number;
  double cell_stretch = 1;             ///< length of a cell along the cut over its height
  double single_particle_below = 100;  ///< depths of cut under the crack plane; a cell of the base holds one from there
  double contact_stiffness = 1;  ///< of the contact penalties, in multiples of twice the plane-strain modulus per cell
};

struct SteadyState {
  double tolerance;   ///< relative standard error of F_c at which the cut may stop
  double not_before;  ///< tool travel, in depths, before which it never stops
};

struct Scene {
  std::string title;
  laws::Material material;
  Cohesive cohesive;
  Cut cut;
  Tool tool;
  std::optional<Friction> friction;
  std::optional<EdgeContact> edge_contact;
  std::optional<ChipBreaker> chip_breaker;
  std::optional<Sole> sole;
  std::optional<NoseBar> nose_bar;
  std::optional<Bridging> bridging;
  std::optional<FaceFriction> face_friction;
  std::optional<Grips> grips;
  std::optional<Log> log;
  std::optional<PicDamping> pic_damping;
  std::optional<XpicDamping> xpic_damping;
  std::optional<Thermostat> thermostat;
  std::optional<Thermal> thermal;
  Window window;
  Resolution resolution;
  SteadyState steady_state;

  double cell() const { return cut.depth / resolution.cells_through_chip; }  ///< height, mm
  double cell_length() const { return resolution.cell_stretch * cell(); }
  /// Height of the material below the crack plane, in depths.
  double base_height() const { return grips ? grips->lower_arm / cut.depth : window.below; }
  /// Height of the material below the crack plane that has all its particles, in depths: up to a row of nodes.
  double fine_base_height() const {
    if (grips || log) return base_height();
    const double cells = std::floor(resolution.single_particle_below * resolution.cells_through_chip) + 0.5;
    return std::min(cells / resolution.cells_through_chip, base_height());
  }
  double marker_spacing() const { return cell_length() / resolution.markers_per_cell; }
  int particles_along_cell() const {
    return resolution.particles_per_cell_side + (resolution.cell_stretch > 2.0 ? 1 : 0);
  }
  int particles_per_cell() const { return particles_along_cell() * resolution.particles_per_cell_side; }
};

/// The faces of the scene's tool.
std::vector<ToolFace> faces_of(const Scene& scene);

/// Every block a scene may hold, with its parameters; what `kerf list`, `kerf check` and calibrations read.
const std::vector<Block>& scene_blocks();

/// Throws InputError on anything that is not a valid scene.
Scene read_scene(const Document& document);

}  // namespace kerf::forward
