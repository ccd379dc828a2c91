#pragma once

#include "models/chip/closed_form.hpp"
#include "models/chip/rake_face.hpp"

namespace kerf::chip {

// Atkins' energy balance of a steady cut (A. G. Atkins, Int. J. Mech. Sci. 45 (2003) 373), per width and length of cut:
//
//     F_c = tau_y gamma h + T sin phi / cos(phi - alpha) + G_c,      gamma = cot phi + tan(phi - alpha)
//
// With T = G_a + mu N the friction work is taken to the left, F_c Q = ..., Q = 1 - mu S / (cos alpha + mu sin alpha),
// S = sin phi / cos(phi - alpha). The chip picks the angle of least force. With tau_y = sigma_y / 2 the balance is Eq.
// (2) in other words, and its minimum is Eq. (4): here it is searched for numerically, as an independent check.

/// F_c (N/mm) of a chip that shears at `shear_angle`; infinite where friction holds the chip (Q <= 0).
double atkins_cutting_force(double shear_angle, double depth, double rake, double yield_stress, double toughness,
                            double friction, double adhesion);

struct AtkinsMinimum {
  double F_c;
  double shear_angle;
};

/// The least of atkins_cutting_force over the shear angle. Needs chip_can_slide.
AtkinsMinimum atkins_minimum(double depth, double rake, double yield_stress, double toughness, double friction,
                             double adhesion);

ClosedForm atkins_model();

}  // namespace kerf::chip
