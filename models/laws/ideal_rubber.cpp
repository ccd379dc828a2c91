#include "models/laws/ideal_rubber.hpp"

namespace kerf::laws {
namespace {

enum { b_xx, b_yy, b_xy, b_zz };

/// v^(-1/3) of positive numbers to the last digit or two: a third of the exponent to begin with (3 % off), then
/// Newton's steps, each of which squares the error and doubles it.
Lanes inverse_cube_root(Lanes v) {
  LaneMask bits;
  __builtin_memcpy(&bits, &v, sizeof bits);
  bits = 0x553ef0ff289dd796 - __builtin_convertvector(__builtin_convertvector(bits, Lanes) * (1.0 / 3.0), LaneMask);
  Lanes root;
  __builtin_memcpy(&root, &bits, sizeof root);
  for (int k = 0; k < 4; ++k) root *= (4.0 - v * root * root * root) * (1.0 / 3.0);
  return root;
}

struct Invariants {
  Lanes first, second, J, shrink;  ///< shrink: J^(-2/3)
};
Invariants invariants(const BodyPoints& p) {
  const Lanes in_plane = p.memory[b_xx] * p.memory[b_yy] - p.memory[b_xy] * p.memory[b_xy];
  const Lanes trace = p.memory[b_xx] + p.memory[b_yy];
  const Lanes J_squared = in_plane * p.memory[b_zz];
  return {.first = trace + p.memory[b_zz],
          .second = in_plane + trace * p.memory[b_zz],
          .J = sqrt(J_squared),
          .shrink = inverse_cube_root(J_squared)};
}

}  // namespace

std::vector<Parameter> IdealRubber::parameters() {
  return {
      number("C_1", "MPa", 1e-6, 1e4, "Mooney-Rivlin constant of the first invariant, at the reference temperature"),
      number("C_2", "MPa", 0.0, 1e4, "... of the second invariant").or_else("0 MPa"),
      number("bulk_modulus", "MPa", 1e-4, 1e7, "bulk modulus K at the reference temperature"),
      number("reference_temperature", "K", 1.0, 1e4, "T_0"),
      number("density", "kg/m^3", 1.0, 3e4, "mass density rho"),
      number("specific_heat", "J/(kg K)", 1.0, 1e5, "specific heat at constant deformation"),
      flag("thin", "free to contract out of the plane, as a strip is; otherwise held there").or_else("true"),
      number("temperature", "K", 1.0, 1e4, "temperature at the start; absent: that of the reference state").if_given()};
}

IdealRubber IdealRubber::from(const Values& values) {
  return {.C_1 = values.number("C_1"),
          .C_2 = values.number("C_2"),
          .bulk_modulus = values.number("bulk_modulus"),
          .reference = values.number("reference_temperature"),
          .density = values.number("density"),
          .specific_heat = values.number("specific_heat"),
          .thin = values.flag("thin")};
}

IdealRubber::Stress IdealRubber::at_reference(const BodyPoints& p) const {
  const Invariants i = invariants(p);
  const Lanes xx = p.memory[b_xx], yy = p.memory[b_yy], xy = p.memory[b_xy], zz = p.memory[b_zz];
  // I_1 b - b^2 of the second invariant.
  const Lanes second_xx = i.first * xx - xx * xx - xy * xy, second_yy = i.first * yy - yy * yy - xy * xy;
  const Lanes second_zz = i.first * zz - zz * zz, second_xy = (i.first - xx - yy) * xy;
  const Lanes one = 2.0 * C_1 * i.shrink, two = 2.0 * C_2 * i.shrink * i.shrink;
  const Lanes mean = one * i.first / 3.0 + two * 2.0 * i.second / 3.0 - bulk_modulus * i.J * (i.J - 1.0);
  return {.xx = one * xx + two * second_xx - mean,
          .yy = one * yy + two * second_yy - mean,
          .zz = one * zz + two * second_zz - mean,
          .xy = one * xy + two * second_xy};
}

Lanes IdealRubber::potential(const BodyPoints& p) const {
  const Invariants i = invariants(p);
  return C_1 * (i.first * i.shrink - 3.0) + C_2 * (i.second * i.shrink * i.shrink - 3.0) +
         0.5 * bulk_modulus * (i.J - 1.0) * (i.J - 1.0);
}

void IdealRubber::deform(const StrainIncrement& l, BodyPoints& p) const {
  const Lanes xx = p.memory[b_xx], yy = p.memory[b_yy], xy = p.memory[b_xy];
  const Lanes a = 1.0 + l.xx, d = 1.0 + l.yy;
  p.memory[b_xx] = a * a * xx + 2.0 * a * l.xy * xy + l.xy * l.xy * yy;
  p.memory[b_yy] = l.yx * l.yx * xx + 2.0 * l.yx * d * xy + d * d * yy;
  p.memory[b_xy] = a * l.yx * xx + (a * d + l.xy * l.yx) * xy + l.xy * d * yy;
  if (!thin) return;
  // Secants from the last value, which is close: the step is small.
  constexpr int most_iterations = 20;
  const double enough = 1e-13 * (bulk_modulus + C_1 + C_2);
  Lanes before = p.memory[b_zz], at_before = at_reference(p).zz;
  p.memory[b_zz] = before * (1.0 - 1e-6);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Lanes here = p.memory[b_zz], at_here = at_reference(p).zz;
    const Lanes rise = at_here - at_before;
    const auto moves = (abs(at_here) > enough) & (abs(rise) > 0.0);
    if (!any(moves)) return;
    p.memory[b_zz] = moves ? here - at_here * (here - before) / (moves ? rise : Lanes{} + 1.0) : here;
    before = here;
    at_before = at_here;
  }
}

bool IdealRubber::find_stress(BodyPoints& p) const {
  const Stress stress = at_reference(p);
  const Lanes share = p.temperature / reference;
  p.xx = share * stress.xx;
  p.yy = share * stress.yy;
  p.zz = share * stress.zz;
  p.xy = share * stress.xy;
  return !any(!((p.temperature > 0.0) & (p.memory[b_xx] > 0.0) & (p.memory[b_yy] > 0.0) & (abs(p.zz) < 1e300)));
}

Lanes IdealRubber::wave_speed(const BodyPoints& p) const {
  const Lanes stretch = p.memory[b_xx] > p.memory[b_yy] ? p.memory[b_xx] : p.memory[b_yy];
  const double shear = 2.0 * (C_1 + C_2);
  // A thin sheet escapes out of the plane: its waves never feel the bulk modulus.
  const Lanes stiffness = thin ? 4.0 * shear * stretch : bulk_modulus + 2.0 * shear * stretch;
  return sqrt(stiffness * p.temperature / (reference * density));
}

}  // namespace kerf::laws
