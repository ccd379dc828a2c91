#include "forward/bodies/closed_form.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::forward::bodies {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

bool reads(const Scene& scene, Measure what) {
  return std::find(scene.measures.begin(), scene.measures.end(), what) != scene.measures.end();
}

/// A column from `value(reading, first reading of its stroke, stroke)`.
template <class Value>
std::vector<double> along_strokes(const BodiesResult& result, const Scene& scene, const Value& value) {
  std::vector<double> column;
  const Reading* first = &result.history.front();
  for (const Reading& reading : result.history) {
    column.push_back(value(reading, *first, scene.strokes[reading.stroke]));
    const std::size_t i = column.size() - 1;
    if (std::find(result.stroke_ends.begin(), result.stroke_ends.end(), i) != result.stroke_ends.end())
      first = &reading;
  }
  return column;
}

void gas(const laws::IdealGas& law, const BodiesResult& result, const Scene& scene, ClosedForms& all) {
  // Kirchhoff's stress is -p V over the first volume.
  const auto adiabatic = [&](const Reading& now, const Reading& first) {
    return std::pow(first.length / now.length, law.heat_ratio - 1.0);
  };
  all["stress_xx"] = along_strokes(result, scene, [&](const Reading& now, const Reading& first, const Stroke& stroke) {
    return first.stress_xx * (stroke.heat == Heat::adiabatic ? adiabatic(now, first) : 1.0);
  });
  all["temperature"] =
      along_strokes(result, scene, [&](const Reading& now, const Reading& first, const Stroke& stroke) {
        return first.temperature * (stroke.heat == Heat::adiabatic ? adiabatic(now, first) : 1.0);
      });
}

void rubber(const laws::IdealRubber& law, const BodiesResult& result, const Scene& scene, ClosedForms& all) {
  all["temperature"] =
      along_strokes(result, scene, [&](const Reading& now, const Reading& first, const Stroke& stroke) {
        if (stroke.heat != Heat::adiabatic) return stroke.temperature;
        const double work = rubber_work(law, now.length / scene.length) - rubber_work(law, first.length / scene.length);
        return first.temperature * std::exp(work / (law.heat_capacity() * law.reference));
      });
}

void metal(const laws::MieGruneisen& law, const BodiesResult& result, const Scene& scene, ClosedForms& all) {
  if (result.history.back().plastic_work > 0.0) return;
  all["temperature"] =
      along_strokes(result, scene, [&](const Reading& now, const Reading& first, const Stroke& stroke) {
        if (stroke.heat != Heat::adiabatic) return stroke.temperature;
        return first.temperature * std::exp(-law.gruneisen * (now.length - first.length) / scene.length);
      });
}

}  // namespace

double rubber_work(const laws::IdealRubber& law, double lambda) {
  return law.thin ? law.C_1 * (lambda * lambda + 2.0 / lambda - 3.0) +
                        law.C_2 * (2.0 * lambda + 1.0 / (lambda * lambda) - 3.0)
                  : (law.C_1 + law.C_2) * (lambda * lambda + 1.0 / (lambda * lambda) - 2.0);
}

double bar_modulus(const laws::BodyLaw& law, bool held_across) {
  return std::visit(
      [&](const auto& body) {
        if constexpr (requires { body.law.lame(); })
          return held_across ? body.law.lame() + 2.0 * body.law.shear_modulus() : body.law.plane_strain_modulus();
        else
          return unknown;
      },
      law);
}

bool is_held_across(const Scene& scene) {
  return scene.walls[top] == Wall::roller && scene.walls[bottom] == Wall::roller;
}

double volume_of(const Shape& shape, double cell) {
  double volume = 0;
  for (const Part& part : divide(shape, 0.25 * cell, 0.25 * cell)) volume += part.volume;
  return volume;
}

LayeredModulus layered_modulus(const Scene& scene, double strain) {
  // Layers: Reuss across, Voigt along, and between them the shear, 1/G - 2 nu/E = 2/E.
  double volume = 0, reuss = 0, voigt = 0;
  for (const BodyPlan& body : scene.bodies) {
    const double modulus = bar_modulus(body.law, is_held_across(scene)), part = volume_of(body.shape, scene.cell);
    volume += part;
    reuss += part / modulus;
    voigt += part * modulus;
  }
  reuss /= volume;
  voigt /= volume;
  double length = 0, cc = 0;
  if (scene.bodies.size() == 2)
    for (const EdgePiece& piece : common_edge(scene.bodies[0].shape, scene.bodies[1].shape, scene.cell / 16)) {
      length += piece.length;
      cc += piece.length * piece.normal_x * piece.normal_x;
    }
  cc = length > 0.0 ? std::min(cc / length, 1.0) : 1.0;
  const double ss = 1.0 - cc;
  double compliance = (cc * cc + 2.0 * cc * ss) * reuss + ss * ss / voigt;
  LayeredModulus found{.volume = volume,
                       .perfect = 1.0 / compliance,
                       .glued = 1.0 / compliance,
                       .normal_stiffness = unknown,
                       .angle = std::acos(std::sqrt(cc))};
  if (scene.interface) {
    found.normal_stiffness = strain < 0.0 ? scene.interface->compressive : scene.interface->normal;
    compliance += length / volume * (cc * cc / found.normal_stiffness + cc * ss / scene.interface->tangential);
    found.glued = 1.0 / compliance;
  }
  return found;
}

double standing_wave_frequency(const Scene& scene) {
  const BodyPlan& bar = scene.bodies.front();
  const double density = std::visit([](const auto& law) { return law.mass_density(); }, bar.law);
  return std::sqrt(bar_modulus(bar.law, is_held_across(scene)) / density) / bar.wavelength;
}

ClosedForms closed_forms(const BodiesResult& result, const Scene& scene) {
  ClosedForms all;
  if (result.history.empty()) return all;
  if (scene.bodies.size() == 1) {
    const laws::BodyLaw& law = scene.bodies.front().law;
    if (const auto* of = std::get_if<laws::IdealGas>(&law)) gas(*of, result, scene, all);
    if (const auto* of = std::get_if<laws::IdealRubber>(&law)) rubber(*of, result, scene, all);
    if (const auto* of = std::get_if<laws::MieGruneisen>(&law)) metal(*of, result, scene, all);
  }
  if (reads(scene, Measure::modulus)) {
    const LayeredModulus modulus = layered_modulus(scene, result.history.back().length / scene.length - 1.0);
    all["force"] = along_strokes(result, scene, [&](const Reading& now, const Reading&, const Stroke&) {
      return modulus.glued * (now.length / scene.length - 1.0) * modulus.volume / scene.length;
    });
  }
  if (reads(scene, Measure::vibration) && scene.bodies.front().wavelength > 0.0) {
    const double omega = 2.0 * std::numbers::pi * standing_wave_frequency(scene);
    all["kinetic"] = along_strokes(result, scene, [&](const Reading& now, const Reading&, const Stroke&) {
      return now.start_kinetic * std::pow(std::cos(omega * now.time), 2);
    });
  }
  return all;
}

}  // namespace kerf::forward::bodies
