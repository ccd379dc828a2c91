#pragma once

#include <array>
#include <variant>

#include "forward/bodies/state.hpp"

namespace kerf::forward::bodies {

// Eight points of a body at a time.

inline laws::BodyPoints load_points(const Points& p, std::size_t first) {
  laws::BodyPoints points{.xx = load(&p.stress_xx[first]),
                          .yy = load(&p.stress_yy[first]),
                          .zz = load(&p.stress_zz[first]),
                          .xy = load(&p.stress_xy[first]),
                          .memory = {},
                          .temperature = {},
                          .heating = {}};
  for (std::size_t k = 0; k < p.memory.size(); ++k) points.memory[k] = load(&p.memory[k][first]);
  if (!p.temperature.empty()) points.temperature = load(&p.temperature[first]);
  return points;
}

inline void store_points(Points& p, std::size_t first, const laws::BodyPoints& points) {
  store(&p.stress_xx[first], points.xx);
  store(&p.stress_yy[first], points.yy);
  store(&p.stress_zz[first], points.zz);
  store(&p.stress_xy[first], points.xy);
  for (std::size_t k = 0; k < p.memory.size(); ++k) store(&p.memory[k][first], points.memory[k]);
  if (!p.temperature.empty()) store(&p.temperature[first], points.temperature);
}

/// dx/dX of eight points, or a nominal stress.
struct Gradient {
  Lanes xx, xy, yx, yy;
  Gradient inverse() const {
    const Lanes one_over = 1.0 / (xx * yy - xy * yx);
    return {one_over * yy, -one_over * xy, -one_over * yx, one_over * xx};
  }
  Gradient transpose() const { return {xx, yx, xy, yy}; }
  Gradient operator*(const Gradient& b) const {
    return {xx * b.xx + xy * b.yx, xx * b.xy + xy * b.yy, yx * b.xx + yy * b.yx, yx * b.xy + yy * b.yy};
  }
};
inline Gradient load_gradient(const Points& p, std::size_t first) {
  return {load(&p.F_xx[first]), load(&p.F_xy[first]), load(&p.F_yx[first]), load(&p.F_yy[first])};
}
inline void store_gradient(Points& p, std::size_t first, const Gradient& F) {
  store(&p.F_xx[first], F.xx);
  store(&p.F_xy[first], F.xy);
  store(&p.F_yx[first], F.yx);
  store(&p.F_yy[first], F.yy);
}

/// Calls visit(law, points, first point) for every batch of a body.
template <class Visit>
void each_batch(const Body& body, Visit&& visit) {
  std::visit(
      [&](const auto& law) {
        for (std::size_t first = 0; first < body.points.size(); first += lane_count)
          visit(law, load_points(body.points, first), first);
      },
      body.law);
}

/// Temperatures of all points, K; of a body that has them.
inline Array temperatures(const Body& body) {
  Array all = body.points.temperature;
  each_batch(body, [&](const auto& law, const laws::BodyPoints& points, std::size_t first) {
    if constexpr (requires { law.warming(points); }) store(&all[first], points.temperature + law.warming(points));
  });
  return all;
}

inline double density_of(const Body& body) {
  return std::visit([](const auto& law) { return law.mass_density(); }, body.law);
}

/// 1/2 A D B^T of eight points, of gradients row by row: with A = B = C the kinetic energy per mass of points whose
/// velocity has the gradient C.
inline Lanes affine_energy(const std::array<Lanes, 4>& A, const std::array<Lanes, 4>& B, Lanes spread_x,
                           Lanes spread_y) {
  return 0.5 * ((A[0] * B[0] + A[2] * B[2]) * spread_x + (A[1] * B[1] + A[3] * B[3]) * spread_y);
}

}  // namespace kerf::forward::bodies
