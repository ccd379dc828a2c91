#pragma once

#include <vector>

#include "models/chip/least_squares.hpp"

namespace kerf::chip {

// The R-curve of a double cantilever beam whose crack is bridged behind its tip: Timoshenko arms on an elastic
// foundation.
//
// Both arms, of height h, bending stiffness B = E_x h^3/12 and shear stiffness S = 5/6 G h per width, deflect by w(x)
// and turn their sections by psi(x); x runs from the crack's front back, M is the moment and V the shear force. The
// traction T between the arms also stretches each of them across by s T, s = h/(5 E_y), so that w = delta/2 + s
// T(delta). Ahead of the front the plane is an elastic foundation of stiffness k, behind it T follows the falling law
// over the crack's extension Delta a, the sawn notch a_0 beyond is free, and the pull P acts at its end, where there is
// no moment:
//
//     w' = psi + V/S    psi' = M/B    M' = -V    V' = k w, T, 0 for x < 0, x < Delta a, beyond              (1)
//     1/k = s + delta_1/(2 sigma_c),  w(0) = delta_1/2 + s sigma_c                                          (2)
//     M(0) = sqrt(B k) w(0) - L V(0),  w'(0) = L sqrt(k/B) w(0) - V(0)/sqrt(B k),  L^2 = B/S + 2 sqrt(B/k)  (3)
//     M(Delta a + a_0) = 0                                                                                  (4)
//     G_R(Delta a) = int_0^delta* T d delta,   delta* = delta(Delta a)                                      (5)
//
// (3) are the solutions of (1) that die out ahead. T is the trilinear law (trilinear.hpp); the front is where it peaks,
// at delta_1. Without a strength, or where the law falls more steeply than the arms give, the initiation happens in a
// point: k = 1/s, w(0) = sqrt(G_init/k), from where delta = 2 (w - w(0)) and
//
//     T = sigma_b (1 - delta/delta_c),   delta_c = 2 G_b/sigma_b                                            (6)
//
// (5) is the J-integral about the zone, which is developed when delta* = delta_c, from where G_R = G_init + G_b. Along
// (1) a first integral holds: 2 P (psi + V/2S) where the pull acts is G_R + s T(delta*)^2, the stretch of the arms at
// the notch's end being an artefact of a foundation that ends there.
//
// An unbridged crack has G = P^2 (a + L)^2/B, L the crack length correction of Williams (1989). The moduli are those of
// plane strain: E_x = 1/b_11, E_y = 1/b_22, G = 1/(b_66 + 2 b_12) of the reduced compliances, for under tractions alone
// stresses depend on the sum only. With s = h/(5 E_y)
//
//     (L/h)^2 = sqrt(E_x/E_y) (rho/5 + 1/sqrt(15)),   rho = sqrt(E_x E_y)/(2 G)                             (7)
//
// which is within 1.5 % of the elasticity solution of Bao, Ho, Suo & Fan (Int. J. Solids Struct. 29:1105, 1992),
// L/h = (E_x/E_y)^(1/4) [0.677 + 0.149 (rho - 1) - 0.013 (rho - 1)^2], for rho up to 3.5; (1) alone would make s 13/35
// h/E_y, if stresses across the arms varied slowly along them. Not modelled: large rotation, a front that moves while
// it opens, arms that differ. Of the simulated wooden beam of data/scenes/dcb_rcurve.toml G_R agrees to 1 % from 2 mm
// on and P from 4 mm on; before that P is up to 16 % too large, for there the zone is shorter than an arm is high.

struct Arms {
  double modulus;             ///< E_x along the crack, MPa
  double transverse_modulus;  ///< E_y, MPa
  double shear_modulus;       ///< G, MPa
  double height;              ///< h of one arm, mm
  double notch;               ///< a_0, from the pull to the first crack tip, mm

  double bending_stiffness() const { return modulus * height * height * height / 12; }
  double shear_stiffness() const { return 5 * shear_modulus * height / 6; }
  double transverse_compliance() const { return height / (5 * transverse_modulus); }  ///< s, mm/MPa
};

struct BridgedCrack {
  double initiation_toughness = 0;  ///< G_init, N/mm
  double bridging_toughness = 0;    ///< G_b, N/mm
  double bridging_stress = 0;       ///< sigma_b, MPa
  double strength = 0;              ///< sigma_c, MPa, above sigma_b; 0: the initiation happens in a point
  double peak = 0;                  ///< delta_1/delta_2
};

/// G_R and what belongs to it.
struct Resistance {
  double G_R;       ///< N/mm
  double opening;   ///< delta*, mm
  double traction;  ///< T(delta*), MPa
  double pull;      ///< P per width, N/mm
  double rotation;  ///< psi + V/2S of an arm where the pull acts: checks the solution, nothing in it uses it
};

/// Eqs. (1) to (5). `extension` >= 0 in mm.
Resistance resistance(const Arms& arms, const BridgedCrack& crack, double extension);

/// One point of a measured R-curve.
struct ResistancePoint {
  double extension;             ///< mm
  double G_R;                   ///< N/mm
  double standard_error = 0.0;  ///< N/mm; 0: unknown
};

/// G_init, G_b, sigma_b by weighted least squares; `known` gives strength and peak, which stay. With errors unknown for
/// some point all count as unknown and equal.
Fit fit_r_curve(const Arms& arms, const std::vector<ResistancePoint>& points, const BridgedCrack& known = {});

}  // namespace kerf::chip
