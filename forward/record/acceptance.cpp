#include "forward/record/acceptance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kerf::forward {
namespace {

// Coarser grids let the crack run ahead of the tool where a finer one keeps it at the tip (h = 1.5 mm of the
// verification polymer: half the force at 0.24 cells per critical opening).
constexpr double smallest_opening = 0.35;

// The tool is faster than in the experiment, for time; the force of inertia grows with the square of its speed.
constexpr double largest_inertia = 0.05;

/// The energy release rate is read twice, at the grips and at the notch: a specimen that was pulled slowly enough has
/// one value.
template <class Refuse>
void judge_specimen(const CutResult& result, Refuse&& refuse) {
  double difference = 0.0, sum = 0.0;
  for (const ForceSample& sample : result.history) {
    const Extension& e = sample.extension;
    difference += std::abs(e.release - e.at_notch_I - e.at_notch_II);
    sum += e.release;
  }
  if (!(difference < 0.05 * sum))
    refuse(
        fmt::format("the energy release rates at the grips and at the notch differ by {:.1f} % in the mean (allowed "
                    "5 %): the specimen was pulled too fast, yielded, or is too coarse",
                    100 * difference / sum));
}

// One particle in a cell is for material that stays elastic.
constexpr double largest_coarse_strain = 0.01;

}  // namespace

void judge(CutResult& result, const Scene& scene) {
  const auto refuse = [&](std::string reason) { result.refusals.push_back(std::move(reason)); };
  if (result.history.empty()) {  // it broke down at once, and says so
    result.accepted = false;
    return;
  }

  const double opening =
      std::min(scene.cohesive.mode_I->critical_opening(), scene.cohesive.mode_II->critical_opening());
  if (!(opening > smallest_opening * scene.cell()))
    refuse(fmt::format(
        "the grid is too coarse for the cohesive law: its critical opening is {:.2f} cells (allowed from {}), so "
        "take {} cells through the chip",
        opening / scene.cell(), smallest_opening, std::ceil(smallest_opening * scene.cut.depth / opening)));

  const double residue = result.ledger.residue() / result.ledger.tool_work;
  if (!(residue > -0.01 && residue < 0.03))
    refuse(
        fmt::format("the energy ledger does not close: {:.1f} % of the tool's work is unexplained (allowed -1 ... 3 %)",
                    100 * residue));
  if (result.is_specimen) {
    judge_specimen(result, refuse);
    result.accepted = result.refusals.empty();
    return;
  }
  if (!(result.fracture_energy_ratio > 0.92 && result.fracture_energy_ratio < 1.05))
    refuse(fmt::format(
        "fracture energy per new area is {:.3f} of the law's (allowed 0.92 ... 1.05): the material beside the "
        "plane tore, or the cut is not steady",
        result.fracture_energy_ratio));
  if (result.lost_length > 0.0)
    refuse(
        fmt::format("bonds still held where the window ends behind the tool, along {:.3g} mm: lengthen window.behind, "
                    "window.above or window.zone",
                    result.lost_length));
  if (!(result.room_ahead > 1.5 * scene.cut.depth))
    refuse(
        fmt::format("the crack runs to {:.3g} mm from the window's far end (allowed from 1.5 depths of cut): lengthen "
                    "window.ahead",
                    result.room_ahead));
  if (!(result.edge_share < 0.02))
    refuse(
        fmt::format("{:.1f} % of the tool's normal forces act where the window cuts the chip (allowed 2 %): raise "
                    "window.behind, window.above or window.zone",
                    100 * result.edge_share));
  if (!(result.inertia_share < largest_inertia))
    refuse(
        fmt::format("setting the chip in motion takes {:.1f} % of the cutting force (allowed {:g} %): lower cut.speed",
                    100 * result.inertia_share, 100 * largest_inertia));
  if (!result.steady)
    refuse("no steady force: the two halves of the record differ by more than 1 % and their own scatter, or by 3 %");
  if (!(result.deepest_penetration < 0.25))
    refuse(fmt::format("a crack face went {:.2f} cells into the tool (allowed 0.25)", result.deepest_penetration));
  if (scene.tool.tip_radius == 0.0 && !scene.edge_contact) {
    // A sharp tip runs clear of the base. Where bonds are stronger than the material around them, the layer flows past
    // the tip unparted and the base comes up with it.
    const double share = result.face(ToolFace::bottom).normal.value / result.face(ToolFace::rake).normal.value;
    if (!(share < 0.01))
      refuse(fmt::format(
          "the base presses on a sharp tool with {:.1f} % of the force on its rake face (allowed 1 %): the material "
          "beside the plane flows instead of parting; take fewer cells through the chip, or a cohesive shear strength "
          "nearer to the shear yield stress",
          100 * share));
  }
  if (!(result.coarse_strain < largest_coarse_strain))
    refuse(fmt::format(
        "the base flows where a cell holds one particle: plastic strains there reach {:.3g} (allowed {:g}): "
        "raise resolution.single_particle_below",
        result.coarse_strain, largest_coarse_strain));
  if (!(result.sliding_share > 0.98))
    refuse(
        fmt::format("the chip sticks: the shear force on the rake face is {:.3f} of its slip limit (allowed from 0.98)",
                    result.sliding_share));
  result.accepted = result.refusals.empty();
}

}  // namespace kerf::forward
