#include "forward/bodies/strain.hpp"

#include <cmath>

#include "forward/bodies/batch.hpp"
#include "forward/bodies/walls.hpp"
#include "forward/mpm/stencil.hpp"

namespace kerf::forward::bodies {
namespace {

using laws::BodyPoints;

/// The heat of a step in which the deformation has changed the entropy by `configuration` at constant temperature:
/// dS = c d(ln T) + configuration. Without a bath dS = 0. With one the temperature decays to the bath's.
template <laws::ThermalLaw Law>
void exchange_heat(const Law& law, const Stroke& stroke, double step, Lanes configuration, Lanes volume,
                   BodyPoints& points, HeatBook& book) {
  const double c = law.heat_capacity();
  const Lanes before = points.temperature;
  points.temperature *= each_lane(configuration, [c](double ds) { return std::exp(-ds / c); });
  if (stroke.heat != Heat::isothermal) return;
  const double keep = stroke.exchange_time > 0.0 ? std::exp(-step / stroke.exchange_time) : 0.0;
  points.temperature = stroke.temperature + keep * (points.temperature - stroke.temperature);
  const Lanes entropy =
      configuration + c * each_lane(points.temperature / before, [](double ratio) { return std::log(ratio); });
  const double heat = sum(volume * 0.5 * (before + points.temperature) * entropy);
  book.heat += heat;
  book.entropy += heat / stroke.temperature;
}

/// Adds the internal forces of eight points. The stress that goes with gradients in X is the nominal one,
/// P = tau F^-T.
template <Frame frame, class Shape>
[[gnu::always_inline]] inline void add_forces(const Grid& grid, const StencilOf<Shape>& stencil, Lanes volume,
                                              const Gradient& tau, const Gradient& F, VelocityField& field) {
  const Gradient P = frame == Frame::current ? tau : tau * F.inverse().transpose();
  const Lanes along = -grid.inverse_cell_x * volume, across = -grid.inverse_cell_y * volume;
  std::array<Lanes, 6> by_weight, by_slope;
  for (std::size_t i = 0; i < 3; ++i) {
    by_weight[2 * i] = stencil.slope_x[i] * along * P.xx;
    by_weight[2 * i + 1] = stencil.slope_x[i] * along * P.yx;
    by_slope[2 * i] = stencil.weight_x[i] * across * P.xy;
    by_slope[2 * i + 1] = stencil.weight_x[i] * across * P.yy;
  }
  stencil.add(field.force.data(), by_weight, by_slope);
}

/// Deformation and stress after a time `step` with these nodal velocities; and, if asked, the internal forces.
template <Frame frame, bool with_forces, class Shape, class Law>
void strain_points(State& state, Body& body, const Law& law, const Stroke& stroke, const Shape& shape,
                   const Array& velocity, double step) {
  Points& p = body.points;
  const Grid& grid = state.grid;
  const double strain_x = step * grid.inverse_cell_x, strain_y = step * grid.inverse_cell_y;
  bool sound = true;
  for (std::size_t first = 0; first < p.size(); first += lane_count) {
    const StencilOf<Shape> stencil(grid, load(&p.kernel_x(frame)[first]), load(&p.kernel_y(frame)[first]), shape);
    const auto [xx, xy, yx, yy] = stencil.gradient(velocity.data());
    const Gradient F = load_gradient(p, first);
    // dt dv/dX = dF, or dt dv/dx = l; dF = l F.
    const Gradient rate{strain_x * xx, strain_y * xy, strain_x * yx, strain_y * yy};
    const Gradient dF = frame == Frame::current ? rate * F : rate;
    const Gradient dx = frame == Frame::current ? rate : rate * F.inverse();
    const laws::StrainIncrement l{.xx = dx.xx, .xy = dx.xy, .yx = dx.yx, .yy = dx.yy};
    const Gradient now{F.xx + dF.xx, F.xy + dF.xy, F.yx + dF.yx, F.yy + dF.yy};
    store_gradient(p, first, now);
    const Lanes volume = load(&p.volume[first]);
    BodyPoints points = load_points(p, first);
    if constexpr (Law::is_thermal) {
      const Lanes before = law.configurational_entropy(points);
      law.deform(l, points);
      exchange_heat(law, stroke, step, law.configurational_entropy(points) - before, volume, points, state.bath);
      sound &= law.find_stress(points);
      points.temperature += points.heating / law.heat_capacity();
    } else {
      law.deform(l, points);
      sound &= law.find_stress(points);
    }
    store_points(p, first, points);
    if constexpr (with_forces)
      add_forces<frame>(grid, stencil, volume, {points.xx, points.xy, points.xy, points.yy}, now, body.field);
  }
  if (!sound && state.breakdown.empty())
    state.breakdown = "a body lost its volume, its temperature, or the return to its yield surface";
}

/// Every body with the velocities that `velocity_of(its field)` names.
template <bool with_forces, class VelocityOf>
void strain_bodies(State& state, const Scene& scene, const Stroke& stroke, double step, VelocityOf&& velocity_of) {
  for (Body& body : state.bodies) {
    const Array& velocity = velocity_of(body.field);
    const auto strain_with = [&](const auto& shape, const auto& law) {
      if (frame_of(scene) == Frame::current)
        strain_points<Frame::current, with_forces>(state, body, law, stroke, shape, velocity, step);
      else
        strain_points<Frame::reference, with_forces>(state, body, law, stroke, shape, velocity, step);
    };
    std::visit(strain_with, scene.numerics.shape, body.law);
  }
}

/// Internal forces of the stresses as they are.
template <Frame frame, class Shape>
void push_nodes(const State& state, Body& body, const Shape& shape) {
  const Points& p = body.points;
  for (std::size_t i = 0; i < p.size(); i += lane_count) {
    const Lanes xy = load(&p.stress_xy[i]);
    add_forces<frame>(
        state.grid, StencilOf<Shape>(state.grid, load(&p.kernel_x(frame)[i]), load(&p.kernel_y(frame)[i]), shape),
        load(&p.volume[i]), {load(&p.stress_xx[i]), xy, xy, load(&p.stress_yy[i])}, load_gradient(p, i), body.field);
  }
}

}  // namespace

void strain(State& state, const Scene& scene, const Stroke& stroke, double step, bool with_forces) {
  const auto gathered = [&](VelocityField& field) -> const Array& {
    mirror_velocity(state, scene, field);
    return field.velocity;
  };
  if (with_forces)
    strain_bodies<true>(state, scene, stroke, step, gathered);
  else
    strain_bodies<false>(state, scene, stroke, step, gathered);
}

void strain_last(State& state, const Scene& scene, const Stroke& stroke) {
  strain_bodies<false>(state, scene, stroke, state.step, [&](VelocityField& field) -> const Array& {
    mirror_change(state, scene, field);
    field.filtered = field.velocity;
    for (std::size_t k = 0; k < field.filtered.size(); ++k) field.filtered[k] += field.change[k];
    return field.filtered;
  });
}

void push(State& state, const Scene& scene) {
  for (Body& body : state.bodies) {
    mirror_velocity(state, scene, body.field);
    std::visit(
        [&](const auto& shape) {
          if (frame_of(scene) == Frame::current)
            push_nodes<Frame::current>(state, body, shape);
          else
            push_nodes<Frame::reference>(state, body, shape);
        },
        scene.numerics.shape);
  }
}

void find_stress(State& state) {
  for (Body& body : state.bodies)
    each_batch(body, [&](const auto& law, BodyPoints points, std::size_t first) {
      if (!law.find_stress(points)) state.breakdown = "a body has no stress where it starts";
      store_points(body.points, first, points);
    });
}

}  // namespace kerf::forward::bodies
