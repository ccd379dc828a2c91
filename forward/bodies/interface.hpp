#pragma once

#include <array>
#include <vector>

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

/// What joins the velocity fields of bodies where they share nodes.
///
/// Without an [interface] all bodies move with one velocity there. With one, two bodies are joined by springs along
/// their common edge, t_n = D_n [u_n], t_t = D_t [u_t]. Pieces of the edge give their length and normal to the nodes
/// that both bodies reach, so that the lengths A of the nodes add up to the edge's; a node's normal is the mean. What
/// would part the bodies at a node is given more inertia than the reduced mass m = m_a m_b/(m_a + m_b) has: with
/// k = D A and s = 1/(1 + k dt^2/m) the difference w of the velocities, before strains see it, and then that of their
/// changes c become
///     w <- s w,    [u] += dt w,    c <- s (c - (k dt/m) [u]).
/// Velocities and forces see the same s, so that the springs make and lose no energy; k s^2 dt^2/m is 1/4 at most, so
/// that every D is stable; and where D grows the bond becomes perfect. At rest s does not matter.
class Joint {
 public:
  Joint(const State& state, const Scene& scene);
  /// One velocity for all bodies, or slower parting of those that springs join.
  void share_velocity(State& state);
  /// After the changes by forces are known.
  void join(State& state);
  /// Stored in the springs, N mm/mm.
  double energy() const;

 private:
  struct Node {
    std::size_t node;
    double area;                       ///< mm per unit width
    double normal_x, normal_y;         ///< from the first body to the second
    std::array<double, 2> jump{0, 0};  ///< along the normal, along the edge
    std::array<double, 2> keep{1, 1};  ///< s
    std::array<double, 2> along(std::size_t component) const {
      return component == 0 ? std::array{normal_x, normal_y} : std::array{-normal_y, normal_x};
    }
  };
  void find_nodes(const State& state);
  template <class Visit>
  void each_difference(State& state, Array VelocityField::*values, Visit&& visit);
  void slow_parting(State& state);
  double stiffness(std::size_t component, double jump) const;

  const Scene& scene_;  ///< must outlive this
  std::optional<Interface> springs_;
  std::vector<Node> nodes_;
  double smallest_mass_ = 0;
};

}  // namespace kerf::forward::bodies
