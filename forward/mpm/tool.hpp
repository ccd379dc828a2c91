#pragma once

#include <string>
#include <vector>

#include "forward/mpm/outline.hpp"
#include "forward/mpm/state.hpp"

namespace kerf::forward {

/// Surfaces of the work that a tool may touch.
enum class Surface { lower_face, upper_face, top };
Face& surface(State& state, Surface which);

/// One rigid convex part of the tool against one surface of the work.
struct Contact {
  std::string name, does;
  Surface surface;
  bool follows_tip;      ///< moves up and down with the tip; the sole does not
  double friction;       ///< Coulomb coefficient mu; 0 has no springs along the face
  std::size_t slip = 0;  ///< which of the surface's slip lists belongs to it
  /// The part in coordinates of the tip (of the point under it in the crack plane, if it does not follow the tip).
  Outline (*outline)(const Scene& scene, double tip_radius);
};

/// The contacts of a scene's tool, in the order in which they act.
std::vector<Contact> contacts(const Scene& scene);

/// Whether something touches the outer surface of the layer, so that its markers have to be followed.
bool needs_top(const std::vector<Contact>& contacts);

/// Advances the tip with the velocity ramp, lets its radius grow, and clears this step's tool force.
void move_tool(State& state, const Scene& scene);

/// The base lifts as the layer is pulled off it, by a few per cent of h. Held at the machine's height, an edge would
/// squeeze that lift back down through a patch of a cell, and the force would measure the mesh. So the tip follows the
/// lower face,
///     d y_tip / d travel = (mean height of the face 0.1 h ... 0.3 h ahead + lift - sink - y_tip) / (0.3 h),
/// and the work of that vertical motion is booked. An edge that presses (`sinks`) is lowered by the mean penetration
/// that its penalty spring needs, so that the face, and not the tool, is pressed in by what the scene says, whatever
/// the stiffness.
void follow_face(State& state, double depth, double lift, bool sinks);

/// The tool is rigid and analytic; it touches markers on the surfaces of the work, never particles or nodes, so its
/// normals are exact and contact begins where the surface is. A penalty acts on the distance phi < 0: normal traction
/// -k phi; along the face a spring of the same stiffness follows the sliding up to the slip limit
/// tau = min(mu p, cap), the dissipation booked. The cap looks at the pressure of a cell, not of a marker: what a
/// single marker carries is not unique (several share the same nodes).
struct PressOptions {
  double stiffness;  ///< k, MPa/mm
  double shear_cap;  ///< MPa
};
void press(State& state, const Contact& contact, const Scene& scene, const PressOptions& options);

/// The same, where a share of the friction's work stays in the work: it is booked, and given as heat to the nodes that
/// the markers follow.
void press_and_warm(State& state, const Contact& contact, const Scene& scene, const PressOptions& options);

}  // namespace kerf::forward
