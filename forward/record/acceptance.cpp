#include "forward/record/acceptance.hpp"

#include <fmt/format.h>

namespace kerf::forward {

void judge(CutResult& result) {
  const auto refuse = [&](std::string reason) { result.refusals.push_back(std::move(reason)); };

  const double residue = result.ledger.residue() / result.ledger.tool_work;
  if (!(residue > -0.01 && residue < 0.03))
    refuse(
        fmt::format("the energy ledger does not close: {:.1f} % of the tool's work is unexplained (allowed -1 ... 3 %)",
                    100 * residue));
  if (!(result.fracture_energy_ratio > 0.92 && result.fracture_energy_ratio < 1.05))
    refuse(fmt::format(
        "fracture energy per new area is {:.3f} of the law's (allowed 0.92 ... 1.05): the material beside the "
        "plane tore, or the cut is not steady",
        result.fracture_energy_ratio));
  if (!result.steady)
    refuse("no steady force: the two halves of the record differ by more than 1 % and its own scatter");
  if (!(result.deepest_penetration < 0.25))
    refuse(fmt::format("a crack face went {:.2f} cells into the tool (allowed 0.25)", result.deepest_penetration));
  if (!(result.sliding_share > 0.98))
    refuse(
        fmt::format("the chip sticks: the shear force on the rake face is {:.3f} of its slip limit (allowed from 0.98)",
                    result.sliding_share));
  result.accepted = result.refusals.empty();
}

}  // namespace kerf::forward
