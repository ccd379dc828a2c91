#pragma once

#include <optional>
#include <string>
#include <vector>

#include "models/chip/closed_form.hpp"
#include "models/laws/traction_law.hpp"

namespace kerf::chip {

// The chip as an elastic-plastic beam on its cohesive foundation, in steady state and at finite rotation.
//
// The layer of height h is an inextensible beam (beam_section.hpp), s its arc from far ahead of the crack towards the
// tool, theta its rotation, kappa = dtheta/ds, (u, w) the displacement of its axis, R the force that a section hands on
// to the part ahead of it, q the traction of the crack plane on the lower face per length, along (x, y) of the plane:
//
//     dR/ds = -q      du/ds = 1 - cos theta      dw/ds = sin theta                                          (1)
//     dM/ds = -(R_y cos theta + R_x sin theta) + (h/2)(q_x cos theta - q_y sin theta)                       (2)
//
// The lower face opens by w + (h/2)(1 - cos theta) and slides by u - (h/2) sin theta. Each splits into the cohesive
// opening and the stretch T/k of the material beside the plane, one spring per mode. Material moves along s, so a
// section follows the loading curve M(kappa) up to its largest curvature and from there unloads elastically. Both
// tractions end where the mixed-mode criterion, theory Eq. (8), is met. From there on the chip is free, up to the
// contact: there M = 0, theta = pi/2 - alpha (tangent to the rake face), and R is the tool's force, N along the normal
// of the face and mu N against the sliding. Where the plane still pulls at the contact (bridging that the tool
// ignores), the chip lies straight on the face from there to the crack tip, and R at the crack tip is the tool's force.
// Far ahead everything but R_x dies out; the rigid rest takes R_x.
//
// Along (1) and (2) a first integral holds, the J-integral of the beam; from far ahead to the contact it says
//
//     F_c - mu N = G + W_p                                                                                  (3)
//
// G the work of the tractions up to failure, W_p the plastic work of beam_section.hpp: nothing in the solution uses it,
// so it checks the solution.
//
// The normal spring k = E'/(3 chi^4 h) gives the elastic beam on its foundation (Kanninen 1973) the root rotation
// chi h kappa that Eq. (7) states for a double cantilever beam; chi enters nowhere else. The shear spring
// k_t = 8 G_xy/(3h) lets the lower face slide against the axis when the shear falls linearly from the plane to the top;
// halving it changes F_c of wood by 1 %. Not modelled: shear strain of the chip, axial yield, crushing below the layer,
// reverse yield, inertia. What moves the answer most where measurements are scarce: the rise of the mode II law,
// because the turning root slides its lower face back by (h/2) sin theta. On wood (RL, 0.1 to 0.5 mm) a peak at 0.15 or
// 0.2 instead of 0.1 of delta_c lowers F_c by 0 to 26 % and shifts the mode I share from 0.7 to 0.8.

struct CohesiveBeam {
  double depth;             ///< h, mm
  double rake;              ///< alpha, rad
  double friction;          ///< mu on the rake face
  double modulus;           ///< E' along the cut, MPa
  double yield_stress;      ///< sigma_y' along the cut, MPa, already reduced for plane strain
  double hardening;         ///< a = E_t/E
  double normal_stiffness;  ///< k, MPa/mm
  double shear_stiffness;   ///< k_t, MPa/mm
  const laws::TractionLaw* mode_I;
  const laws::TractionLaw* mode_II = nullptr;  ///< none: the plane carries no shear
  double exponent_n = 1.0, exponent_m = 1.0;   ///< of the mixed-mode criterion
  bool tool_cuts_bridging = false;             ///< what the tool's tip has passed carries nothing

  double bending_stiffness() const { return modulus * depth * depth * depth / 12.0; }
  double yield_curvature() const { return 2.0 * yield_stress / (modulus * depth); }
};

/// k above: MPa/mm from E' (MPa), chi and h (mm).
double foundation_stiffness(double modulus, double root_rotation, double depth);
/// k_t above: MPa/mm from G_xy (MPa) and h (mm).
double shear_foundation_stiffness(double shear_modulus, double depth);

/// The beam at one section.
struct ChipSection {
  double arc;               ///< s, mm, from where the integration began
  double rotation;          ///< theta, rad
  double curvature;         ///< kappa, 1/mm
  double moment;            ///< M per width, N
  double force_x, force_y;  ///< R, N/mm
  double slide_axis;        ///< u, mm
  double lift_axis;         ///< w, mm
  double largest_sliding;   ///< of the lower face so far, mm
};

struct CohesiveBeamSolution {
  double normal_force;     ///< N, N/mm
  double F_c, F_t;         ///< on the rake face, N/mm
  double root_curvature;   ///< largest curvature, 1/mm
  double work_I, work_II;  ///< work of the tractions up to failure per area, N/mm
  double area_I, area_II;  ///< areas under the laws at failure, N/mm: the mode shares
  double plastic_work;     ///< W_p, N/mm
  double imbalance;        ///< relative residue of (3)
  double tip_gap;          ///< lead of the crack tip (nothing carried behind it) over the tool's tip, mm
  double front_gap;        ///< lead of the crack front (largest traction) over the tool's tip, mm
  double process_zone;     ///< from crack front to crack tip along the plane, mm
  double contact_length;   ///< arc of the axis from crack front to contact, mm
  double curl_radius;      ///< of the chip after unloading, mm; infinite when nothing yielded
  bool touching;  ///< the tool's tip reaches the crack front, or the contact is nearer to it than the depth of cut
  std::vector<ChipSection> sections;  ///< from far ahead to the contact
  ChipSection crack_tip;
};

/// Empty with the `reason` in words where no steady bending chip exists.
struct CohesiveBeamOutcome {
  std::optional<CohesiveBeamSolution> solution;
  std::string reason;
  bool touching = false;  ///< no bent chip exists because the tool gets to the crack tip
};

CohesiveBeamOutcome solve(const CohesiveBeam& beam);

ClosedForm cohesive_beam_model();

}  // namespace kerf::chip
