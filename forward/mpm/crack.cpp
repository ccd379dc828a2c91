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

/// From the centre of the nodes that a marker follows to the marker, mm. The kernel is weighted with masses and the
/// face is where they end, so that they lie a third of a cell inside.
struct Arm {
  double x, y;
};
Arm arm(const State& state, const Face& face, Side side, std::size_t k, const Spline& sx, const Spline& sy) {
  const Grid& grid = state.grid;
  Arm sum{};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double share = sx.weight(i) * sy.weight(j) * grid.side[side].mass[grid.node(sx.base + i, sy.base + j)] *
                           face.inverse_mass[k];
      sum.x -= share * (grid.origin_x + (sx.base + i) * grid.cell_x);
      sum.y -= share * (grid.origin_y + (sy.base + j) * grid.cell_y);
    }
  return {sum.x + face.x[k], sum.y + face.y[k]};
}

void move_face(State& state, Face& face, Side side) {
  const Grid& grid = state.grid;
  const VelocityField& field = grid.side[side];
  for (std::size_t k = 0; k < face.size(); ++k) {
    face.force_x[k] = face.force_y[k] = 0.0;
    const double column = grid.column_of(face.x[k]), row = grid.row_of(face.y[k]);
    face.inverse_mass[k] = 0.0;
    if (!grid.holds(column, row) || !grid.carries(face.x[k], face.y[k])) continue;
    const Spline sx(column), sy(row);
    double mass = 0.0, squares = 0.0;
    Lanes momentum{};
    for (int j = 0; j < 3; ++j) {
      const std::size_t node = grid.node(sx.base, sy.base + j);
      const double w = sy.weight(j);
      for (int i = 0; i < 3; ++i) {
        const double share = w * sx.weight(i), node_mass = field.mass[node + static_cast<std::size_t>(i)];
        mass += share * node_mass;
        squares += share * share * node_mass;
      }
      momentum += w * load(&field.momentum[2 * node]);
    }
    if (mass <= state.smallest_mass) continue;
    momentum *= sx.row_weights();
    face.inverse_mass[k] = 1.0 / mass;
    face.moved_mass[k] = mass * mass / squares;
    face.velocity_x[k] = sum_x(momentum) / mass;
    face.velocity_y[k] = sum_y(momentum) / mass;
    if (state.spin != 0.0) {
      // Else the faces of a log that only turns would slide on each other, each being followed on its own side.
      const Arm from = arm(state, face, side, k, sx, sy);
      face.velocity_x[k] -= state.spin * from.y;
      face.velocity_y[k] += state.spin * from.x;
    }
    face.node_column[k] = sx.base;
    face.node_row[k] = sy.base;
    face.offset_x[k] = sx.f;
    face.offset_y[k] = sy.f;
    face.x[k] += state.step * face.velocity_x[k];
    face.y[k] += state.step * face.velocity_y[k];
  }
}

void spread_face(State& state, const Face& face, Side side) {
  VelocityField& field = state.grid.side[side];
  for (std::size_t k = 0; k < face.size(); ++k) {
    if (face.inverse_mass[k] == 0.0 || (face.force_x[k] == 0.0 && face.force_y[k] == 0.0)) continue;
    const Spline sx(face.node_column[k], face.offset_x[k]), sy(face.node_row[k], face.offset_y[k]);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const std::size_t node = state.grid.node(sx.base + i, sy.base + j);
        const double share = sx.weight(i) * sy.weight(j) * field.mass[node] * face.inverse_mass[k];
        field.force[2 * node] += share * face.force_x[k];
        field.force[2 * node + 1] += share * face.force_y[k];
      }
    if (state.spin != 0.0) {
      // The nodes lie elsewhere than the marker and lack a moment, which then the spindle has to bear.
      const Arm from = arm(state, face, side, k, sx, sy);
      state.work.tool -= state.step * state.spin * (face.force_y[k] * from.x - face.force_x[k] * from.y);
    }
  }
}

/// Tractions of one pair at openings (normal >= 0, |shear|), given the largest so far, and whether it fails.
struct Bond {
  double normal, shear;
  bool fails;
};

/// Most scenes have exponents of one, and every pair asks in every step.
double power(double share, double exponent) {
  return exponent == 1.0 ? share : std::pow(share, exponent);
}

Bond decoupled(const Cohesive& law, double normal, double shear, double largest_normal, double largest_shear) {
  const bool areas = law.mixed_mode == MixedMode::areas;
  const double now_normal = std::max(normal, largest_normal), now_shear = std::max(shear, largest_shear);
  const auto used = [areas](const laws::TractionLaw& mode, double largest) {
    return (areas ? mode.area(largest) : mode.dissipated(largest)) / mode.toughness();
  };
  const double share_I = used(*law.mode_I, now_normal), share_II = used(*law.mode_II, now_shear);
  return {traction(*law.mode_I, normal, largest_normal), traction(*law.mode_II, shear, largest_shear),
          power(share_I, law.exponent_n) + power(share_II, law.exponent_m) >= 1.0};
}

/// Both modes follow their laws at one common share of the critical openings, the largest so far (Tvergaard 1990).
Bond coupled(const Cohesive& law, double normal, double shear, double& most) {
  const double critical_I = law.mode_I->critical_opening(), critical_II = law.mode_II->critical_opening();
  most = std::max(most, std::hypot(normal / critical_I, shear / critical_II));
  if (most == 0.0) return {0.0, 0.0, false};
  return {law.mode_I->traction(most * critical_I) * normal / critical_I / most,
          law.mode_II->traction(most * critical_II) * shear / critical_II / most, most >= 1.0};
}

/// The face of a log has no end to search from: a marker closes on the neighbourhood of its own partner, or on nothing.
std::optional<Overlap> overlap_on_spiral(const State& state, std::size_t k, std::size_t last, double most) {
  const Crack& crack = state.crack;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  const double reach = 2.0 * most, away_x = upper.x[k] - lower.x[k], away_y = upper.y[k] - lower.y[k];
  if (away_x * away_x + away_y * away_y > reach * reach) return {};
  const Spiral::Direction n = crack.normal(k, state.tool.x);
  const auto along = [&](std::size_t i) { return n.y * (upper.x[k] - lower.x[i]) - n.x * (upper.y[k] - lower.y[i]); };
  std::size_t j = std::min(k, last);
  while (j > 0 && along(j) < 0.0) --j;
  while (j < last && along(j + 1) > 0.0) ++j;
  const double run = along(j) - along(j + 1);
  if (along(j) < 0.0 || along(j + 1) > 0.0 || lower.inverse_mass[j] == 0.0 || lower.inverse_mass[j + 1] == 0.0)
    return {};
  const double t = along(j) / run;
  const auto above_face = [&](std::size_t i) {
    return n.x * (upper.x[k] - lower.x[i]) + n.y * (upper.y[k] - lower.y[i]);
  };
  const double slope = (above_face(j) - above_face(j + 1)) / run;
  const double depth = -(above_face(j) + t * (above_face(j + 1) - above_face(j)));
  if (depth <= 0.0 || depth > most) return {};
  return Overlap{j, t, n.x - slope * n.y, n.y + slope * n.x, depth};
}

}  // namespace

void move_markers(State& state) {
  move_face(state, state.crack.face[below], below);
  move_face(state, state.crack.face[above], above);
  move_face(state, state.top, above);
}

void pull_faces(State& state, const Cohesive& cohesive) {
  Crack& crack = state.crack;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  const double length = crack.spacing, dt = state.step;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (upper.inverse_mass[k] == 0.0 || lower.inverse_mass[k] == 0.0) continue;
    if (!crack.intact[k]) continue;
    const auto [n_x, n_y] = crack.normal(k, state.tool.x);
    const double part_x = upper.x[k] - lower.x[k], part_y = upper.y[k] - lower.y[k];
    const double opening = std::max(n_x * part_x + n_y * part_y, 0.0), shear = n_y * part_x - n_x * part_y;
    double &largest_normal = crack.largest_normal[k], &largest_shear = crack.largest_shear[k];
    const Bond bond = cohesive.mixed_mode == MixedMode::coupled
                          ? coupled(cohesive, opening, std::abs(shear), crack.largest_share[k])
                          : decoupled(cohesive, opening, std::abs(shear), largest_normal, largest_shear);
    const double normal_traction = bond.normal, shear_traction = std::copysign(bond.shear, shear);
    largest_normal = std::max(largest_normal, opening);
    largest_shear = std::max(largest_shear, std::abs(shear));
    // Trapezoid over the step: the openings moved with these very velocities.
    // Openings are told by one who turns with the log.
    const double turn_x = -state.spin * part_y, turn_y = state.spin * part_x;
    const double rate_x = upper.velocity_x[k] - lower.velocity_x[k] - turn_x;
    const double rate_y = upper.velocity_y[k] - lower.velocity_y[k] - turn_y;
    const double work_I =
        0.5 * (normal_traction + crack.traction_normal[k]) * dt * (n_x * rate_x + n_y * rate_y) * length;
    const double work_II =
        0.5 * (shear_traction + crack.traction_shear[k]) * dt * (n_y * rate_x - n_x * rate_y) * length;
    state.work.mode_I += work_I;
    state.work.mode_II += work_II;
    crack.taken[k] += (work_I + work_II) / length;
    crack.traction_normal[k] = normal_traction;
    crack.traction_shear[k] = shear_traction;
    if (bond.fails) {
      break_bond(state, cohesive, k);
      continue;
    }
    const double force_x = -(n_y * shear_traction + n_x * normal_traction) * length;
    const double force_y = -(n_y * normal_traction - n_x * shear_traction) * length;
    add_pair_force(crack, k, force_x, force_y);
    // Tractions that do not point along the opening are a couple, which the spindle bears.
    state.work.tool += (force_x * turn_x + force_y * turn_y) * dt;
  }
}

void break_bond(State& state, const Cohesive& cohesive, std::size_t k) {
  Crack& crack = state.crack;
  // What a bond has taken: the area up to its largest opening, less what it gave back since, on the way to the origin.
  // Coupled laws have no such area, the work depends on the way.
  const auto taken = [](const laws::TractionLaw& law, double opening, double largest) {
    if (largest == 0.0) return 0.0;
    const double share = std::min(opening / largest, 1.0);
    return law.area(largest) - 0.5 * law.traction(largest) * largest * (1.0 - share * share);
  };
  const auto [n_x, n_y] = crack.normal(k, state.tool.x);
  const double part_x = crack.face[above].x[k] - crack.face[below].x[k];
  const double part_y = crack.face[above].y[k] - crack.face[below].y[k];
  const double normal = std::max(n_x * part_x + n_y * part_y, 0.0), shear = std::abs(n_y * part_x - n_x * part_y);
  crack.intact[k] = 0;
  crack.front = std::max(crack.front, crack.reference_x[k]);
  state.work.broken_length += crack.spacing;
  state.work.broken_energy += crack.spacing * (cohesive.mixed_mode == MixedMode::coupled
                                                   ? crack.taken[k]
                                                   : taken(*cohesive.mode_I, normal, crack.largest_normal[k]) +
                                                         taken(*cohesive.mode_II, shear, crack.largest_shear[k]));
}

std::optional<Overlap> overlap(const State& state, std::size_t k) {
  const Crack& crack = state.crack;
  const Face &upper = crack.face[above], &lower = crack.face[below];
  if (crack.size() < 2 || upper.inverse_mass[k] == 0.0) return {};
  const std::size_t last = crack.size() - 2;
  const double most = 2.0 * state.grid.cell_y;
  if (crack.spiral) return overlap_on_spiral(state, k, last, most);
  const double x = upper.x[k];
  if (x < lower.x.front() || x > lower.x.back()) return {};
  // The lower face hardly moves: start where the reference spacing says and step to the segment that holds x.
  auto j = std::min(last, static_cast<std::size_t>((x - lower.x.front()) / crack.spacing));
  while (j > 0 && lower.x[j] > x) --j;
  while (j < last && lower.x[j + 1] < x) ++j;
  if (lower.inverse_mass[j] == 0.0 || lower.inverse_mass[j + 1] == 0.0) return {};
  const double run = lower.x[j + 1] - lower.x[j];
  const double t = (x - lower.x[j]) / run, slope = (lower.y[j + 1] - lower.y[j]) / run;
  const double depth = lower.y[j] + t * run * slope - upper.y[k];
  if (depth <= 0.0 || depth > most) return {};
  return Overlap{j, t, -slope, 1.0, depth};
}

void push_apart(Crack& crack, std::size_t k, const Overlap& touch, double x, double y) {
  Face &upper = crack.face[above], &lower = crack.face[below];
  const std::size_t j = touch.segment;
  const double t = touch.t;
  upper.force_x[k] += x;
  upper.force_y[k] += y;
  lower.force_x[j] -= (1.0 - t) * x;
  lower.force_y[j] -= (1.0 - t) * y;
  lower.force_x[j + 1] -= t * x;
  lower.force_y[j + 1] -= t * y;
}

void close_faces(State& state, double stiffness) {
  Crack& crack = state.crack;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    const std::optional<Overlap> touch = overlap(state, k);
    if (!touch) continue;
    const double push = stiffness * touch->depth * crack.spacing;
    push_apart(crack, k, *touch, touch->normal_x * push, touch->normal_y * push);
    state.contact_energy += 0.5 * push * touch->depth;
  }
}

void spread_marker_forces(State& state) {
  spread_face(state, state.crack.face[below], below);
  spread_face(state, state.crack.face[above], above);
  spread_face(state, state.top, above);
}

}  // namespace kerf::forward
