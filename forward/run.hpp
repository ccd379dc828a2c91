#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "forward/scene/scene.hpp"
#include "models/base/estimate.hpp"

namespace kerf::forward {

/// Energies per unit width, N mm/mm, since the start of the cut. `residue` is what the others do not explain.
struct Ledger {
  double tool_work = 0, fracture = 0, plastic = 0, elastic = 0, kinetic = 0, friction = 0, damping = 0;
  double residue() const { return tool_work - fracture - plastic - elastic - kinetic - friction - damping; }
};

/// One whole cell crossing of the tool: means over the crossing, per unit width (N/mm).
struct ForceSample {
  double travel;                        ///< tool position at the crossing's end, mm
  double rake_normal, rake_tangential;  ///< N and T on the rake face
  double slip_limit;                    ///< T when every point of the rake face slides
  double bottom_normal, bottom_tangential;
  double F_c, F_t;
  double crack_lead;   ///< mm
  double fracture_I;   ///< mode I part of ledger.fracture
  double penetration;  ///< deepest of a crack face into the tool, mm
  Ledger ledger;       ///< state at the crossing's end
};

enum class Branch { touching, bending };
const char* name(Branch branch);

struct Cost {
  double wall_seconds = 0;
  std::int64_t steps = 0, particle_steps = 0;
};

/// A picture of the last instant: one entry per particle / per crack-face marker.
struct Snapshot {
  std::vector<double> x, y, velocity_x, velocity_y, equivalent_stress, pressure, plastic_strain;
  std::vector<int> side;  ///< +1 above the crack plane (chip), -1 below
  std::vector<double> upper_face_x, upper_face_y, lower_face_x, lower_face_y;
  double tool_tip_x = 0, tool_tip_y = 0, cell = 0;
};

/// Everything a cut tells. A run that failed is a value too: `accepted` is false and `refusals` says why.
struct CutResult {
  Estimate F_c, F_t;  ///< N/mm per unit width, means over the steady part
  Estimate rake_normal, rake_tangential, bottom_normal, bottom_tangential;
  double sliding_share = 1;  ///< T over its slip limit: 1 when the whole contact slides
  Estimate chip_ratio;       ///< chip thickness / depth of cut
  Estimate chip_curvature;   ///< 1/mm; positive curls away from the tool
  Estimate crack_lead;       ///< mm from the tool tip to the foremost broken pair
  double process_zone = 0;   ///< mm of crack path along which unbroken pairs have used over 5 % of their toughness
  Branch branch = Branch::touching;
  double mode_I_fraction = 0;
  double fracture_energy_ratio = 0;  ///< booked energy per new area over the law's
  double deepest_penetration = 0;    ///< of a crack face into the tool, in cells
  bool steady = false;
  double steady_from = 0;  ///< tool travel, mm
  bool accepted = false;
  std::vector<std::string> refusals;  ///< failed acceptance tests, in words with their numbers
  Ledger ledger;
  Cost cost;
  std::vector<ForceSample> history;
  Snapshot snapshot;
};

struct Progress {
  double travel, length;  ///< mm
  double F_c;             ///< N/mm, last crossing
  double wall_seconds;
};

/// Simulates one cut. Thread-safe (no globals), deterministic: equal scenes give bitwise equal results.
/// `progress` is called after every cell crossing; returning false stops the run, which is then refused as
/// "interrupted".
CutResult run(const Scene& scene, const std::function<bool(const Progress&)>& progress = {});

}  // namespace kerf::forward
