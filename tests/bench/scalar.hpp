#pragma once

#include <cmath>
#include <vector>

#include "forward/mpm/state.hpp"

namespace kerf::bench {

/// The same step as `kernel_step` for a perfectly plastic or linearly hardening J2 solid, written as one would write it
/// first: an array of particles, an array of nodes, loops over three by three nodes, one number at a time. The
/// reference that the solver's kernel is compared with, for its result and for its speed. `Real` is double, or
/// `Counted` to count the operations.
template <class Real>
class ScalarKernel {
 public:
  /// Starts from a state whose momentum has been gathered.
  ScalarKernel(const forward::State& state, const laws::J2<laws::LinearHardening>& law, double pic);

  void step();

  struct Particle {
    Real x, y, velocity_x, velocity_y, xx, yy, zz, xy, plastic_strain, volume;
  };
  /// In the order of the state's particles.
  const std::vector<Particle>& particles() const { return particles_; }
  Real damping() const { return damping_; }

 private:
  struct Node {
    Real mass, momentum_x, momentum_y, velocity_x, velocity_y, next_x, next_y, change_x, change_y, force_x, force_y;
  };
  struct Kernel {
    int i, j;
    Real wx[3], wy[3];
  };
  Kernel kernel(const Particle& p) const;
  std::vector<Node>& side_of(std::size_t particle) { return side_[particle < first_above_ ? 0 : 1]; }
  bool held_x(int i, int j) const { return j < 2 || i >= columns_ - 4; }
  bool held_y(int j) const { return j < 2; }
  void project();
  void update_stress();
  void accelerate();
  void advance();

  std::vector<Particle> particles_;
  std::vector<Node> side_[2];
  std::size_t first_above_;
  int columns_, rows_;
  Real origin_x_, origin_y_, inverse_cell_x_, inverse_cell_y_, density_, smallest_mass_, dt_, pic_;
  Real shear_, lame_, hardening_, yield_stress_, damping_;
};

/// A double that counts what is done with it: one operation for each + - * / and square root; comparisons, copies and
/// conversions are free. (A fused multiply-add does two.)
struct Counted {
  double value = 0;
  static inline long operations = 0;

  Counted() = default;
  Counted(double v) : value(v) {}
  explicit operator int() const { return static_cast<int>(value); }
  explicit operator double() const { return value; }
  friend Counted operator+(Counted a, Counted b) { return counted(a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return counted(a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return counted(a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return counted(a.value / b.value); }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
  friend Counted sqrt(Counted a) { return counted(std::sqrt(a.value)); }

 private:
  static Counted counted(double v) {
    ++operations;
    return v;
  }
};

}  // namespace kerf::bench
