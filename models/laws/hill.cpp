#include "models/laws/hill.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/base/error.hpp"
#include "models/laws/return_map.hpp"

namespace kerf::laws {
namespace {

/// Strengths that differ by orders of magnitude grade the matrices below; built once, they can afford the digits.
using Real = long double;
using Square = Eigen::Matrix<Real, 3, 3>;
using Rows = Eigen::Matrix<Real, 2, 3>;

Square compliance_of(const Hill::Constants& c) {
  Square s;
  const Real x = c.modulus_x, y = c.modulus_y, z = c.modulus_z;
  s << 1 / x, -c.poisson_xy / x, -c.poisson_xz / x,  //
      -c.poisson_xy / x, 1 / y, -c.poisson_yz / y,   //
      -c.poisson_xz / x, -c.poisson_yz / y, 1 / z;
  return s;
}

/// Rows of B for the normal stresses over (xx, yy, zz), times a stress. In u = s_xx - s_zz and v = s_yy - s_zz the
/// normal part of (1) has the matrix [[G+H, -H], [-H, F+H]], whose Cholesky factor is written in a = 1/Y_x, b, c so
/// that nothing cancels: FG + GH + HF = (a+b+c)(b+c-a)(c+a-b)(a+b-c)/4, as in Heron's formula.
Rows normal_factor(const Hill::Constants& constants) {
  const Real a = 1 / Real(constants.yield_x), b = 1 / Real(constants.yield_y), c = 1 / Real(constants.yield_z);
  Real coupling = 0, along_v = b;
  if (a > 0) {
    coupling = ((c - b) * (c + b) / a - a) / 2;  // -H/a
    // The triangle may be flat up to rounding.
    along_v = std::sqrt(std::max(Real(0), (a + b + c) * (b + c - a) * (c + a - b) * (a + b - c))) / (2 * a);
  }
  Rows rows;
  rows << a, coupling, -a - coupling,  //
      0, along_v, -along_v;
  return rows;
}

double reference_strength(const Hill::Constants& c) {
  for (const double strength : {c.yield_x, c.yield_y, c.yield_z, std::numbers::sqrt3 * c.shear_yield_xy})
    if (std::isfinite(strength)) return strength;
  return 1.0;  // never yields: (1) is zero whatever the stress
}

}  // namespace

Block Hill::block() {
  constexpr double stiffest = 2e6, strongest = 1e6;
  return {.path = "material",
          .variant = "hill",
          .meaning = "orthotropic elastic, Hill plastic, plane strain; x along the cut, y across the crack plane",
          .parameters =
              {number("modulus_x", "MPa", 1e-2, stiffest, "Young's modulus along the cut E_x"),
               number("modulus_y", "MPa", 1e-2, stiffest, "Young's modulus across the crack plane E_y"),
               number("modulus_z", "MPa", 1e-2, stiffest, "Young's modulus along the tool's edge E_z"),
               number("shear_modulus_xy", "MPa", 1e-2, stiffest, "shear modulus G_xy"),
               number("poisson_xy", "1", -10, 10, "Poisson's ratio nu_xy: shrinkage along y when pulled along x"),
               number("poisson_xz", "1", -10, 10, "Poisson's ratio nu_xz: shrinkage along z when pulled along x"),
               number("poisson_yz", "1", -10, 10, "Poisson's ratio nu_yz: shrinkage along z when pulled along y"),
               number("density", "kg/m^3", 1.0, 3e4, "mass density rho"),
               number("yield_x", "MPa", 1e-4, strongest, "yield stress along x; left out: infinite").if_given(),
               number("yield_y", "MPa", 1e-4, strongest, "yield stress along y; left out: infinite").if_given(),
               number("yield_z", "MPa", 1e-4, strongest, "yield stress along z; left out: infinite").if_given(),
               number("shear_yield_xy", "MPa", 1e-4, strongest, "shear yield stress; left out: infinite").if_given(),
               number("hardening_coefficient", "1", 0.0, 1e4, "K of the hardening 1 + K eps_p^n").or_else("0"),
               number("hardening_exponent", "1", 0.05, 5.0, "n of the hardening 1 + K eps_p^n").or_else("1")},
          .required = true};
}

Hill Hill::from(const Values& values) {
  const auto strength = [&](const char* key) { return values.has(key) ? values.number(key) : infinite; };
  const Constants constants{.modulus_x = values.number("modulus_x"),
                            .modulus_y = values.number("modulus_y"),
                            .modulus_z = values.number("modulus_z"),
                            .shear_modulus_xy = values.number("shear_modulus_xy"),
                            .poisson_xy = values.number("poisson_xy"),
                            .poisson_xz = values.number("poisson_xz"),
                            .poisson_yz = values.number("poisson_yz"),
                            .density = values.number("density"),
                            .yield_x = strength("yield_x"),
                            .yield_y = strength("yield_y"),
                            .yield_z = strength("yield_z"),
                            .shear_yield_xy = strength("shear_yield_xy"),
                            .hardening_coefficient = values.number("hardening_coefficient"),
                            .hardening_exponent = values.number("hardening_exponent")};
  if (const auto wrong = fault(constants))
    throw InputError(fmt::format("{}: {}", values.where(wrong->key), wrong->reason));
  return Hill(constants);
}

std::optional<Hill::Fault> Hill::fault(const Constants& c) {
  const auto too_large = [](const char* key, double ratio, double modulus_i, double modulus_j) -> std::optional<Fault> {
    const double limit = std::sqrt(modulus_i / modulus_j);
    if (std::abs(ratio) < limit) return std::nullopt;
    return Fault{key,
                 fmt::format("{} = {:g} must stay within +-{:.4g} = sqrt(E_i/E_j): the elastic energy would not be "
                             "positive",
                             key, ratio, limit)};
  };
  if (auto wrong = too_large("poisson_xy", c.poisson_xy, c.modulus_x, c.modulus_y)) return wrong;
  if (auto wrong = too_large("poisson_xz", c.poisson_xz, c.modulus_x, c.modulus_z)) return wrong;
  if (auto wrong = too_large("poisson_yz", c.poisson_yz, c.modulus_y, c.modulus_z)) return wrong;
  // Determinant of the compliance made pure: correlations of the three directions.
  const double xy = c.poisson_xy * std::sqrt(c.modulus_y / c.modulus_x),
               xz = c.poisson_xz * std::sqrt(c.modulus_z / c.modulus_x),
               yz = c.poisson_yz * std::sqrt(c.modulus_z / c.modulus_y);
  const double determinant = 1.0 - xy * xy - xz * xz - yz * yz - 2.0 * xy * xz * yz;
  if (determinant < 1e-6)
    return Fault{"poisson_xy",
                 fmt::format("poisson_xy = {:g}, poisson_xz = {:g} and poisson_yz = {:g} together leave no positive "
                             "elastic energy (determinant {:.3g} of the scaled compliance, must be above 1e-6)",
                             c.poisson_xy, c.poisson_xz, c.poisson_yz, determinant)};

  struct Strength {
    const char* key;
    double inverse;
  };
  std::array<Strength, 3> strengths{
      {{"yield_x", 1.0 / c.yield_x}, {"yield_y", 1.0 / c.yield_y}, {"yield_z", 1.0 / c.yield_z}}};
  std::sort(strengths.begin(), strengths.end(),
            [](const Strength& p, const Strength& q) { return p.inverse > q.inverse; });
  const double sum = strengths[1].inverse + strengths[2].inverse;
  if (strengths[0].inverse > sum * (1.0 + 1e-12))
    return Fault{strengths[0].key,
                 fmt::format("{} = {:g} MPa is too low beside {} and {} for Hill's criterion: {}; its inverse must not "
                             "exceed the sum of the other two inverses",
                             strengths[0].key, 1.0 / strengths[0].inverse, strengths[1].key, strengths[2].key,
                             sum > 0.0 ? fmt::format("with them it must be at least {:.6g} MPa", 1.0 / sum)
                                       : std::string("one of them must be finite too"))};
  return std::nullopt;
}

Hill::Hill(const Constants& constants)
    : density(constants.density),
      constants_(constants),
      hardening_{.yield_stress = reference_strength(constants),
                 .coefficient = constants.hardening_coefficient,
                 .exponent = constants.hardening_exponent},
      c_shear_(constants.shear_modulus_xy) {
  if (const auto wrong = fault(constants)) throw InputError(wrong->reason);
  const Square compliance = compliance_of(constants);
  const Square stiffness = compliance.llt().solve(Square::Identity());
  const auto rounded = [](Real value) { return static_cast<double>(value); };
  c_xx_ = rounded(stiffness(0, 0));
  c_yy_ = rounded(stiffness(1, 1));
  c_xy_ = rounded(stiffness(0, 1));
  c_xz_ = rounded(stiffness(0, 2));
  c_yz_ = rounded(stiffness(1, 2));

  // W turns the rows of B L, C = L L^T, until they are orthogonal; D are their squared lengths. B C B^T itself would
  // have lost the weaker mode's digits.
  const double reference = hardening_.yield_stress;
  const Rows factor = reference * normal_factor(constants);
  const Square lower = stiffness.llt().matrixL();
  const Rows product = factor * lower;
  const Real overlap = product.row(0).dot(product.row(1));
  const Real angle = std::atan2(2 * overlap, product.row(0).squaredNorm() - product.row(1).squaredNorm()) / 2;
  Eigen::Matrix<Real, 2, 2> turn;
  turn << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
  const Rows modes = turn * factor, back = modes * stiffness, orthogonal = turn * product;
  const Real largest = product.squaredNorm();
  for (std::size_t k = 0; k < 2; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Real mode_stiffness = orthogonal.row(row).squaredNorm();
    // What rounding leaves of a direction that cannot yield is no mode.
    if (mode_stiffness <= 1e-26L * largest) continue;
    stiffness_[k] = rounded(mode_stiffness);
    for (std::size_t i = 0; i < 3; ++i) {
      modes_[k][i] = rounded(modes(row, static_cast<Eigen::Index>(i)));
      return_[k][i] = rounded(back(row, static_cast<Eigen::Index>(i)));
    }
  }
  shear_mode_ = reference / constants.shear_yield_xy;
  stiffness_[2] = shear_mode_ * shear_mode_ * c_shear_;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      compliance_[i][j] = rounded(compliance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
}

double Hill::plane_strain_modulus() const {
  const auto reduced = [&](std::size_t i, std::size_t j) {
    return compliance_[i][j] - compliance_[i][2] * compliance_[j][2] / compliance_[2][2];
  };
  const double b11 = reduced(0, 0), b22 = reduced(1, 1), b12 = reduced(0, 1), b66 = 1.0 / c_shear_;
  return 1.0 / std::sqrt(0.5 * b11 * b22 * (std::sqrt(b22 / b11) + (2.0 * b12 + b66) / (2.0 * b11)));
}

double Hill::wave_speed(double cos, double sin) const {
  const double xx = c_xx_ * cos * cos + c_shear_ * sin * sin, yy = c_shear_ * cos * cos + c_yy_ * sin * sin;
  const double xy = (c_xy_ + c_shear_) * cos * sin;
  return std::sqrt((0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy)) / density);
}

double Hill::elastic_energy(const StressPoint& p) const {
  const double cc = p.axis_x * p.axis_x, ss = p.axis_y * p.axis_y, cs = p.axis_x * p.axis_y;
  const double xx = cc * p.xx + ss * p.yy + 2.0 * cs * p.xy, yy = ss * p.xx + cc * p.yy - 2.0 * cs * p.xy;
  const double xy = cs * (p.yy - p.xx) + (cc - ss) * p.xy;
  const auto& s = compliance_;
  return 0.5 * (s[0][0] * xx * xx + s[1][1] * yy * yy + s[2][2] * p.zz * p.zz + xy * xy / c_shear_) +
         s[0][1] * xx * yy + s[0][2] * xx * p.zz + s[1][2] * yy * p.zz;
}

inline bool Hill::return_at_once(const std::array<Lanes, 3>& z, Lanes square, MaterialPoints& points) const {
  const LinearHardening hardening{.yield_stress = hardening_.yield_stress,
                                  .modulus = hardening_.yield_stress * hardening_.coefficient};
  const Lanes flow = hardening.flow_stress(points.plastic_strain), goal = flow * flow;
  const double D0 = stiffness_[0] + hardening.modulus, D1 = stiffness_[1] + hardening.modulus,
               D2 = stiffness_[2] + hardening.modulus;
  // sum (z_i k_i)^2 = square - 2 S_1 t + 3 S_2 t^2 - 4 S_3 t^3 ..., S_n = sum D_i^n z_i^2, solved for t.
  const Lanes u0 = D0 * z[0] * z[0], u1 = D1 * z[1] * z[1], u2 = D2 * z[2] * z[2];
  const Lanes v0 = D0 * u0, v1 = D1 * u1, v2 = D2 * u2;
  const Lanes per_S1 = rough_reciprocal(u0 + u1 + u2);
  const Lanes first = 0.5 * (square - goal) * per_S1, second = 1.5 * (v0 + v1 + v2) * per_S1,
              third = 2.0 * (D0 * v0 + D1 * v1 + D2 * v2) * per_S1;
  const LaneMask yields = square > goal;
  Lanes t = first + first * first * (second + first * (2.0 * second * second - third));
  t = yields ? t : Lanes{};

  const Lanes f0 = 1.0 + t * D0, f1 = 1.0 + t * D1, f2 = 1.0 + t * D2, f01 = f0 * f1;
  const Lanes all = reciprocal(f01 * f2);
  const Lanes k0 = f1 * f2 * all, k1 = f0 * f2 * all, k2 = f01 * all;
  const Lanes d0 = D0 * k0, d1 = D1 * k1, d2 = D2 * k2;
  Lanes s0 = z[0] * k0, s1 = z[1] * k1;
  const Lanes s2 = z[2] * k2, left = s0 * s0 + s1 * s1 + s2 * s2 - goal;
  Lanes more = 0.5 * left * rough_reciprocal(d0 * s0 * s0 + d1 * s1 * s1 + d2 * s2 * s2);
  more = yields ? more : Lanes{};
  const Lanes before = t;
  t += more;
  // The square of this is what Newton's step leaves.
  constexpr double small = 4e-7;
  const double stiffest = std::max({D0, D1, D2});
  if (any(!((abs(more) * stiffest <= small) & (before >= 0.0)))) [[unlikely]]
    return find_return(hardening, z, sqrt(square), points);
  s0 -= more * d0 * s0;
  s1 -= more * d1 * s1;
  points.plastic_strain += t * flow;
  points.xx -= t * (return_[0][0] * s0 + return_[1][0] * s1);
  points.yy -= t * (return_[0][1] * s0 + return_[1][1] * s1);
  points.zz -= t * (return_[0][2] * s0 + return_[1][2] * s1);
  points.xy -= points.xy * (t * stiffness_[2] * (k2 - more * d2 * k2));
  return true;
}

bool Hill::update(const StrainIncrement& l, MaterialPoints& points) const {
  auto& [xx, yy, zz, xy, plastic_strain, ax, ay] = points;
  // Stress seen from the old axes is the turned stress seen from the turned axes; the strain is seen from these.
  const InPlane old = InPlane::of(xx, yy, xy).seen_from(ax, ay);
  const auto [c, s] = step_rotation(l.xy, l.yx);
  const Lanes turned_x = c * ax - s * ay, turned_y = s * ax + c * ay;
  const Lanes unit = 1.5 - 0.5 * (turned_x * turned_x + turned_y * turned_y);  // rounding must not add up
  ax = unit * turned_x;
  ay = unit * turned_y;
  const InPlane strain = InPlane::of(l.xx, l.yy, 0.5 * (l.xy + l.yx)).seen_from(ax, ay);
  const Lanes e_xx = strain.xx(), e_yy = strain.yy();
  xx = old.xx() + c_xx_ * e_xx + c_xy_ * e_yy;
  yy = old.yy() + c_xy_ * e_xx + c_yy_ * e_yy;
  zz += c_xz_ * e_xx + c_yz_ * e_yy;
  xy = old.shear + 2.0 * c_shear_ * strain.shear;

  const std::array<Lanes, 3> z{modes_[0][0] * xx + modes_[0][1] * yy + modes_[0][2] * zz,
                               modes_[1][0] * xx + modes_[1][1] * yy + modes_[1][2] * zz, shear_mode_ * xy};
  const Lanes square = z[0] * z[0] + z[1] * z[1] + z[2] * z[2];
  if (any(!(square < infinite))) return false;
  bool converged = true;
  if (any(square > hardening_.yield_stress * hardening_.yield_stress)) {
    // Without a power the flow stress is arithmetic and the whole return map runs in SIMD.
    const bool linear = hardening_.coefficient == 0.0 || hardening_.exponent == 1.0;
    converged = linear ? return_at_once(z, square, points) : find_return(hardening_, z, sqrt(square), points);
  }

  const InPlane now = InPlane::of(xx, yy, xy).seen_from(ax, -ay);
  xx = now.xx();
  yy = now.yy();
  xy = now.shear;
  return converged;
}

template <class Hardening>
[[gnu::noinline, gnu::cold]] bool Hill::find_return(const Hardening& hardening, const std::array<Lanes, 3>& z, Lanes q,
                                                    MaterialPoints& points) const {
  const double D0 = stiffness_[0], D1 = stiffness_[1], D2 = stiffness_[2];
  // The weakest mode there is bounds the root of (5) from above.
  double softest = infinite;
  for (const double D : stiffness_)
    if (D > 0.0) softest = std::min(softest, D);
  const Lanes flow_now = hardening.flow_stress(points.plastic_strain);
  const Lanes upper = q > flow_now * (1.0 + return_tolerance) ? (q / flow_now - 1.0) / softest : Lanes{};
  if (!any(upper > 0.0)) return true;

  Lanes m{};
  const bool converged = find_roots(
      [&](Lanes at, Lanes& value, Lanes& slope) {
        // One division for the three factors 1/(1 + m D), one for 1/q.
        const Lanes f0 = 1.0 + at * D0, f1 = 1.0 + at * D1, f2 = 1.0 + at * D2;
        const Lanes all = 1.0 / (f0 * f1 * f2);
        const Lanes k0 = f1 * f2 * all, k1 = f0 * f2 * all, k2 = f0 * f1 * all;
        const Lanes s0 = z[0] * k0, s1 = z[1] * k1, s2 = z[2] * k2;
        const Lanes square = s0 * s0 + s1 * s1 + s2 * s2 + 1e-300, inverse = inverse_sqrt(square);
        const Lanes now = square * inverse;
        const Lanes w0 = k0 * s0 * s0, w1 = k1 * s1 * s1, w2 = k2 * s2 * s2;
        const Lanes now_slope = -(D0 * w0 + D1 * w1 + D2 * w2) * inverse;
        const Lanes strain_slope = (w0 + w1 + w2) * inverse;
        const Lanes strain = points.plastic_strain + at * now;
        const Lanes flow = hardening.flow_stress(strain);
        value = flow * inverse - 1.0;
        slope = (hardening.slope(strain) * strain_slope - flow * now_slope * inverse) * inverse;
      },
      upper, m);
  const Lanes f0 = 1.0 + m * D0, f1 = 1.0 + m * D1, f2 = 1.0 + m * D2, all = 1.0 / (f0 * f1 * f2);
  const Lanes s0 = z[0] * (f1 * f2 * all), s1 = z[1] * (f0 * f2 * all), s2 = z[2] * (f0 * f1 * all);
  points.plastic_strain += m * sqrt(s0 * s0 + s1 * s1 + s2 * s2);
  points.xx -= m * (return_[0][0] * s0 + return_[1][0] * s1);
  points.yy -= m * (return_[0][1] * s0 + return_[1][1] * s1);
  points.zz -= m * (return_[0][2] * s0 + return_[1][2] * s1);
  points.xy *= f0 * f1 * all;
  return converged;
}

}  // namespace kerf::laws
