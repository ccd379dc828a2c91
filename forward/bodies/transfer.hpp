#pragma once

#include <variant>

namespace kerf::forward::bodies {

/// What points take from the nodes at the end of a step, and give to them at the start of the next. With S the
/// interpolation from the nodes, v the nodal velocities at the end of the step and dv their change in it:
///     FLIP     v_p += S dv
///     PIC      v_p = S v
///     APIC     v_p = S v, and a gradient C_p = D^-1 sum w_i v_i (x_i - x_p)^T, D = sum w_i (x_i - x_p)(x_i - x_p)^T,
///     which
///              gives node i the velocity v_p + C_p (x_i - x_p)  (Jiang et al. 2015)
///     XPIC(m)  v_p = S v(m) of filtered velocities: effects/xpic.hpp
/// All points move with S v. What a transfer takes beside what FLIP would have left is booked as damping.
///
/// A transfer is a struct like these, one line in `Transfer`, and its lines in bodies/advance.cpp.
struct Flip {
  static constexpr const char* name = "FLIP";
  static constexpr bool is_affine = false, filters = false;
};
struct Pic {
  static constexpr const char* name = "PIC";
  static constexpr bool is_affine = false, filters = false;
};
struct Apic {
  static constexpr const char* name = "APIC";
  static constexpr bool is_affine = true, filters = false;
};
struct Xpic {
  static constexpr const char* name = "XPIC";
  static constexpr bool is_affine = false, filters = true;
  int order = 2;
};

using Transfer = std::variant<Flip, Pic, Apic, Xpic>;

}  // namespace kerf::forward::bodies
