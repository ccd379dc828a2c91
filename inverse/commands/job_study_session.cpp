#include "inverse/commands/job_study_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "forward/scene/preset.hpp"
#include "inverse/commands/calibration_session.hpp"
#include "inverse/commands/scene_session.hpp"
#include "inverse/manifest.hpp"
#include "inverse/table.hpp"
#include "models/base/atomic_file.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Processor time of all runs that the journal holds.
double core_seconds(const inverse::Journal& journal) {
  const Json::json_pointer place("/run/result/cost/processor_s");
  double sum = 0;
  for (const Json& line : journal.lines())
    if (line.contains(place) && line.at(place).is_number()) sum += line.at(place).get<double>();
  return sum;
}

/// Each free parameter's distance from the reference's estimate, also in standard errors that the data leave there:
/// below one the preset costs less than the measurement.
void compare(Json& presets) {
  const Json exact = presets.back().at("parameters");
  for (Json& preset : presets)
    for (auto& [name, parameter] : preset.at("parameters").items()) {
      const Json& best = exact.contains(name) ? exact.at(name) : Json();
      const bool known = best.is_object() && best.at("value").is_number() && parameter.at("value").is_number();
      const double error = known ? parameter.at("value").get<double>() - best.at("value").get<double>() : 0;
      const bool spread = known && best.at("se").is_number() && best.at("se").get<double>() > 0;
      parameter["error"] = known ? Json(error) : Json(nullptr);
      parameter["error_in_se"] = spread ? Json(error / best.at("se").get<double>()) : Json(nullptr);
    }
}

/// A calibration that gave up has one row without a parameter.
std::vector<std::pair<std::string, Json>> rows_of(const Json& preset) {
  std::vector<std::pair<std::string, Json>> rows;
  for (const auto& [name, parameter] : preset.at("parameters").items()) rows.emplace_back(name, parameter);
  if (rows.empty()) rows.emplace_back("", Json{{"verdict", preset.at("reason")}, {"interval", {nullptr, nullptr}}});
  return rows;
}

std::vector<inverse::Column> columns_of(const Json& presets) {
  std::vector<inverse::Column> columns;
  for (const char* name : {"preset", "parameter", "unit", "value", "se", "lower", "upper", "error", "error_in_se",
                           "verdict", "exit_code", "runs", "failed_runs", "core_seconds"})
    columns.push_back({.name = name, .unit = "1", .cells = {}});
  columns.back().unit = "s";
  for (const Json& preset : presets)
    for (const auto& [name, p] : rows_of(preset)) {
      std::vector<Json> cells{preset.at("preset"), name};
      for (const char* key : {"unit", "value", "se"}) cells.push_back(p.value(key, Json(nullptr)));
      for (const Json& end : p.at("interval")) cells.push_back(end);
      for (const char* key : {"error", "error_in_se", "verdict"}) cells.push_back(p.value(key, Json(nullptr)));
      for (const char* key : {"exit_code", "runs", "failed_runs", "core_s"}) cells.push_back(preset.at(key));
      for (std::size_t c = 0; c < columns.size(); ++c) columns[c].cells.push_back(cells[c]);
    }
  return columns;
}

std::string shown(const Json& number) {
  return number.is_number() ? fmt::format("{:.4g}", number.get<double>()) : "-";
}

void print_table(const Json& presets) {
  std::vector<std::vector<std::string>> rows{
      {"preset", "parameter", "value", "std. error", "95 % interval", "error", "in std. errors", "core-s", "verdict"}};
  for (const Json& preset : presets)
    for (const auto& [name, p] : rows_of(preset)) {
      const auto number = [&, &at = p](const char* key) { return shown(at.value(key, Json(nullptr))); };
      const std::string unit = p.value("unit", "1");
      rows.push_back({preset.at("preset").get<std::string>(), name, number("value") + (unit == "1" ? "" : " " + unit),
                      number("se"), shown(p.at("interval").at(0)) + " ... " + shown(p.at("interval").at(1)),
                      number("error"), number("error_in_se"), plain(preset.at("core_s").get<double>(), 1),
                      p.at("verdict").get<std::string>()});
    }
  print_columns(rows);
}

ExitCode run(const fs::path& path, std::vector<inverse::Folder>& folders, const std::string& code, bool json) {
  Json presets = Json::array();
  ExitCode worst = ExitCode::success;
  for (std::size_t k = 0; k < folders.size(); ++k) {
    fmt::print(stderr, "preset {}\n", forward::preset_names[k]);
    const ExitCode ended = run_session(folders[k], code, Show::nothing);
    if (ended == ExitCode::interrupted) {
      fmt::print(stderr, "the whole study continues with: kerf resume {}\n", path.string());
      return ended;
    }
    worst = std::max(worst, ended);
    const Json result = Json::parse(read_file(folders[k].path() / "result.json"));
    presets.push_back({{"preset", forward::preset_names[k]},
                       {"exit_code", static_cast<int>(ended)},
                       {"converged", result.at("converged")},
                       {"reason", result.at("reason")},
                       {"chi2", result.at("chi2")},
                       {"runs", result.at("runs")},
                       {"failed_runs", result.at("failed_runs")},
                       {"parameters", result.at("parameters")}});
  }
  const std::string title = folders.front().job().title;
  folders.clear();  // lets go of the journals, which are read once more for what the runs cost
  for (std::size_t k = 0; k < presets.size(); ++k)
    presets[k]["core_s"] = core_seconds(inverse::Journal(path / forward::preset_names[k] / "journal.jsonl"));
  compare(presets);
  const Json study{
      {"kind", "job study"}, {"title", title}, {"presets", presets}, {"manifest", inverse::code_and_machine(code)}};
  write_atomically(path / "study.csv", inverse::csv(columns_of(presets)));
  write_atomically(path / "study.json", study.dump(2) + "\n");
  draw(path);
  if (json)
    fmt::print("{}\n", study.dump(2));
  else
    print_table(presets);
  return worst;
}

}  // namespace

ExitCode begin_job_study(const fs::path& job, const fs::path& path, const inverse::JobOverride& changes,
                         const std::string& code, bool json) {
  std::vector<inverse::Folder> folders;
  for (const char* preset : forward::preset_names) {
    inverse::JobOverride own = changes;
    own.preset = preset;
    folders.push_back(inverse::Folder::create(path / preset, job, own, code));
  }
  return run(path, folders, code, json);
}

ExitCode resume_job_study(const fs::path& path, const inverse::JobOverride& changes, const std::string& code,
                          bool json) {
  std::vector<inverse::Folder> folders;
  for (const char* preset : forward::preset_names)
    folders.push_back(inverse::Folder::open(path / preset, changes, code));
  return run(path, folders, code, json);
}

bool holds_job_study(const fs::path& folder) {
  return std::all_of(forward::preset_names.begin(), forward::preset_names.end(),
                     [&](const char* preset) { return inverse::Folder::holds_one(folder / preset); });
}

bool is_job(const Document& document) {
  return document.has("scene") || document.has("free");
}

}  // namespace kerf::commands
