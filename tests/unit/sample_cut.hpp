#pragma once

#include <cmath>

#include "forward/run.hpp"

namespace kerf::forward {

/// A cut made by hand: numbers that differ from each other, so that a swapped pair shows.
inline CutResult sample_cut() {
  CutResult r;
  r.F_c = {7.612, 0.012};
  r.F_t = {-7.601, 0.011};
  r.faces = {{ToolFace::rake, {10.76, 0.02}, {0.25, 0.01}, {0.3, 0.02}},
             {ToolFace::bottom, {0.125, 0.005}, {0.0625, 0.004}, {0.05, 0.003}}};
  r.chip_ratio = {1.12, 0.01};
  r.chip_curvature = {0.25, 0.05};
  r.crack_lead = {0.138, 0.002};
  r.branch = Branch::touching;
  r.mode_I_fraction = 0.97;
  r.fracture_energy_ratio = 0.998;
  r.deepest_penetration = 0.04;
  r.steady = r.accepted = true;
  r.steady_from = 0.9;
  r.ledger = {
      .tool_work = 20, .fracture = 5, .plastic = 13, .elastic = 0.5, .kinetic = 0.25, .friction = 0, .damping = 1};
  r.cost = {.wall_seconds = 4, .steps = 1000, .particle_steps = 8000000, .stages = {{"project", 1}, {"stress", 3}}};
  for (int crossing = 1; crossing <= 40; ++crossing) {
    const double travel = 0.0625 * crossing, force = 7.6 * (1 - std::exp(-4 * travel));
    ForceSample sample{};
    sample.travel = travel;
    sample.face[static_cast<std::size_t>(ToolFace::rake)] = {.normal = 1.4 * force, .tangential = 0.1 * force};
    sample.face[static_cast<std::size_t>(ToolFace::bottom)] = {.normal = 0.02 * force, .tangential = 0.01 * force};
    sample.F_c = force;
    sample.F_t = -force;
    sample.crack_lead = 0.138;
    sample.ledger = {.tool_work = 20 * travel,
                     .fracture = 5 * travel,
                     .plastic = 13 * travel,
                     .elastic = 0.5,
                     .kinetic = 0.25,
                     .friction = 0,
                     .damping = travel};
    r.history.push_back(sample);
  }
  Snapshot& s = r.snapshot;
  for (int row = -4; row < 8; ++row)
    for (int column = 0; column < 30; ++column) {
      const double x = 0.03125 * (column + 0.5), y = 0.03125 * (row + 0.5);
      s.x.push_back(x);
      s.y.push_back(y);
      s.velocity_x.push_back(100 * y);
      s.velocity_y.push_back(10 * x);
      s.equivalent_stress.push_back(20 + x);
      s.pressure.push_back(-5 - y);
      s.plastic_strain.push_back(0.1 * x);
      s.side.push_back(row < 0 ? -1 : 1);
    }
  for (int marker = 0; marker < 20; ++marker) {
    s.upper_face_x.push_back(0.05 * marker);
    s.upper_face_y.push_back(0.02);
    s.lower_face_x.push_back(0.05 * marker);
    s.lower_face_y.push_back(-0.01);
  }
  s.tool_tip_x = 0.5;
  s.tool_tip_y = 0;
  s.cell = 0.0625;
  return r;
}

}  // namespace kerf::forward
