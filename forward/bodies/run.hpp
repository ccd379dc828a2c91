#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "forward/bodies/scene.hpp"

namespace kerf::forward::bodies {

/// One reading; per unit width: N/mm, N mm/mm, N mm/(mm K).
struct Reading {
  std::size_t stroke;
  double time;                                      ///< s
  double length;                                    ///< of the box, mm
  double force;                                     ///< of the piston on the bodies, +x, mean since the last reading
  double temperature;                               ///< mean, K
  double stress_xx, stress_yy;                      ///< mean Kirchhoff stress, MPa
  double piston_work, heat, bath_entropy, entropy;  ///< since the start; entropy: of the bodies
  double internal, kinetic, damping, interface;     ///< internal: its change since the start
  double start_kinetic;
  double plastic_work;  ///< of thermal bodies since the start; in internal as heat and stored energy
  double gravity_work, rigid_work, friction_heat, impact;  ///< since the start; zero without gravity and contact
  double warmed;                        ///< part of friction_heat that is in the bodies' internal energy
  double velocity_x, velocity_y;        ///< of the bodies' centre of mass, mm/s
  double rigid_force_x, rigid_force_y;  ///< of the first rigid body on the others, mean since the last reading
  double supplied() const { return piston_work + heat + gravity_work + rigid_work + start_kinetic; }
  double residue() const {
    return supplied() - internal - kinetic - damping - interface - (friction_heat - warmed) - impact;
  }
};

struct BodiesResult {
  std::vector<Reading> history;
  std::vector<std::size_t> stroke_ends;      ///< readings at which strokes ended
  double first_step_temperature_change = 0;  ///< K
  bool accepted = false;
  std::vector<std::string> refusals;
  std::int64_t steps = 0, particle_steps = 0;
  double wall_seconds = 0;
  double processor_seconds = 0;  ///< of the thread that simulates
  std::size_t particles = 0;
  struct Pressure {
    double x, y, force;  ///< of a node, mm; N/mm, mean over the last half of the last stroke
  };
  std::vector<Pressure> pressed;    ///< where bodies touched
  nlohmann::ordered_json measures;  ///< what the scene is for, name to number
};

/// Runs all strokes. Thread-safe and deterministic. `progress` is told the stroke and the stretch now and then; false
/// stops the run, which is then refused as "interrupted".
BodiesResult run(const Scene& scene, const std::function<bool(std::size_t stroke, double stretch)>& progress = {});

/// What the run took.
nlohmann::ordered_json cost_json(const BodiesResult& result);

/// The result as `kerf simulate --json` prints it.
nlohmann::ordered_json result_json(const BodiesResult& result, const Scene& scene);

}  // namespace kerf::forward::bodies
