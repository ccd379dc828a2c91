#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "inverse/run_database.hpp"
#include "inverse/scene_folder.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// What became of the runs of a folder.
struct SceneOutcome {
  std::vector<std::optional<inverse::RunRecord>> records;  ///< one per run; none: not run yet
  double wall_seconds = 0;                                 ///< of all sessions
  std::size_t simulated = 0;                               ///< by this process
  bool interrupted = false;
};

/// Simulates what the folder does not hold yet, longest first, and keeps the cuts if they are to be kept. One line on
/// standard error for each run that ends. To be called under StopOnInterrupt.
SceneOutcome simulate_all(inverse::SceneFolder& folder, const std::vector<inverse::RunRequest>& runs,
                          const std::string& code);

/// Says how to go on after Ctrl-C; else: success when every run was accepted, not_converged when one was not.
ExitCode conclude(const inverse::SceneFolder& folder, const SceneOutcome& outcome, const std::string& table);

/// Versions, machine, inputs, what was asked for and what it took.
nlohmann::ordered_json manifest_of(const inverse::SceneFolder& folder, const std::string& code, double wall_seconds);

/// How many runs, and what they will cost.
void print_cost(const std::vector<inverse::RunRequest>& runs, int jobs);

/// Rows of equal length, the first one their heads: right-aligned columns as wide as they need, the last one free.
void print_columns(const std::vector<std::vector<std::string>>& rows);

/// Why runs were refused, one line each.
void print_refusals(const SceneOutcome& outcome);

/// In N/m without decimals, "-" for what is not known.
std::string in_newton_per_metre(double force);
std::string plain(double value, int decimals);

/// Draws the report of a folder whose numbers are all there; says how to try again when that fails.
void draw(const std::filesystem::path& folder);

}  // namespace kerf::commands
