#pragma once

#include <array>
#include <vector>

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// What joins the velocity fields of bodies where they share nodes.
///
/// Without an [interface] all bodies move with one velocity there. With one, two bodies are joined by springs along
/// their common edge, t_n = D_n [u_n], t_t = D_t [u_t]. A node's share A of the edge's length comes from points along
/// it (sum A is the length), its jump [u] is the time integral of the difference w of the two velocities, and a step is
/// implicit in the spring: with the reduced mass m = m_a m_b/(m_a + m_b), k = D A and the difference w* without it,
///     w = (w* - (k dt/m) [u]) / (1 + k dt^2/m),    [u] += dt w.
/// This is stable for every D and becomes the perfect bond as D grows. What it loses, k (dt w)^2/2, is booked as
/// damping.
class Joint {
 public:
  Joint(const State& state, const Scene& scene);
  /// One velocity for all bodies; of what springs join, a difference w as an implicit spring leaves of it,
  /// w / (1 + k dt^2/m).
  void share_velocity(State& state) const;
  /// After the changes by forces are known.
  void join(State& state);
  /// Stored in the springs, N mm/mm.
  double energy() const;

 private:
  struct Node {
    std::size_t node;
    double area;                       ///< mm per unit width
    std::array<double, 2> jump{0, 0};  ///< along x, along y
  };
  void slow_parting(State& state) const;
  double stiffness(std::size_t component, double jump) const;

  std::optional<Interface> springs_;
  std::size_t normal_ = 0;  ///< component across the edge
  std::vector<Node> nodes_;
  double smallest_mass_ = 0;
};

}  // namespace kerf::forward::bodies
