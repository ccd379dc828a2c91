#pragma once

#include <array>

#include "forward/bodies/transfer.hpp"
#include "forward/mpm/shape_function.hpp"
#include "models/base/document.hpp"

namespace kerf::forward::bodies {

/// Where the grid lies, and kernels are taken. In the reference configuration (total Lagrangian) unless bodies move
/// past each other: in the current one quadratic splines are unstable under a tension of a quarter of the modulus,
/// which rubber exceeds.
enum class Frame { reference, current };

/// When the stress follows the deformation: before forces are found, from the velocities that nodes gather (USF); after
/// points have new velocities, from those at the nodes (USL) or from what nodes gather of the points again (MUSL); or
/// half of it each time, as USF and as MUSL (USAVG). Source: Bardenhagen, J. Comput. Phys. 180 (2002) 383; Nairn,
/// CMES 4 (2003) 649.
enum class StressUpdate { first, last, last_gathered, average };
inline constexpr std::array<const char*, 4> stress_update_names{"USF", "USL", "MUSL", "USAVG"};

/// How a scene of bodies is solved. Chosen once, when the stages of a step are planned.
struct Numerics {
  ShapeFunction shape;
  Transfer transfer;
  StressUpdate stress_update = StressUpdate::first;
  Frame frame = Frame::reference;
};

Block numerics_block();

/// `values` may be absent: quadratic splines, FLIP, USF. Throws InputError.
Numerics read_numerics(const Values* values, int particles_per_cell_side, bool has_contact);

/// In plain English.
std::string describe(const Numerics& numerics);

}  // namespace kerf::forward::bodies
