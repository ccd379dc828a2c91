#include "inverse/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "inverse/commands/commands.hpp"
#include "inverse/commands/known_estimate.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/folder.hpp"
#include "inverse/statement.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {
namespace {

/// Intervals that are too short by more than the trials leave to chance.
ExitCode judge(const std::vector<inverse::CoverageRow>& rows) {
  const bool hold =
      std::all_of(rows.begin(), rows.end(), [](const inverse::CoverageRow& row) { return row.share.upper >= 0.95; });
  return hold ? ExitCode::success : ExitCode::not_converged;
}

void print(const std::vector<inverse::CoverageRow>& rows, bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::vector<std::vector<std::string>> table{{"parameter", "truth", "held", "of", "share", "95 % interval"}};
  for (const inverse::CoverageRow& row : rows) {
    const double share = static_cast<double>(row.held) / row.trials;
    all.push_back({{"name", row.name},
                   {"held", row.held},
                   {"trials", row.trials},
                   {"share", share},
                   {"interval", {row.share.lower, row.share.upper}}});
    table.push_back({row.name, inverse::show(row.truth, row.unit), std::to_string(row.held), std::to_string(row.trials),
                     fmt::format("{:.1f} %", 100 * share),
                     fmt::format("{:.1f} ... {:.1f} %", 100 * row.share.lower, 100 * row.share.upper)});
  }
  if (json)
    fmt::print("{}\n", all.dump(2));
  else
    print_columns(table);
}

}  // namespace

void add_coverage(CLI::App& app, int& exit_code) {
  struct Options {
    std::string job;
    int trials = 200;
    std::uint64_t seed = 1;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("coverage", "How often a job's 95 % intervals hold the truth of its own twins");
  command->add_option("job", options->job, "job file (closed form), or folder of a finished calibration (simulation)")
      ->required();
  command->add_option("--trials", options->trials, "synthetic experiments")->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "of their errors");
  command->add_flag("--json", options->json, "print the result as JSON");
  command->footer(
      "Synthetic experiments have the job's errors and the estimate as their truth; each is fitted over the slopes\n"
      "about the estimate, which costs no runs. Exit code 4: a share that is below 95 % by more than chance explains.");
  command->callback([options, &exit_code] {
    with_known_estimate(options->job, inverse::code_identity(), [&](const KnownEstimate& known) {
      const auto& base = known.model.base();
      const double edge = known.misfit.residuals(base.simulated, base.point, known.model.known()).edge_force;
      const auto rows = inverse::coverage(known.job, known.model, edge, options->trials, options->seed);
      print(rows, options->json);
      exit_code = static_cast<int>(judge(rows));
    });
  });
}

}  // namespace kerf::commands
