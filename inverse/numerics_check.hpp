#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {

/// What the estimates owe to one numerical choice of the scene.
struct NumericsShift {
  std::string name;
  std::size_t cuts = 0;        ///< compared: usable on both sides and with known slopes
  std::size_t runs = 0;        ///< new ones that it took
  double chi2 = 0;             ///< at the shifted estimates
  std::vector<double> shifts;  ///< of the parameters (F_b last), then of the derived quantities; consistent units
};

/// Simulates the cuts of the estimate once more for every [[numerics]] of the job, and asks the local model, moved to
/// the new simulations with its slopes as they are, for the minimum: estimates under the other numerics, to first
/// order, for one curve each. A cut that fails or changes branch there is left out on both sides. A check that the
/// budget no longer covers is missing from the answer.
std::vector<NumericsShift> check_numerics(const Job& job, Objective& objective, const LocalModel& model);

}  // namespace kerf::inverse
