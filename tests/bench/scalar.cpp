#include "tests/bench/scalar.hpp"

namespace kerf::bench {

template <class Real>
ScalarKernel<Real>::ScalarKernel(const forward::State& state, const laws::J2<laws::LinearHardening>& law, double pic)
    : first_above_(state.particles.begin[1]),
      columns_(state.grid.columns),
      rows_(state.grid.rows),
      origin_x_(state.grid.origin_x),
      origin_y_(state.grid.origin_y),
      inverse_cell_x_(state.grid.inverse_cell_x),
      inverse_cell_y_(state.grid.inverse_cell_y),
      density_(state.density),
      smallest_mass_(state.smallest_mass),
      dt_(state.step),
      pic_(pic),
      shear_(law.shear_modulus()),
      lame_(law.lame()),
      hardening_(law.hardening.modulus),
      yield_stress_(law.hardening.yield_stress),
      damping_(0.0) {
  const forward::Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    particles_.push_back({p.x[i], p.y[i], p.velocity_x[i], p.velocity_y[i], p.stress_xx[i], p.stress_yy[i],
                          p.stress_zz[i], p.stress_xy[i], p.plastic_strain[i], p.volume[i]});
  for (std::size_t side = 0; side < 2; ++side) {
    const forward::VelocityField& field = state.grid.side[side];
    side_[side].resize(state.grid.nodes());
    for (std::size_t n = 0; n < state.grid.nodes(); ++n) {
      side_[side][n].mass = field.mass[n];
      side_[side][n].momentum_x = field.momentum[2 * n];
      side_[side][n].momentum_y = field.momentum[2 * n + 1];
    }
  }
}

template <class Real>
void ScalarKernel<Real>::step() {
  project();
  update_stress();
  accelerate();
  advance();
}

/// First node and the weights of the quadratic B-spline along each axis.
template <class Real>
typename ScalarKernel<Real>::Kernel ScalarKernel<Real>::kernel(const Particle& p) const {
  Kernel k;
  const auto weights = [](Real at, int& base, Real* w) {
    base = static_cast<int>(at - 0.5);
    const Real g = at - static_cast<double>(base + 1);
    w[0] = 0.5 * (0.5 - g) * (0.5 - g);
    w[1] = 0.75 - g * g;
    w[2] = 0.5 * (0.5 + g) * (0.5 + g);
  };
  weights((p.x - origin_x_) * inverse_cell_x_, k.i, k.wx);
  weights((p.y - origin_y_) * inverse_cell_y_, k.j, k.wy);
  return k;
}

template <class Real>
void ScalarKernel<Real>::project() {
  for (std::vector<Node>& nodes : side_)
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        Node& n = nodes[static_cast<std::size_t>(j * columns_ + i)];
        n.force_x = n.force_y = n.velocity_x = n.velocity_y = 0.0;
        if (!(n.mass > smallest_mass_)) continue;
        if (!held_x(i, j)) n.velocity_x = n.momentum_x / n.mass;
        if (!held_y(j)) n.velocity_y = n.momentum_y / n.mass;
      }
}

template <class Real>
void ScalarKernel<Real>::update_stress() {
  using std::sqrt;
  for (std::size_t index = 0; index < particles_.size(); ++index) {
    Particle& p = particles_[index];
    std::vector<Node>& nodes = side_of(index);
    const Kernel k = kernel(p);
    const auto slopes = [](const Real* w, Real inverse_cell, Real* slope) {
      const Real g = w[2] - w[0];  // the distance from the middle node
      slope[0] = (g - 0.5) * inverse_cell;
      slope[1] = -2.0 * g * inverse_cell;
      slope[2] = (g + 0.5) * inverse_cell;
    };
    Real sx[3], sy[3];
    slopes(k.wx, inverse_cell_x_, sx);
    slopes(k.wy, inverse_cell_y_, sy);

    Real l_xx = 0.0, l_xy = 0.0, l_yx = 0.0, l_yy = 0.0;
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        const Node& n = nodes[static_cast<std::size_t>((k.j + b) * columns_ + k.i + a)];
        const Real along_x = sx[a] * k.wy[b], along_y = k.wx[a] * sy[b];
        l_xx += along_x * n.velocity_x;
        l_yx += along_x * n.velocity_y;
        l_xy += along_y * n.velocity_x;
        l_yy += along_y * n.velocity_y;
      }
    l_xx = dt_ * l_xx;
    l_xy = dt_ * l_xy;
    l_yx = dt_ * l_yx;
    l_yy = dt_ * l_yy;

    // Turn the stress with the material, then add the elastic part of the strain.
    const Real half_spin = 0.25 * (l_yx - l_xy), square = half_spin * half_spin;
    const Real c = (1.0 - square) / (1.0 + square), s = 2.0 * half_spin / (1.0 + square);
    const Real cc = c * c, ss = s * s, cs = c * s;
    const Real volumetric = lame_ * (l_xx + l_yy);
    const Real xx = cc * p.xx + ss * p.yy - 2.0 * cs * p.xy + volumetric + 2.0 * shear_ * l_xx;
    const Real yy = ss * p.xx + cc * p.yy + 2.0 * cs * p.xy + volumetric + 2.0 * shear_ * l_yy;
    const Real xy = cs * (p.xx - p.yy) + (cc - ss) * p.xy + shear_ * (l_xy + l_yx);
    const Real zz = p.zz + volumetric;

    // Radial return.
    const Real mean = (xx + yy + zz) / 3.0;
    const Real dxx = xx - mean, dyy = yy - mean, dzz = zz - mean;
    const Real q = sqrt(1.5 * (dxx * dxx + dyy * dyy + dzz * dzz + 2.0 * xy * xy));
    const Real excess = q - (yield_stress_ + hardening_ * p.plastic_strain);
    Real keep = 1.0;
    if (excess > 0.0) {
      const Real strain = excess / (3.0 * shear_ + hardening_);
      keep = 1.0 - 3.0 * shear_ * strain / q;
      p.plastic_strain += strain;
    }
    p.xx = mean + keep * dxx;
    p.yy = mean + keep * dyy;
    p.zz = mean + keep * dzz;
    p.xy = keep * xy;

    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        Node& n = nodes[static_cast<std::size_t>((k.j + b) * columns_ + k.i + a)];
        const Real along_x = -1.0 * p.volume * sx[a] * k.wy[b], along_y = -1.0 * p.volume * k.wx[a] * sy[b];
        n.force_x += along_x * p.xx + along_y * p.xy;
        n.force_y += along_x * p.xy + along_y * p.yy;
      }
  }
}

template <class Real>
void ScalarKernel<Real>::accelerate() {
  for (std::vector<Node>& nodes : side_)
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < columns_; ++i) {
        Node& n = nodes[static_cast<std::size_t>(j * columns_ + i)];
        n.change_x = n.change_y = n.next_x = n.next_y = 0.0;
        if (n.mass > smallest_mass_) {
          n.change_x = held_x(i, j) ? -1.0 * n.momentum_x / n.mass : dt_ * n.force_x / n.mass;
          n.change_y = held_y(j) ? -1.0 * n.momentum_y / n.mass : dt_ * n.force_y / n.mass;
          if (!held_x(i, j)) n.next_x = n.velocity_x + n.change_x;
          if (!held_y(j)) n.next_y = n.velocity_y + n.change_y;
        }
        n.mass = n.momentum_x = n.momentum_y = 0.0;
      }
}

template <class Real>
void ScalarKernel<Real>::advance() {
  for (std::size_t index = 0; index < particles_.size(); ++index) {
    Particle& p = particles_[index];
    std::vector<Node>& nodes = side_of(index);
    const Kernel old = kernel(p);
    Real move_x = 0.0, move_y = 0.0, change_x = 0.0, change_y = 0.0;
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        const Node& n = nodes[static_cast<std::size_t>((old.j + b) * columns_ + old.i + a)];
        const Real w = old.wx[a] * old.wy[b];
        move_x += w * n.next_x;
        move_y += w * n.next_y;
        change_x += w * n.change_x;
        change_y += w * n.change_y;
      }
    const Real mass = p.volume * density_;
    const Real flip_x = p.velocity_x + change_x, flip_y = p.velocity_y + change_y;
    p.velocity_x = flip_x + pic_ * (move_x - flip_x);
    p.velocity_y = flip_y + pic_ * (move_y - flip_y);
    damping_ +=
        0.5 * mass * (flip_x * flip_x + flip_y * flip_y - p.velocity_x * p.velocity_x - p.velocity_y * p.velocity_y);
    p.x += dt_ * move_x;
    p.y += dt_ * move_y;
    const Kernel now = kernel(p);
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        Node& n = nodes[static_cast<std::size_t>((now.j + b) * columns_ + now.i + a)];
        const Real share = now.wx[a] * now.wy[b] * mass;
        n.mass += share;
        n.momentum_x += share * p.velocity_x;
        n.momentum_y += share * p.velocity_y;
      }
  }
}

template class ScalarKernel<double>;
template class ScalarKernel<Counted>;

}  // namespace kerf::bench
