#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/run_record.hpp"

namespace kerf::inverse {

/// What a run costs, and how far its forces, or of bodies the result that is looked at, are from those that count as
/// exact.
struct WorkPrecision {
  Estimate F_c, F_t;  ///< difference to the reference in shares of its |F_c|; both runs' standard errors combined
  std::optional<Estimate> result;  ///< of bodies, in the place of forces: share by which it is off
  double core_seconds = 0;         ///< processor time of the run
  double particle_steps = 0;       ///< the same cost, whatever the machine does
  bool front = false;              ///< no other run is at once cheaper and nearer to the reference

  /// The larger of both differences; one that is below its standard error counts as that, since no luck is precision.
  Estimate error() const;
  bool resolved() const { return error().value > error().standard_error; }
};

/// Of cuts: one for each accepted run that `reference` can judge; none for the others and for the reference itself.
std::vector<std::optional<WorkPrecision>> work_precision(const std::vector<std::optional<RunRecord>>& records,
                                                         std::size_t reference);

/// Of bodies, by what they find under `name`. A name that ends in "_error" is a share off a closed form, hence also the
/// reference is judged; any other is compared with what the reference finds.
std::vector<std::optional<WorkPrecision>> work_precision(const std::vector<std::optional<RunRecord>>& records,
                                                         std::size_t reference, const std::string& name);
bool is_off_closed_form(const std::string& name);

struct CostAndError {
  double cost, error;
};

/// Which points no other point beats: lower in one and not higher in the other.
std::vector<bool> pareto_front(const std::vector<CostAndError>& points);

}  // namespace kerf::inverse
