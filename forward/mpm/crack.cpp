#include "forward/mpm/crack.hpp"

#include <algorithm>
#include <cmath>

#include "forward/mpm/bspline.hpp"

namespace kerf::forward {
namespace {

/// Traction after the largest opening so far: the law itself while it grows, the straight way to the origin below.
double traction(const laws::TractionLaw& law, double opening, double largest) {
  return opening >= largest ? law.traction(opening) : law.traction(largest) * opening / largest;
}

void add_pair_force(Crack& crack, std::size_t k, double x, double y) {
  crack.face[above].force_x[k] += x;
  crack.face[above].force_y[k] += y;
  crack.face[below].force_x[k] -= x;
  crack.face[below].force_y[k] -= y;
}

}  // namespace

void move_markers(State& state) {
  const Grid& grid = state.grid;
  for (std::size_t side = 0; side < 2; ++side) {
    const VelocityField& field = grid.side[side];
    Face& face = state.crack.face[side];
    for (std::size_t k = 0; k < state.crack.size(); ++k) {
      face.force_x[k] = face.force_y[k] = 0.0;
      const double column = grid.column_of(face.x[k]), row = grid.row_of(face.y[k]);
      face.inverse_mass[k] = 0.0;
      if (!grid.holds(column, row)) continue;
      const Spline sx(column), sy(row);
      double mass = 0.0;
      Lanes momentum{};
      for (int j = 0; j < 3; ++j) {
        const std::size_t node = grid.node(sx.base, sy.base + j);
        const double w = sy.weight(j);
        for (int i = 0; i < 3; ++i) mass += w * sx.weight(i) * field.mass[node + static_cast<std::size_t>(i)];
        momentum += w * load(&field.momentum[2 * node]);
      }
      if (mass <= state.smallest_mass) continue;
      momentum *= sx.row_weights();
      face.inverse_mass[k] = 1.0 / mass;
      face.velocity_x[k] = sum_x(momentum) / mass;
      face.velocity_y[k] = sum_y(momentum) / mass;
      face.node_column[k] = sx.base;
      face.node_row[k] = sy.base;
      face.offset_x[k] = sx.f;
      face.offset_y[k] = sy.f;
      face.x[k] += state.step * face.velocity_x[k];
      face.y[k] += state.step * face.velocity_y[k];
    }
  }
}

void pull_faces(State& state, const Cohesive& cohesive) {
  Crack& crack = state.crack;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  const double length = crack.spacing;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (upper.inverse_mass[k] == 0.0 || lower.inverse_mass[k] == 0.0) continue;
    if (!crack.intact[k]) continue;
    const double normal = upper.y[k] - lower.y[k], shear = upper.x[k] - lower.x[k];
    const double opening = std::max(normal, 0.0), slip = std::abs(shear);
    const double normal_traction = traction(*cohesive.mode_I, opening, crack.largest_normal[k]);
    const double shear_traction = std::copysign(traction(*cohesive.mode_II, slip, crack.largest_shear[k]), shear);
    crack.largest_normal[k] = std::max(crack.largest_normal[k], opening);
    crack.largest_shear[k] = std::max(crack.largest_shear[k], slip);
    // Trapezoid over the step: the openings moved with these very velocities.
    const double dt = state.step;
    state.work.mode_I +=
        0.5 * (normal_traction + crack.traction_normal[k]) * dt * (upper.velocity_y[k] - lower.velocity_y[k]) * length;
    state.work.mode_II +=
        0.5 * (shear_traction + crack.traction_shear[k]) * dt * (upper.velocity_x[k] - lower.velocity_x[k]) * length;
    crack.traction_normal[k] = normal_traction;
    crack.traction_shear[k] = shear_traction;

    const double share_I = cohesive.mode_I->area(crack.largest_normal[k]) / cohesive.mode_I->toughness();
    const double share_II = cohesive.mode_II->area(crack.largest_shear[k]) / cohesive.mode_II->toughness();
    if (std::pow(share_I, cohesive.exponent_n) + std::pow(share_II, cohesive.exponent_m) >= 1.0) {
      crack.intact[k] = 0;
      crack.front = std::max(crack.front, crack.reference_x[k]);
      continue;
    }
    add_pair_force(crack, k, -shear_traction * length, -normal_traction * length);
  }
}

void close_faces(State& state, double stiffness) {
  Crack& crack = state.crack;
  Face &upper = crack.face[above], &lower = crack.face[below];
  if (crack.size() < 2) return;
  const std::size_t last = crack.size() - 2;
  const double length = crack.spacing;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (upper.inverse_mass[k] == 0.0) continue;
    const double x = upper.x[k];
    if (x < lower.x.front() || x > lower.x.back()) continue;
    // The lower face hardly moves: start where the reference spacing says and step to the segment that holds x.
    auto j = std::min(last, static_cast<std::size_t>((x - lower.x.front()) / length));
    while (j > 0 && lower.x[j] > x) --j;
    while (j < last && lower.x[j + 1] < x) ++j;
    if (lower.inverse_mass[j] == 0.0 || lower.inverse_mass[j + 1] == 0.0) continue;
    const double run = lower.x[j + 1] - lower.x[j];
    const double t = (x - lower.x[j]) / run, slope = (lower.y[j + 1] - lower.y[j]) / run;
    const double gap = upper.y[k] - (lower.y[j] + t * run * slope);
    if (gap >= 0.0 || gap < -2.0 * state.grid.cell) continue;
    const double push = -stiffness * gap * length;
    upper.force_x[k] -= slope * push;
    upper.force_y[k] += push;
    lower.force_x[j] += (1.0 - t) * slope * push;
    lower.force_y[j] -= (1.0 - t) * push;
    lower.force_x[j + 1] += t * slope * push;
    lower.force_y[j + 1] -= t * push;
    state.contact_energy -= 0.5 * push * gap;
  }
}

void spread_marker_forces(State& state) {
  for (std::size_t side = 0; side < 2; ++side) {
    VelocityField& field = state.grid.side[side];
    const Face& face = state.crack.face[side];
    for (std::size_t k = 0; k < state.crack.size(); ++k) {
      if (face.inverse_mass[k] == 0.0 || (face.force_x[k] == 0.0 && face.force_y[k] == 0.0)) continue;
      const Spline sx(face.node_column[k], face.offset_x[k]), sy(face.node_row[k], face.offset_y[k]);
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const std::size_t node = state.grid.node(sx.base + i, sy.base + j);
          const double share = sx.weight(i) * sy.weight(j) * field.mass[node] * face.inverse_mass[k];
          field.force[2 * node] += share * face.force_x[k];
          field.force[2 * node + 1] += share * face.force_y[k];
        }
    }
  }
}

}  // namespace kerf::forward
