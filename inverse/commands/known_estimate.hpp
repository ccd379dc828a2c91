#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "inverse/local_model.hpp"

namespace kerf::commands {

/// What may be asked about an estimate once its slopes are known.
struct KnownEstimate {
  const inverse::Job& job;
  const inverse::LocalModel& model;
  const inverse::Misfit& misfit;
  /// Slopes of another job's cuts about the same point.
  std::function<inverse::LocalModel(const inverse::Job&)> slopes_of;
};

/// A folder of a finished calibration: its simulations, replayed from its journal. A job file: the closed form in the
/// place of the simulation, about the closed form's own fit; nothing is simulated. Throws InputError when the folder's
/// calibration is not finished, or the closed form does not describe the job's cuts.
void with_known_estimate(const std::filesystem::path& job_or_folder, const std::string& code,
                         const std::function<void(const KnownEstimate&)>& use);

}  // namespace kerf::commands
