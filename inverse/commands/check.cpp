#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

#include "data/curve.hpp"
#include "data/r_curve.hpp"
#include "forward/bodies/scene.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/job_study_session.hpp"
#include "inverse/job.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/document.hpp"
#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

void check_r_curve(const std::filesystem::path& file) {
  const std::vector<data::ResistanceRow> rows = data::read_r_curve(file);
  const auto by_extension = [](const auto& a, const auto& b) { return a.extension < b.extension; };
  const auto [first, last] = std::minmax_element(rows.begin(), rows.end(), by_extension);
  fmt::print("{}: ok, a resistance curve of {} points, extensions {:g} to {:g} mm\n", file.string(), rows.size(),
             first->extension, last->extension);
}

void check_curve(const std::filesystem::path& file) {
  if (read_file(file).find("crack_extension[") != std::string::npos) return check_r_curve(file);
  const data::Curve curve = data::read_curve(file);
  const double um = consistent_units_in("um");
  std::size_t chip_ratios = 0;
  for (const data::CurvePoint& point : curve.points) chip_ratios += point.chip_ratio ? 1 : 0;
  fmt::print("{}: ok, a curve of {} points, depths {:g} to {:g} um, {} with a chip ratio\n", file.string(),
             curve.points.size(), curve.points.front().depth / um, curve.points.back().depth / um, chip_ratios);
  for (const std::string& note : curve.notes) fmt::print("  note: {}\n", note);
}

void check_scene(const Document& document) {
  if (forward::bodies::has_bodies(document)) {
    const forward::bodies::Scene scene = forward::bodies::read_scene(document);
    fmt::print("{}: ok, a scene of {} bod{}: {}\n", document.name(), scene.bodies.size(),
               scene.bodies.size() == 1 ? "y" : "ies", scene.title);
    return;
  }
  const forward::Scene scene = forward::read_scene(document);
  const auto preset = document.text_at("preset");
  fmt::print("{}: ok, a scene: {}{}\n", document.name(), scene.title,
             preset ? fmt::format(" (preset {})", *preset) : "");
}

void check_job(const std::filesystem::path& file) {
  const inverse::Job job = inverse::read_job(file);
  std::size_t cuts = 0, points = 0;
  for (const inverse::MeasuredCut& cut : job.cuts) ++(cut.extension ? points : cuts);
  std::string data = cuts > 0 ? fmt::format(", {} cuts", cuts) : "";
  if (points > 0) data += fmt::format(", {} points of R-curves", points);
  fmt::print("{}: ok, a job: {} ({} free parameters{}, at most {} runs)\n", file.string(), job.title, job.free.size(),
             data, job.budget.max_runs);
}

void check(const std::filesystem::path& file) {
  if (file.extension() == ".h5")
    throw InputError(file.string() + ": is a simulated cut; `kerf report` and `kerf explain` read it");
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".toml") return check_curve(file);
  const Document document = Document::load(file);
  is_job(document) ? check_job(file) : check_scene(document);
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("check", "Read a scene, a job or a curve and say whether it is sound");
  auto* file = command->add_option("file", "a scene or job (.toml), or a measured curve (CSV)")->required();
  command->callback([file, &exit_code] {
    check(file->as<std::string>());
    exit_code = static_cast<int>(ExitCode::success);
  });
}

}  // namespace kerf::commands
