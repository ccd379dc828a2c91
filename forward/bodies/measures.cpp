#include "forward/bodies/measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "forward/bodies/closed_form.hpp"

namespace kerf::forward::bodies {
namespace {

using Json = nlohmann::ordered_json;

/// The readings of a stroke, from the end of the one before.
struct Span {
  std::size_t first, last;
};
Span span_of(const BodiesResult& result, std::size_t stroke) {
  return {stroke == 0 ? 0 : result.stroke_ends[stroke - 1], result.stroke_ends[stroke]};
}

double change(const BodiesResult& result, std::size_t stroke, double Reading::*of) {
  const Span span = span_of(result, stroke);
  return result.history[span.last].*of - result.history[span.first].*of;
}

void cycle(const BodiesResult& result, const Scene& scene, Json& json) {
  double hot = 0, cold = 1e300;
  for (const Stroke& stroke : scene.strokes)
    if (stroke.heat == Heat::isothermal) {
      hot = std::max(hot, stroke.temperature);
      cold = std::min(cold, stroke.temperature);
    }
  double taken = 0, entropy = 0, hot_entropy = 0;
  for (std::size_t s = 0; s < scene.strokes.size(); ++s) {
    if (scene.strokes[s].heat != Heat::isothermal) continue;
    const double heat = change(result, s, &Reading::heat), from = change(result, s, &Reading::bath_entropy);
    entropy += from;
    if (scene.strokes[s].temperature < hot) continue;
    taken += heat;
    hot_entropy += from;
  }
  const Reading& end = result.history.back();
  json["efficiency"] = -end.piston_work / taken;
  json["carnot_efficiency"] = 1.0 - cold / hot;
  json["net_entropy_ratio"] = std::abs(entropy / hot_entropy);
  json["closing_temperature_error"] = end.temperature / result.history.front().temperature - 1.0;
  json["closing_length_error"] = end.length / scene.length - 1.0;
  json["heat_taken"] = taken;
  json["work_given"] = -end.piston_work;
  const auto* metal = std::get_if<laws::MieGruneisen>(&scene.bodies.front().law);
  if (metal && end.plastic_work > 0.0) {
    // Yielding makes entropy in every stroke: beta dW_p/T, between beta W_p/T_h and beta W_p/T_c.
    const double made = end.entropy - end.bath_entropy;
    json["plastic_work"] = end.plastic_work;
    json["entropy_made"] = made;
    json["entropy_made_by_yielding"] = metal->taylor_quinney * end.plastic_work / (0.5 * (hot + cold));
    json["work_lost"] = cold * made;
    json["net_heat_given_off"] = -end.heat;
  }
  const auto* gas = std::get_if<laws::IdealGas>(&scene.bodies.front().law);
  if (!gas || scene.bodies.size() != 1) return;
  // p V is -tau, and so is what theory says of it.
  const std::vector<double> expected = closed_forms(result, scene).at("stress_xx");
  double worst = 0;
  for (std::size_t s = 0; s < scene.strokes.size(); ++s) {
    if (scene.strokes[s].heat != Heat::adiabatic) continue;
    const Span span = span_of(result, s);
    for (std::size_t i = span.first + 1; i <= span.last; ++i)
      worst = std::max(worst, std::abs(result.history[i].stress_xx / expected[i] - 1.0));
  }
  json["pv_gamma_error"] = worst;
}

void expansion(const BodiesResult& result, const Scene&, Json& json) {
  json["first_step_temperature_change"] = result.first_step_temperature_change;
  double least = 1e300, most = 0;
  for (const Reading& r : result.history) {
    least = std::min(least, r.temperature);
    most = std::max(most, r.temperature);
  }
  json["lowest_temperature"] = least;
  json["highest_temperature"] = most;
}

template <class Function>
double slope_of(const Function& f, double at) {
  constexpr double step = 1e-5;
  return (f(at + step) - f(at - step)) / (2 * step);
}

/// Mean nominal stress at a stretch that the stroke passes, between readings.
double nominal_stress(const BodiesResult& result, std::size_t stroke, double stretch) {
  const Span span = span_of(result, stroke);
  const double length = stretch * result.history.front().length;
  std::size_t i = span.first + 1;
  while (i < span.last && result.history[i].length < length) ++i;
  const Reading &a = result.history[i - 1], &b = result.history[i];
  const auto nominal = [&](const Reading& r) { return r.stress_xx * result.history.front().length / r.length; };
  const double t = (length - a.length) / (b.length - a.length);
  return nominal(a) + t * (nominal(b) - nominal(a));
}

void rubber(const BodiesResult& result, const Scene& scene, Json& json) {
  const auto* law = std::get_if<laws::IdealRubber>(&scene.bodies.front().law);
  if (!law) return;
  json["heat_over_work"] = -change(result, 0, &Reading::heat) / change(result, 0, &Reading::piston_work);
  json["entropy_over_heat"] =
      change(result, 0, &Reading::entropy) * scene.strokes[0].temperature / change(result, 0, &Reading::heat);
  for (std::size_t s = 0; s < scene.strokes.size(); ++s) {
    if (scene.strokes[s].heat != Heat::adiabatic) continue;
    const Span span = span_of(result, s);
    const Reading &begin = result.history[span.first], &end = result.history[span.last];
    const auto w = [&](double lambda) { return rubber_work(*law, lambda); };
    const double c = law->heat_capacity();
    const double from = begin.length / scene.length, to = end.length / scene.length;
    const double expected = begin.temperature * std::exp((w(to) - w(from)) / (c * law->reference));
    json["adiabatic_temperature_rise"] = end.temperature - begin.temperature;
    json["adiabatic_temperature_error"] =
        std::abs((end.temperature - begin.temperature) / (expected - begin.temperature) - 1.0);
    // Chords over the second half of the stretch, adiabatic over isothermal: of the simulated curves, and of
    // P = T/T_0 dw/dlambda.
    const double middle = 0.5 * (from + to);
    const double simulated_chord = nominal_stress(result, s, to) - nominal_stress(result, s, middle);
    const double isothermal_chord = nominal_stress(result, 0, to) - nominal_stress(result, 0, middle);
    json["adiabatic_over_isothermal_modulus"] = simulated_chord / isothermal_chord;
    const auto adiabatic = [&](double lambda) {
      return begin.temperature * std::exp((w(lambda) - w(from)) / (c * law->reference)) * slope_of(w, lambda);
    };
    const double bath = scene.strokes[0].temperature;
    json["adiabatic_over_isothermal_modulus_closed_form"] =
        (adiabatic(to) - adiabatic(middle)) / (bath * (slope_of(w, to) - slope_of(w, middle)));
    return;
  }
}

void modulus(const BodiesResult& result, const Scene& scene, Json& json) {
  // Mean over the last half of the last stroke, in which the waves of the loading have died away.
  const Span span = span_of(result, scene.strokes.size() - 1);
  const double middle = 0.5 * (result.history[span.first].time + result.history[span.last].time);
  double impulse = 0, duration = 0;
  for (std::size_t i = span.first + 1; i <= span.last; ++i) {
    if (result.history[i].time < middle) continue;
    const double step = result.history[i].time - result.history[i - 1].time;
    impulse += result.history[i].force * step;
    duration += step;
  }
  const double strain = result.history.back().length / scene.length - 1.0;
  const LayeredModulus expected = layered_modulus(scene, strain);
  const double found = impulse / duration / (expected.volume / scene.length) / strain;
  json["effective_modulus"] = found;
  json["perfect_modulus"] = expected.perfect;
  if (scene.interface) {
    json["interface_stiffness"] = expected.normal_stiffness;
    json["interface_angle"] = expected.angle * 180.0 / std::numbers::pi;
  }
  json["closed_form_modulus"] = expected.glued;
  json["effective_modulus_error"] = std::abs(found / expected.glued - 1.0);
}

void sliding(const BodiesResult& result, const Scene& scene, Json& json) {
  if (!scene.gravity || scene.rigids.empty()) return;
  const double c = std::cos(scene.rigids[0].shape.angle), s = std::sin(scene.rigids[0].shape.angle);
  const double along = c * scene.gravity->x + s * scene.gravity->y;
  const double press = s * scene.gravity->x - c * scene.gravity->y;
  const double mu = scene.contact->friction;
  const double expected = std::copysign(std::max(0.0, std::abs(along) - mu * std::max(press, 0.0)), along);
  const Span span = span_of(result, scene.strokes.size() - 1);
  // Slope of the line through the readings.
  double n = 0, t = 0, v = 0, tt = 0, tv = 0;
  for (std::size_t i = (span.first + span.last) / 2; i <= span.last; ++i) {
    const Reading& r = result.history[i];
    const double speed = c * r.velocity_x + s * r.velocity_y;
    n += 1.0;
    t += r.time;
    v += speed;
    tt += r.time * r.time;
    tv += r.time * speed;
  }
  const double found = (n * tv - t * v) / (n * tt - t * t);
  const double g = std::hypot(scene.gravity->x, scene.gravity->y);
  json["acceleration"] = found / 1e3;
  json["closed_form_acceleration"] = expected / 1e3;
  json["acceleration_error"] = std::abs(found - expected) / g;
}

void wedge(const BodiesResult& result, const Scene& scene, Json& json) {
  if (scene.rigids.empty() || !scene.rigids[0].shape.slab) return;
  const RigidPlan& rigid = scene.rigids[0];
  const double speed = std::hypot(rigid.velocity_x, rigid.velocity_y);
  const Place way{rigid.velocity_x / speed, rigid.velocity_y / speed};
  const auto along = [&](const Place& f) { return f.x * way.x + f.y * way.y; };
  const auto across = [&](const Place& f) { return std::abs(f.y * way.x - f.x * way.y); };
  // The wedge lies to the left of its face; what slides on it is dragged the way that the wedge goes.
  const Place face{std::cos(rigid.shape.slab->angle), std::sin(rigid.shape.slab->angle)};
  const double drag = scene.contact->friction * (along(face) > 0.0 ? 1.0 : -1.0);
  const Place expected{face.y + drag * face.x, -face.x + drag * face.y};
  const Span span = span_of(result, scene.strokes.size() - 1);
  const double middle = 0.5 * (result.history[span.first].time + result.history[span.last].time);
  double n = 0, t = 0, f = 0, g = 0, tt = 0, tf = 0, ff = 0;
  for (std::size_t i = span.first + 1; i <= span.last; ++i) {
    const Reading& r = result.history[i];
    if (r.time < middle) continue;
    const Place force{r.rigid_force_x, r.rigid_force_y};
    const double time = r.time - middle;
    n += 1.0;
    t += time;
    f += along(force);
    g += across(force);
    tt += time * time;
    tf += time * along(force);
    ff += along(force) * along(force);
  }
  const double slope = (n * tf - t * f) / (n * tt - t * t);
  const double scatter = (ff - f * f / n) / n - slope * slope * (tt - t * t / n) / n;
  const double closed_form = across(expected) / along(expected);
  json["force_along"] = f / n;
  json["force_across"] = g / n;
  json["force_ratio"] = g / f;
  json["closed_form_force_ratio"] = closed_form;
  json["force_ratio_error"] = std::abs(g / f / closed_form - 1.0);
  json["force_noise"] = std::sqrt(std::max(scatter, 0.0)) / (f / n);
}

void rubbing(const BodiesResult& result, const Scene& scene, Json& json) {
  if (scene.bodies.size() != 2) return;
  const BodyPlan &a = scene.bodies[0], &b = scene.bodies[1];
  const double volume_a = volume_of(a.shape, scene.cell), volume_b = volume_of(b.shape, scene.cell);
  const auto density = [](const BodyPlan& body) {
    return std::visit([](const auto& law) { return law.mass_density(); }, body.law);
  };
  const double mass_a = volume_a * density(a), mass_b = volume_b * density(b);
  const double w = std::hypot(b.velocity_x - a.velocity_x, b.velocity_y - a.velocity_y);
  const double heat = 0.5 * mass_a * mass_b / (mass_a + mass_b) * w * w;
  const Reading &start = result.history.front(), &end = result.history.back();
  json["friction_heat"] = end.friction_heat;
  json["closed_form_friction_heat"] = heat;
  json["friction_heat_error"] = std::abs(end.friction_heat / heat - 1.0);
  const double c_a = laws::heat_capacity(a.law), c_b = laws::heat_capacity(b.law);
  if (c_a == 0.0 || c_b == 0.0) return;
  const double warming = 0.5 * heat * (1.0 / c_a + 1.0 / c_b) / (volume_a + volume_b);
  json["warming"] = end.temperature - start.temperature;
  json["closed_form_warming"] = warming;
  json["warming_error"] = std::abs((end.temperature - start.temperature) / warming - 1.0);
}

void hertz(const BodiesResult& result, const Scene& scene, Json& json) {
  double compliance = 0, curvature = 0, axis = 0;
  for (const BodyPlan& body : scene.bodies) compliance += 1.0 / bar_modulus(body.law, false);
  const auto add = [&](const Shape& shape) {
    if (!shape.disc) return;
    curvature += 1.0 / shape.disc->radius;
    axis = shape.disc->x;
  };
  for (const BodyPlan& body : scene.bodies) add(body.shape);
  for (const RigidPlan& rigid : scene.rigids) add(rigid.shape);
  if (curvature == 0.0 || result.pressed.empty()) return;
  const bool halved = axis == 0.0 && scene.walls[left] == Wall::roller;
  const double cell = scene.length / static_cast<double>(std::lround(scene.length / scene.cell));
  double sum = 0, moment = 0;
  for (const BodiesResult::Pressure& node : result.pressed) {
    sum += node.force;
    moment += node.force * (node.x - axis) * (node.x - axis);
  }
  // A kernel spreads each force by a quarter of a cell squared.
  const double half_width = 2.0 * std::sqrt(std::max(moment / sum - 0.25 * cell * cell, 0.0));
  const double force = halved ? 2.0 * sum : sum;
  const double expected_width = std::sqrt(4.0 * force * compliance / (std::numbers::pi * curvature));
  const double expected_peak = std::sqrt(force * curvature / (std::numbers::pi * compliance));
  // Over |x| < u a the mean pressure is (u sqrt(1 - u^2) + asin u)/(2 u) of the peak.
  const double inner = std::max(1.0, std::floor(0.5 * expected_width / cell)) * cell, u = inner / expected_width;
  double carried = 0;
  for (const BodiesResult::Pressure& node : result.pressed)
    if (std::abs(node.x - axis) < inner) carried += node.force;
  const double mean = carried / (halved ? inner : 2.0 * inner);
  const double peak = mean * 2.0 * u / (u * std::sqrt(1.0 - u * u) + std::asin(u));
  json["force"] = force;
  json["half_width"] = half_width;
  json["closed_form_half_width"] = expected_width;
  json["half_width_error"] = std::abs(half_width / expected_width - 1.0);
  json["peak_pressure"] = peak;
  json["closed_form_peak_pressure"] = expected_peak;
  json["peak_pressure_error"] = std::abs(peak / expected_peak - 1.0);
  json["cells_in_half_width"] = expected_width / cell;
}

/// A bar that begins as a standing wave, read between the crossings of its centre's velocity.
void vibration(const BodiesResult& result, const Scene& scene, Json& json) {
  const BodyPlan& bar = scene.bodies.front();
  if (!(bar.wavelength > 0.0)) return;
  std::vector<double> crossings;
  for (std::size_t i = 1; i < result.history.size(); ++i) {
    const Reading &a = result.history[i - 1], &b = result.history[i];
    if ((a.velocity_x > 0.0) == (b.velocity_x > 0.0)) continue;
    crossings.push_back(a.time + (b.time - a.time) * a.velocity_x / (a.velocity_x - b.velocity_x));
  }
  if (crossings.size() < 2) return;
  const double found = 0.5 * static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
  const double expected = standing_wave_frequency(scene);
  const Reading& end = result.history.back();
  json["frequency"] = found;
  json["closed_form_frequency"] = expected;
  json["frequency_error"] = std::abs(found / expected - 1.0);
  json["energy_error"] = std::abs((end.kinetic + end.internal) / end.start_kinetic - 1.0);
}

}  // namespace

Json measure(const BodiesResult& result, const Scene& scene) {
  Json json = Json::object();
  for (const Measure what : scene.measures) switch (what) {
      case Measure::cycle:
        cycle(result, scene, json);
        break;
      case Measure::expansion:
        expansion(result, scene, json);
        break;
      case Measure::rubber:
        rubber(result, scene, json);
        break;
      case Measure::modulus:
        modulus(result, scene, json);
        break;
      case Measure::sliding:
        sliding(result, scene, json);
        break;
      case Measure::wedge:
        wedge(result, scene, json);
        break;
      case Measure::rubbing:
        rubbing(result, scene, json);
        break;
      case Measure::vibration:
        vibration(result, scene, json);
        break;
      case Measure::hertz:
        hertz(result, scene, json);
        break;
    }
  return json;
}

}  // namespace kerf::forward::bodies
