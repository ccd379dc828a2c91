#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "forward/scene/scene.hpp"
#include "forward/scene/tool_face.hpp"
#include "models/base/estimate.hpp"

namespace kerf::forward {

/// Energies per unit width, N mm/mm, since the start of the cut. `residue` is what the others do not explain.
struct Ledger {
  double tool_work = 0, fracture = 0, plastic = 0, elastic = 0, kinetic = 0, friction = 0, damping = 0;
  double residue() const { return tool_work - fracture - plastic - elastic - kinetic - friction - damping; }
};

/// What a cracked specimen tells about its resistance at one instant.
struct Extension {
  double opening = 0;      ///< of the grip, mm
  double crack = 0;        ///< from the notch to the foremost pair past the peak of its law, mm
  double release = 0;      ///< energy release rate J read at the grips, N/mm
  double at_notch_I = 0;   ///< area under the mode I law up to the opening at the notch, N/mm ...
  double at_notch_II = 0;  ///< ... and under the mode II law: together the same J, read at the crack
};

/// One whole cell crossing of the tool: means over the crossing, per unit width (N/mm).
struct ForceSample {
  double travel;                                ///< tool position at the crossing's end, mm
  std::array<FaceForce, tool_face_count> face;  ///< normal force, friction and contact length of every tool face
  double F_c, F_t;
  double crack_lead;                    ///< from the tool tip to the foremost broken pair, mm
  double softening_lead;                ///< ... to the foremost pair past the peak of its law, mm
  Extension extension;                  ///< of a specimen in grips
  double fracture_I;                    ///< mode I part of ledger.fracture
  double broken_length, broken_energy;  ///< path whose bonds are gone, mm, and what their laws had used up, N mm/mm
  double at_edge;      ///< part of the normal forces that acts within half a depth of where the window cuts the chip
  double penetration;  ///< deepest of a crack face into the tool, mm
  Ledger ledger;       ///< state at the crossing's end
};

enum class Branch { touching, bending };
const char* name(Branch branch);

/// CPU seconds that a stage of the step took over the whole run, from samples.
struct StageTime {
  std::string stage;
  double seconds;
};
/// The name under which records and shifts of the window stand among the stages.
constexpr const char* between_steps_name = "between steps";

struct Cost {
  double wall_seconds = 0;
  double processor_seconds = 0;  ///< of the thread that simulates
  std::int64_t steps = 0, particle_steps = 0;
  std::vector<StageTime> stages;
};

/// A picture of the last instant: one entry per particle / per crack-face marker.
struct Snapshot {
  std::vector<double> x, y, velocity_x, velocity_y, equivalent_stress, pressure, plastic_strain;
  std::vector<double> temperature;  ///< K; empty without [thermal]
  std::vector<int> side;            ///< +1 above the crack plane (chip), -1 below
  std::vector<double> upper_face_x, upper_face_y, lower_face_x, lower_face_y;
  double tool_tip_x = 0, tool_tip_y = 0, tip_radius = 0, cell = 0;
};

/// One face of the tool: force on it per width (N/mm), friction positive against the sliding, and contact length (mm).
struct FaceResult {
  ToolFace face;
  Estimate normal, tangential, contact_length;
};

/// Everything a cut tells. A run that failed is a value too: `accepted` is false and `refusals` says why.
struct CutResult {
  Estimate F_c, F_t;              ///< N/mm per unit width, means over the steady part
  std::vector<FaceResult> faces;  ///< of the faces that the scene's tool has
  double sliding_share = 1;       ///< T over its slip limit: 1 when the whole contact slides
  Estimate chip_ratio;            ///< chip thickness / depth of cut
  Estimate chip_curvature;        ///< 1/mm; positive curls away from the tool
  Estimate crack_lead;            ///< mm from the tool tip to the foremost broken pair
  Estimate softening_lead;        ///< mm from the tool tip to the foremost pair past the peak of its law
  double process_zone = 0;        ///< mm of crack path along which unbroken pairs have used over 5 % of their toughness
  Branch branch = Branch::touching;
  double mode_I_fraction = 0;
  double fracture_energy = 0;        ///< booked per new area, N/mm
  double fracture_energy_ratio = 0;  ///< booked energy per new area over what a broken pair had used up
  double deepest_penetration = 0;    ///< of a crack face into the tool, in cells
  double coarse_strain = 0;  ///< largest plastic strain at the last instant of particles alone in a cell of the base
  double lost_length = 0;    ///< mm of crack path that left the window with bonds that still held
  double room_ahead = 0;     ///< mm of window ahead of the foremost bond past its peak
  struct Heat {
    double chip, highest;  ///< temperatures: mean of the chip from 1.25 to 2.75 depths above the plane, and largest, K
    std::optional<double> friction;  ///< that has stayed in the work since the start, N mm/mm; where friction heats
  };
  std::optional<Heat> heat;  ///< of a scene with [thermal], at the last instant
  double edge_share = 0;     ///< of the normal forces, near the edges where the window cuts the chip
  double inertia_share = 0;  ///< rho d v^2 / F_c: of the force, what it takes to set the chip in motion
  bool steady = false;
  double steady_from = 0;  ///< tool travel, mm
  bool accepted = false;
  const FaceResult& face(ToolFace which) const;  ///< throws std::out_of_range when the tool has no such face
  std::vector<std::string> refusals;             ///< failed acceptance tests, in words with their numbers
  Ledger ledger;
  Cost cost;
  std::vector<ForceSample> history;
  bool chained = false;      ///< began with the state of another run
  bool is_specimen = false;  ///< pulled by grips: `history[i].extension` is its R-curve, and there is no steady force
  Snapshot snapshot;
};

struct State;

/// Where a run begins and where it leaves off: cuts with other parameters can be chained, each without a run-in.
struct Chain {
  const State* from = nullptr;  ///< a state that fits the scene (see record/state_file.hpp); null: unbroken material
  State* to = nullptr;          ///< takes the state at the last cell crossing, if there was one
};

struct Progress {
  double travel, length;  ///< mm
  double F_c;             ///< N/mm, last crossing
  double wall_seconds;
};

/// Simulates one cut. Thread-safe (no globals), deterministic: equal scenes give bitwise equal results.
/// `progress` is called after every cell crossing; returning false stops the run, which is then refused as
/// "interrupted". A run that begins with another's state counts travel and energies from there.
CutResult run(const Scene& scene, const std::function<bool(const Progress&)>& progress = {}, const Chain& chain = {});

}  // namespace kerf::forward
