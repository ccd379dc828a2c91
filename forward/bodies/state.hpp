#pragma once

#include <string>
#include <vector>

#include "forward/bodies/scene.hpp"
#include "forward/mpm/state.hpp"

namespace kerf::forward::bodies {

inline Frame frame_of(const Scene& scene) {
  return scene.numerics.frame;
}

/// Material points of one body, structure of arrays, padded to whole batches with points of no volume. Units as in a
/// cut: mm, mm/s, MPa; volume is the reference volume per unit width, mm^2.
struct Points {
  Array reference_x, reference_y, x, y, velocity_x, velocity_y, volume;
  Array F_xx, F_xy, F_yx, F_yy;                      ///< deformation gradient dx/dX
  Array stress_xx, stress_yy, stress_zz, stress_xy;  ///< Kirchhoff stress
  std::vector<Array> memory;                         ///< what the law keeps, see laws::Memory
  Array temperature;                                 ///< K; only of thermal laws
  /// Of APIC alone: velocity gradient in the grid's configuration, 1/s, and the D of bodies/transfer.hpp, mm^2.
  struct Affine {
    Array xx, xy, yx, yy, spread_x, spread_y;
    static constexpr std::size_t numbers = 6;
  } affine;
  std::size_t size() const { return x.size(); }
  /// Where kernels are taken.
  const Array& kernel_x(Frame frame) const { return frame == Frame::current ? x : reference_x; }
  const Array& kernel_y(Frame frame) const { return frame == Frame::current ? y : reference_y; }
  static constexpr std::size_t mechanical_numbers = 15;  ///< kept for every point, before memory and temperature
};

struct Body {
  laws::BodyLaw law;
  Points points;
  VelocityField field;
  bool is_thermal() const { return !points.temperature.empty(); }
};

/// What the walls have done so far, and do now. Per unit width: N/mm, N mm/mm.
struct Piston {
  double position, speed = 0;
  double force = 0;  ///< of the piston on the bodies, +x, in this step
  double work = 0;   ///< on the bodies
};

/// Heat that came in from outside, N mm/mm, and over its temperature, N mm/(mm K).
struct HeatBook {
  double heat = 0, entropy = 0;
};

/// A body as the nodes see its place: volume, its gradient, and volume times the mean of what [contact] overlap looks
/// at, seen from the node: positions or displacements. Vectors are interleaved (x, y).
struct Presence {
  Array volume, gradient, moment;
};

struct RigidBody {
  Array x, y, volume;  ///< as of Points
  double velocity_x = 0, velocity_y = 0;
  double moved_x = 0, moved_y = 0;  ///< since the start, mm
  double force_x = 0, force_y = 0;  ///< on the bodies that it touches in this step, N/mm
};

/// Two bodies that touch at a node; those from `bodies.size()` on are rigid. The normal points from a to b.
struct Touch {
  std::size_t node, a, b;
  double normal_x, normal_y;
};

/// Everything about bodies in contact; empty without. Energies since the start, N mm/mm.
struct ContactState {
  std::vector<RigidBody> rigids;
  std::vector<Presence> presence;  ///< of bodies, then of rigid ones
  std::vector<Touch> touches;      ///< in this step
  std::vector<Array> velocity;     ///< of every body's nodes, as gathered
  double rigid_work = 0;           ///< of the rigid bodies on the others
  double friction_heat = 0;
  std::vector<Array> heat;  ///< of friction in this step, at every body's nodes; empty unless it warms
  double warmed = 0;        ///< part of the heat of friction that has warmed bodies
  double impact = 0;        ///< lost where approaching surfaces take one velocity
  struct Pressed {
    Array impulse;     ///< normal, at every node, N s/mm; between deforming bodies where there are several
    double since = 0;  ///< s
  } pressed;
};

struct State {
  Grid grid;  ///< its own velocity fields are not used
  Frame frame = Frame::reference;
  std::vector<Body> bodies;
  Piston piston;
  HeatBook bath;
  double damping = 0;  ///< work lost to PIC, N mm/mm
  double time = 0, step = 0;
  double interface_energy = 0;
  ContactState contact;
  std::string breakdown;  ///< why the run cannot go on; empty while it can
};

/// Lays the bodies into the box, at rest.
State lay_out(const Scene& scene);

/// The stable step for what the bodies are now.
double stable_step(const State& state, const Scene& scene);

}  // namespace kerf::forward::bodies
