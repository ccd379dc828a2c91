#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "forward/bodies/step.hpp"
#include "forward/bodies/totals.hpp"

/// Problems of elastodynamics whose answers are known, for whatever options of the solver.
namespace kerf::forward::bodies {

/// A scene that a test takes through its steps, all of one length.
class Trial {
 public:
  explicit Trial(const std::string& text)
      : scene(read_scene(Document::parse(text, "trial.toml"))),
        state(lay_out(scene)),
        joint(state, scene),
        stages(plan(scene, joint)) {}
  Trial(const Trial&) = delete;

  void step() {
    for (const Stage& stage : stages) {
      const std::clock_t begin = std::clock();
      stage.apply(state, scene.strokes[0]);
      if (stage.name != body_force) seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    }
  }
  /// The body's points that have a volume, by index.
  template <class Visit>
  void each_point(Visit&& visit) const {
    const Points& p = state.bodies[0].points;
    for (std::size_t i = 0; i < p.size(); ++i)
      if (p.volume[i] > 0.0) visit(p, i);
  }

  /// A body force per mass at the nodes, of their place and the time.
  template <class Force>
  void push_with(Force force) {
    const auto after =
        std::find_if(stages.begin(), stages.end(), [](const Stage& stage) { return stage.name == "accelerate"; });
    const auto at = after + 1;
    stages.insert(at, Stage{body_force, "", [force](State& s, const Stroke&) {
                              for (int j = 0; j < s.grid.rows; ++j)
                                for (int i = 0; i < s.grid.columns; ++i) {
                                  const std::size_t node = s.grid.node(i, j);
                                  VelocityField& field = s.bodies[0].field;
                                  if (!(field.mass[node] > 0.0)) continue;
                                  const std::array<double, 2> b =
                                      force({s.grid.origin_x + i * s.grid.cell_x, s.grid.origin_y + j * s.grid.cell_y},
                                            s.time);
                                  for (std::size_t k = 0; k < 2; ++k) field.change[2 * node + k] += s.step * b[k];
                                }
                            }});
  }

  static constexpr const char* body_force = "body force";
  double seconds = 0;  ///< of CPU time that the solver has taken
  Scene scene;
  State state;
  Joint joint;
  std::vector<Stage> stages;
};

constexpr double trial_modulus = 1000, trial_density = 1e-9;  ///< MPa, tonne/mm^3

/// An elastic body in a box; no wall moves. `options` may hold any blocks.
inline std::string trial_scene(double length, double height, double cell, const std::string& box,
                               const std::string& body, const std::string& options, double poisson_ratio = 0) {
  return fmt::format(
      "title = \"trial\"\nmeasures = []\n[box]\nlength = \"{} mm\"\nheight = \"{} mm\"\ncell = \"{} mm\"\n{}\n"
      "[[body]]\nlaw = \"hencky\"\nelastic_modulus = \"{} MPa\"\npoisson_ratio = {}\ndensity = \"1000 kg/m^3\"\n"
      "yield_stress = \"10000 MPa\"\n{}\n[[stroke]]\nlongest = \"1 ms\"\n{}\n",
      length, height, cell, box, trial_modulus, poisson_ratio, body, options);
}

/// Times at which an amplitude falls through zero, and all energy, that of an interface included, after every step.
struct Oscillation {
  std::vector<double> crossings, energy;
};
inline Oscillation watch(Trial& trial, double until, const std::function<double()>& amplitude) {
  Oscillation seen;
  double before = 0;
  while (trial.state.time < until) {
    trial.step();
    const double now = amplitude();
    if (before > 0.0 && now <= 0.0)
      seen.crossings.push_back(trial.state.time - trial.state.step * now / (now - before));
    before = now;
    const Totals all = totals(trial.state);
    seen.energy.push_back(all.kinetic + all.internal + trial.state.interface_energy);
  }
  return seen;
}

/// How a bar of 10 mm vibrates along itself in its lowest mode: its frequency over the closed form, less one, and what
/// it keeps of its energy over twenty periods. Held at its left end by a wall, at the other by a wall or free.
struct Vibration {
  double frequency_error, energy_kept;
  double energy_swing;  ///< largest departure of kinetic + internal energy from its mean, over that
};
inline Vibration vibrate(int cells, bool free_end, const std::string& options = "", double courant_number = 0.5) {
  constexpr double length = 10;
  const double cell = length / cells, c = std::sqrt(trial_modulus / trial_density);
  const double wavelength = (free_end ? 4 : 2) * length, period = wavelength / c;
  Trial trial(trial_scene(
      length + (free_end ? 4 * cell : 0), 4 * cell, cell, fmt::format("courant_number = {}", courant_number),
      fmt::format("width = \"{} mm\"\nvelocity_x = \"0.1 m/s\"\nwavelength = \"{} mm\"", length, wavelength), options));
  const auto amplitude = [&] {
    double all = 0;
    trial.each_point([&](const Points& p, std::size_t i) {
      all += p.volume[i] * std::sin(2 * std::numbers::pi * p.reference_x[i] / wavelength) * (p.x[i] - p.reference_x[i]);
    });
    return all;
  };
  constexpr int periods = 20;
  const auto [crossings, energy] = watch(trial, (periods + 0.25) * period, amplitude);
  const auto mean = [&](std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += energy[i];
    return sum / static_cast<double>(last - first);
  };
  if (crossings.size() < 2) return {.frequency_error = std::nan(""), .energy_kept = 0, .energy_swing = 1};
  const double found = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  const std::size_t one = energy.size() / periods;
  const double all = mean(0, one);
  double swing = 0;
  for (std::size_t i = 0; i < one; ++i) swing = std::max(swing, std::abs(energy[i] / all - 1));
  return {.frequency_error = period / found - 1,
          .energy_kept = mean(energy.size() - one, energy.size()) / all,
          .energy_swing = swing};
}

/// d'Alembert: a smooth hump of velocity in the middle of a bar at rest falls into two waves. A wall turns the sign of
/// a wave's velocity, a free end does not. Of the wave to the right its speed over c, less one, before it meets the
/// end; and how far all velocities are from their closed form when both waves are halfway back, in the root mean square
/// over that of the hump.
struct Pulse {
  double speed_error, shape_error;
};
inline constexpr double pulse_length = 10, pulse_half_width = 2;
inline Pulse send_pulse(int cells, bool free_end, const std::string& options = "") {
  constexpr double length = pulse_length;
  const double cell = length / cells, c = std::sqrt(trial_modulus / trial_density);
  Trial trial(trial_scene(length + (free_end ? 4 * cell : 0), 4 * cell, cell, "courant_number = 0.4",
                          fmt::format("width = \"{} mm\"", length), options));
  const auto hump = [](double x) {
    const double r = (x - 0.5 * length) / pulse_half_width;
    return std::abs(r) < 1 ? 100 * std::pow(std::cos(0.5 * std::numbers::pi * r), 4) : 0.0;
  };
  // The hump and its images beyond the ends, within a length of the bar.
  const auto image = [&](double x) {
    return x < 0 ? -hump(-x) : x > length ? (free_end ? 1 : -1) * hump(2 * length - x) : hump(x);
  };
  Points& points = trial.state.bodies[0].points;
  for (std::size_t i = 0; i < points.size(); ++i) points.velocity_x[i] = hump(points.reference_x[i]);
  const auto centre = [&] {
    double sum = 0, moment = 0;
    trial.each_point([&](const Points& p, std::size_t i) {
      if (p.reference_x[i] < 0.5 * length) return;
      sum += p.volume[i] * p.velocity_x[i] * p.velocity_x[i];
      moment += p.volume[i] * p.velocity_x[i] * p.velocity_x[i] * p.reference_x[i];
    });
    return moment / sum;
  };
  const auto run_to = [&](double time) {
    while (trial.state.time < time) trial.step();
  };
  run_to(0.22 * length / c);
  const double from = centre(), start = trial.state.time;
  run_to(0.29 * length / c);
  const double speed = (centre() - from) / (trial.state.time - start);
  run_to(0.75 * length / c);
  const double way = c * (trial.state.time + 0.5 * trial.state.step);  // strains, which begin with none, come first
  double off = 0, all = 0;
  trial.each_point([&](const Points& p, std::size_t i) {
    const double x = p.reference_x[i];
    off += p.volume[i] * std::pow(p.velocity_x[i] - 0.5 * (image(x - way) + image(x + way)), 2);
    all += p.volume[i] * hump(x) * hump(x);
  });
  return {.speed_error = speed / c - 1, .shape_error = std::sqrt(off / all)};
}

/// A free square turns once about its middle, at an edge speed of one per cent of the wave speed. Changes over the
/// first values; the largest stress at any time over rho v^2 of the corner.
struct Rotation {
  double angular_momentum, energy, momentum;  ///< momentum: over mass times the corner's speed
  double stress;
  double placed;  ///< how far the points are from where they started, over the side
};
inline Rotation rotate(int cells, const std::string& options = "") {
  constexpr double side = 10;
  const double cell = side / cells, c = std::sqrt(trial_modulus / trial_density);
  const double corner = 0.01 * c, spin = corner / (side / std::numbers::sqrt2);
  Trial trial(trial_scene(2 * side, 2 * side, cell, "left = \"open\"\nbottom = \"open\"\ntop = \"open\"",
                          fmt::format("left = \"{0} mm\"\nbottom = \"{0} mm\"\nwidth = \"{1} mm\"\nheight = \"{1} "
                                      "mm\"\nspin = \"{2} rad/s\"",
                                      0.5 * side, side, spin),
                          options, 0.3));
  const Totals first = totals(trial.state);
  Rotation worst{};
  const double once = 2 * std::numbers::pi / spin;
  const auto steps = static_cast<int>(std::ceil(once / trial.state.step));
  trial.state.step = once / steps;
  for (int k = 0; k < steps; ++k) {
    trial.step();
    trial.each_point([&](const Points& p, std::size_t i) {
      for (const auto* s : {&p.stress_xx, &p.stress_yy, &p.stress_xy})
        worst.stress = std::max(worst.stress, std::abs((*s)[i]) / (trial_density * corner * corner));
    });
  }
  const Totals last = totals(trial.state);
  worst.angular_momentum = last.angular_momentum / first.angular_momentum - 1;
  worst.energy = (last.kinetic + last.internal) / first.kinetic - 1;
  worst.momentum = std::hypot(last.momentum_x, last.momentum_y) / (first.mass * corner);
  trial.each_point([&](const Points& p, std::size_t i) {
    worst.placed = std::max(worst.placed, std::hypot(p.x[i] - p.reference_x[i], p.y[i] - p.reference_y[i]) / side);
  });
  return worst;
}

/// Manufactured solution: a square between four walls is moved by
///     u = A (sin(k X) (1 - cos(w t)), sin(k Y) (1 - cos(w t)) / 2),   k = 2 pi/L,
/// which a body force b = u'' - div P / rho per mass brings about; P is that of Hencky's law for a gradient without
/// shear, P_xx = (lambda ln J + 2 G ln F_xx)/F_xx. Largest error of the displacements over one period, over A.
/// Source of the method: Wallstedt & Guilkey, J. Comput. Phys. 227 (2008) 9628.
struct Manufactured {
  double error, seconds;
};
inline Manufactured manufacture(int cells, const std::string& options = "", int particles_per_cell_side = 2) {
  constexpr double length = 10, amplitude = 0.25, poisson_ratio = 0.3;
  const double wave = 2 * std::numbers::pi / length;
  const double G = trial_modulus / (2 * (1 + poisson_ratio));
  const double lambda = trial_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio));
  const double period = 2 * length / std::sqrt(trial_modulus / trial_density), rate = 2 * std::numbers::pi / period;
  Trial trial(trial_scene(length, length, length / cells,
                          fmt::format("courant_number = 0.4\nparticles_per_cell_side = {}", particles_per_cell_side),
                          "", options, poisson_ratio));
  const auto steps = static_cast<int>(std::ceil(period / trial.state.step));
  trial.state.step = period / steps;
  constexpr std::array<double, 2> share{1.0, 0.5};
  const auto grown = [&](double t) { return amplitude * (1 - std::cos(rate * t)); };
  const auto force = [&](std::array<double, 2> at, double t) {
    std::array<double, 2> F, rise, b;
    for (std::size_t k = 0; k < 2; ++k) {
      F[k] = 1 + share[k] * grown(t) * wave * std::cos(wave * at[k]);
      rise[k] = -share[k] * grown(t) * wave * wave * std::sin(wave * at[k]);
    }
    for (std::size_t k = 0; k < 2; ++k) {
      const double tau = lambda * std::log(F[0] * F[1]) + 2 * G * std::log(F[k]);
      const double div_P = (lambda + 2 * G - tau) * rise[k] / (F[k] * F[k]);
      const double acceleration = share[k] * amplitude * rate * rate * std::cos(rate * t) * std::sin(wave * at[k]);
      b[k] = acceleration - div_P / trial_density;
    }
    return b;
  };
  trial.push_with(force);
  // Velocities belong to the middles of steps.
  Points& points = trial.state.bodies[0].points;
  const double before = amplitude * rate * std::sin(-0.5 * rate * trial.state.step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.velocity_x[i] = share[0] * before * std::sin(wave * points.reference_x[i]);
    points.velocity_y[i] = share[1] * before * std::sin(wave * points.reference_y[i]);
  }
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    trial.step();
    const double now = grown(trial.state.time);
    trial.each_point([&](const Points& p, std::size_t i) {
      const double x = p.reference_x[i] + share[0] * now * std::sin(wave * p.reference_x[i]);
      const double y = p.reference_y[i] + share[1] * now * std::sin(wave * p.reference_y[i]);
      worst = std::max(worst, std::hypot(p.x[i] - x, p.y[i] - y) / amplitude);
    });
  }
  return {.error = worst, .seconds = trial.seconds};
}
inline double manufactured_error(int cells, const std::string& options = "", int particles_per_cell_side = 2) {
  return manufacture(cells, options, particles_per_cell_side).error;
}

}  // namespace kerf::forward::bodies
