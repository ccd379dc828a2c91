#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "forward/bodies/numerics.hpp"
#include "forward/bodies/shape.hpp"
#include "forward/scene/scene.hpp"
#include "models/base/document.hpp"
#include "models/laws/body_law.hpp"

namespace kerf::forward::bodies {

/// An experiment on bodies in a box instead of a cut: plain data in consistent units (mm, MPa, N, tonne, s, K). The
/// box's right wall is a piston; strokes say how it moves and what happens to the heat.

struct BodyPlan {
  laws::BodyLaw law;
  Shape shape;
  double velocity_x = 0, velocity_y = 0;  ///< at the start, mm/s
  double wavelength = 0;                  ///< along x of a start velocity that is a sine; 0: the same everywhere, mm
  double spin = 0;                        ///< about the middle at the start, anticlockwise, rad/s
  double temperature = 0;                 ///< at the start, K; only of thermal laws
  std::string where;                      ///< of the block in its file
};

/// A body that nothing deforms or deflects. It takes its velocity in a time constant, and loses it so after `stop`.
struct RigidPlan {
  Shape shape;
  double velocity_x, velocity_y;  ///< mm/s
  double ramp, stop;              ///< s
  std::string where;
};

enum class Wall { open, roller };
enum Edge : std::size_t { left, right, bottom, top };
inline constexpr std::array<const char*, 4> edge_names{"left", "right", "bottom", "top"};

/// How heat comes and goes while the piston moves.
enum class Heat { none, adiabatic, isothermal };

/// A motion of the piston, until the first of its conditions holds.
struct Stroke {
  Heat heat = Heat::none;
  double temperature = 0;    ///< of the bath of an isothermal stroke, K
  double exchange_time = 0;  ///< in which the bath and a body come to 1/e of their difference; 0: at once
  double speed = 0;          ///< of the piston, outwards positive, mm/s
  double ramp = 0;           ///< time constant in which the piston takes that speed, s
  double longest = std::numeric_limits<double>::infinity();  ///< time, s
  std::optional<double> until_stretch;                       ///< length of the box over its first length
  std::optional<double> until_temperature;                   ///< mean over the bodies, K
  bool until_entropy_returns = false;                        ///< of the bodies, to what it was at the very start
};

/// Two bodies that meet along a straight line, joined by springs: t_n = D_n [u_n], t_t = D_t [u_t].
struct Interface {
  double normal, compressive, tangential;  ///< MPa/mm; compressive: D_n where the faces overlap
};

/// Heat flows within and between bodies, and through walls that have a temperature.
struct Conduction {
  double conductivity;                                    ///< k, N/(s K)
  std::array<std::optional<double>, 4> wall_temperature;  ///< K, by Edge
};

/// How bodies touch: see bodies/contact.
enum class Normal { largest_gradient, mean_gradient, specified };
enum class Overlap { off, position, displacement };
struct Contact {
  double friction = 0;  ///< Coulomb's coefficient
  Normal normal = Normal::largest_gradient;
  double normal_x = 0, normal_y = 0;  ///< unit vector, of a specified normal
  double screening = 0;               ///< least volume of two bodies at a node, over the cell's; 0: not asked
  bool approach = true;               ///< only bodies that come closer
  Overlap overlap = Overlap::position;
};

/// What to read off the run: see bodies/measures.
enum class Measure { cycle, rubber, expansion, modulus, sliding, hertz, rubbing, wedge, vibration };
inline constexpr std::array<const char*, 9> measure_names{"cycle", "rubber",  "expansion", "modulus",  "sliding",
                                                          "hertz", "rubbing", "wedge",     "vibration"};

struct Scene {
  std::string title;
  double length, height, cell;  ///< of the box, mm
  int particles_per_cell_side;
  double courant_number;
  Numerics numerics;
  std::array<Wall, 4> walls;
  std::vector<BodyPlan> bodies;
  std::vector<Stroke> strokes;
  std::optional<Interface> interface;
  std::optional<Conduction> conduction;
  std::optional<PicDamping> pic_damping;
  std::vector<RigidPlan> rigids;
  std::optional<Place> gravity;  ///< mm/s^2
  std::optional<Contact> contact;
  std::vector<Measure> measures;
  bool is_thermal() const;
};

/// True when a document is a scene of bodies, not of a cut.
bool has_bodies(const Document& document);

const std::vector<Block>& scene_blocks();

/// Throws InputError on anything that is not a valid scene of bodies.
Scene read_scene(const Document& document);

}  // namespace kerf::forward::bodies
