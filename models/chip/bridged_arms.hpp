#pragma once

#include <vector>

#include "models/chip/least_squares.hpp"

namespace kerf::chip {

// The R-curve of a double cantilever beam whose crack is bridged behind its tip, by beam theory and the J-integral.
//
// Both arms, of height h and stiffness B = E'h^3/12 per width, deflect by w(x); x runs from the crack tip back.
// Bridging pulls them together over the crack's extension Delta a, the sawn notch a_0 beyond is free, and the pull P
// acts at its end, where there is no moment:
//
//     B w'''' = -T(2w), 0 < x < Delta a      w'''' = 0, Delta a < x < a_0 + Delta a                          (1)
//     w(0) = delta_1/2,  w'(0) = chi h w''(0),  B w''(0)^2 - 2 B w'''(0) w'(0) = sigma_c delta_1/2          (2)
//     w''(a_0 + Delta a) = 0                                                                                (3)
//     G_R(Delta a) = sigma_c delta_1/2 + int_delta_1^delta* T d delta,   delta* = 2 w(Delta a)              (4)
//
// T is the trilinear law (trilinear.hpp) and the crack's front is where it peaks, at delta_1; without a strength the
// initiation happens in a point instead: delta_1 = delta_2 = 0, G_init in the place of sigma_c delta_1/2, and
//
//     T = sigma_b (1 - delta/delta_c),   delta_c = 2 G_b/sigma_b                                             (5)
//
// (2) is the energy that the front takes, with the root rotation of root_rotation.hpp; (4) is the J-integral about the
// zone, which is developed when delta* = delta_c, from where G_R = G_init + G_b. Not modelled: shear of the arms, large
// rotation, a front that moves while it opens. Shear matters where zones are as short as arms are high and shear moduli
// low: of the simulated wooden beam of data/scenes/dcb_rcurve.toml the resistance agrees to a tenth, and a fit finds
// half of G_init and is rejected.

struct Arms {
  double modulus;        ///< E' along the crack, MPa
  double height;         ///< h of one arm, mm
  double notch;          ///< a_0, from the pull to the first crack tip, mm
  double root_rotation;  ///< chi
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
  double pull;      ///< P per width, N/mm
  double rotation;  ///< of an arm where the pull acts; 2 P w' = G_R, which nothing in the solution uses
};

/// Eqs. (1) to (4). `extension` >= 0 in mm.
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
