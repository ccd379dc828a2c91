#include "inverse/next_cut.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "forward/scene/preset.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/known_estimate.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/folder.hpp"
#include "inverse/statement.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

constexpr std::size_t shown = 12;  // of the table's lines; --json holds all

void print(const std::vector<inverse::NextCut>& cuts, const std::string& name, bool json) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  std::vector<std::vector<std::string>> table{
      {"depth", "rake", "measure", "expected", "its error", "std. error of " + name}};
  for (const inverse::NextCut& cut : cuts) {
    const auto k = static_cast<std::size_t>(cut.observable);
    const std::string unit = inverse::observable_units[k];
    const double one = consistent_units_in(unit), degrees = cut.rake / consistent_units_in("deg");
    all.push_back({{"depth_mm", cut.depth},
                   {"rake_deg", degrees},
                   {"observable", inverse::observable_names[k]},
                   {"expected", cut.expected / one},
                   {"measurement_error", cut.measurement_error / one},
                   {"unit", unit},
                   {"standard_error_ratio", cut.standard_error_ratio}});
    if (table.size() <= shown)
      table.push_back({inverse::show(cut.depth, "mm"), fmt::format("{:.3g} deg", degrees), inverse::observable_names[k],
                       inverse::show(cut.expected, unit), inverse::show(cut.measurement_error, unit),
                       fmt::format("x {:.3f}", cut.standard_error_ratio)});
  }
  if (json)
    fmt::print("{}\n", all.dump(2));
  else
    print_columns(table);
}

}  // namespace

void add_next_cut(CLI::App& app, int& exit_code) {
  struct Options {
    std::string job, name;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("next-cut", "The depth, rake and observable that would sharpen a parameter most");
  command->add_option("job", options->job, "job file (closed form), or folder of a finished calibration (simulation)")
      ->required();
  command->add_option("--for", options->name, "parameter to sharpen; without it the first free one");
  command->add_flag("--json", options->json, "print every candidate as JSON");
  command->footer(
      "A folder's candidates are simulated in the preset \"draft\" and kept in its journal; standard error says how "
      "many\n"
      "runs that is. The errors of the new measurement are those of the job's.");
  command->callback([options, &exit_code] {
    with_known_estimate(options->job, inverse::code_identity(), [&](const KnownEstimate& known) {
      inverse::Job candidates = inverse::with_cuts(known.job, inverse::candidate_cuts(known.job));
      if (std::filesystem::is_directory(options->job)) {
        forward::impose_preset(candidates.scene, "draft", options->job);
        fmt::print(stderr, "{} candidate cuts at {} points each: {} simulations at most\n", candidates.cuts.size(),
                   candidates.free.size() + 1, candidates.cuts.size() * (candidates.free.size() + 1));
      }
      const inverse::LocalModel slopes = known.slopes_of(candidates);
      const std::string name = options->name.empty() ? known.job.free.front().name : options->name;
      print(inverse::next_cuts(known.job, known.model, known.misfit, candidates, slopes, name), name, options->json);
      exit_code = static_cast<int>(ExitCode::success);
    });
  });
}

}  // namespace kerf::commands
