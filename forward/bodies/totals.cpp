#include "forward/bodies/totals.hpp"

#include <cmath>

#include "forward/bodies/batch.hpp"

namespace kerf::forward::bodies {
namespace {

/// What gradients of the points' velocities add.
void add_affine_part(const Points& p, std::size_t first, Lanes mass, Frame frame, Totals& all) {
  const std::array<Lanes, 4> C{load(&p.affine.xx[first]), load(&p.affine.xy[first]), load(&p.affine.yx[first]),
                               load(&p.affine.yy[first])};
  const Lanes spread_x = load(&p.affine.spread_x[first]), spread_y = load(&p.affine.spread_y[first]);
  all.kinetic += sum(mass * affine_energy(C, C, spread_x, spread_y));
  const Gradient F =
      frame == Frame::current ? Gradient{all_lanes(1.0), {}, {}, all_lanes(1.0)} : load_gradient(p, first);
  all.angular_momentum += sum(mass * ((F.xx * C[2] - F.yx * C[0]) * spread_x + (F.xy * C[3] - F.yy * C[1]) * spread_y));
}

}  // namespace

Totals totals(const State& state) {
  Totals all;
  double heated = 0.0;
  for (const Body& body : state.bodies) {
    const Points& p = body.points;
    each_batch(body, [&](const auto& law, const laws::BodyPoints& points, std::size_t first) {
      const Lanes volume = load(&p.volume[first]), vx = load(&p.velocity_x[first]), vy = load(&p.velocity_y[first]);
      all.volume += sum(volume);
      all.mass += law.mass_density() * sum(volume);
      all.momentum_x += law.mass_density() * sum(volume * vx);
      all.momentum_y += law.mass_density() * sum(volume * vy);
      const Lanes x = load(&p.x[first]), y = load(&p.y[first]);
      all.moment_x += law.mass_density() * sum(volume * x);
      all.moment_y += law.mass_density() * sum(volume * y);
      all.angular_momentum += law.mass_density() * sum(volume * (x * vy - y * vx));
      all.kinetic += 0.5 * law.mass_density() * sum(volume * (vx * vx + vy * vy));
      if (!p.affine.xx.empty()) add_affine_part(p, first, law.mass_density() * volume, state.frame, all);
      all.internal += sum(volume * law.energy(points));
      all.stress_xx += sum(volume * points.xx);
      all.stress_yy += sum(volume * points.yy);
      if (!body.is_thermal()) return;
      heated += sum(volume);
      Lanes T = points.temperature;
      if constexpr (requires { law.warming(points); }) T += law.warming(points);
      all.temperature += sum(volume * T);
      if constexpr (requires { law.plastic_work(points); }) all.plastic_work += sum(volume * law.plastic_work(points));
      Lanes entropy = law.heat_capacity() * each_lane(T, [](double at) { return std::log(at); });
      if constexpr (std::decay_t<decltype(law)>::is_thermal) entropy += law.configurational_entropy(points);
      all.entropy += sum(volume * entropy);
    });
  }
  all.stress_xx /= all.volume;
  all.stress_yy /= all.volume;
  if (heated > 0.0) all.temperature /= heated;
  return all;
}

}  // namespace kerf::forward::bodies
