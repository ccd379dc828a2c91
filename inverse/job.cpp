#include "inverse/job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/curve.hpp"
#include "data/r_curve.hpp"
#include "forward/scene/preset.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/derived.hpp"
#include "inverse/free_parameters.hpp"
#include "inverse/parameter_space.hpp"
#include "inverse/sweep_axis.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

namespace fs = std::filesystem;

std::optional<Estimate> estimate(const std::optional<data::Measured>& measured) {
  if (!measured) return std::nullopt;
  return Estimate{measured->value, measured->standard_error().value_or(0.0)};
}

/// The curvature 1/R of a measured curl radius.
std::optional<Estimate> curvature(const std::optional<data::Measured>& radius) {
  const std::optional<Estimate> measured = estimate(radius);
  if (!measured) return std::nullopt;
  return Estimate{1 / measured->value, measured->standard_error / (measured->value * measured->value)};
}

std::optional<Estimate> measured_value(const data::CurvePoint& point, Observable observable) {
  switch (observable) {
    case Observable::F_c:
      return estimate(point.F_c);
    case Observable::F_t:
      return estimate(point.F_t);
    case Observable::chip_ratio:
      return estimate(point.chip_ratio);
    case Observable::chip_curvature:
      return curvature(point.curl_radius);
    case Observable::resistance:
      break;  // no cut shows it
  }
  return std::nullopt;
}

void add_cuts(Job& job, const Values& values, const data::Curve& curve) {
  const std::size_t before = job.cuts.size();
  for (const data::CurvePoint& point : curve.points) {
    if (values.has("shallowest") && point.depth < values.number("shallowest") * (1 - 1e-9)) continue;
    if (values.has("deepest") && point.depth > values.number("deepest") * (1 + 1e-9)) continue;
    if (values.has("specimen") && point.specimen != values.text("specimen")) continue;
    MeasuredCut cut{.curve = job.curves.size() - 1,
                    .row = static_cast<std::size_t>(point.line),
                    .depth = point.depth,
                    .rake = point.rake,
                    .specimen = point.specimen.empty() ? job.curves.back().file.name : point.specimen,
                    .specimen_error = values.number("specimen_error"),
                    .measured = {}};
    for (const Observable observable : job.observables)
      cut.measured[static_cast<std::size_t>(observable)] = measured_value(point, observable);
    job.cuts.push_back(cut);
  }
  if (job.cuts.size() == before)
    throw InputError(fmt::format("{}: no point of {} is left by this [[curve]]'s shallowest, deepest and specimen",
                                 values.where("file"), values.text("file")));
}

/// The file that a key names. Throws InputError with the key's place.
InputFile load(const Values& values, const char* key, const Locate& locate) {
  const std::string& name = values.text(key);
  try {
    return {.name = name, .content = read_file(locate(name))};
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", values.where(key), error.what()));
  }
}

/// The key `changes` of a table, if it has one. What is wrong there is bad data here, no misused command.
void apply_changes(const Values& values, Document& scene) {
  if (!values.has("changes")) return;
  try {
    apply_settings(values.list("changes"), scene, forward::scene_blocks(), values.where("changes"));
  } catch (const InputError& error) {
    throw InputError(error.what());
  }
}

/// The points of an R-curve; one simulated pull of the specimen answers for all of them.
void add_resistance(Job& job, const Values& top, const Values& values, const Locate& locate) {
  MeasuredCurve& curve = job.curves.back();
  curve.specimen_file = load(values, "scene", locate);
  curve.specimen = Document::parse(curve.specimen_file->content, locate(curve.specimen_file->name).string());
  if (top.has("preset")) forward::impose_preset(*curve.specimen, top.text("preset"), top.where("preset"));
  apply_changes(values, *curve.specimen);
  const forward::Scene scene = forward::read_scene(*curve.specimen);
  if (!scene.grips)
    throw InputError(fmt::format("{}: [[curve]] scene = \"{}\" has no [grips]: only a specimen shows an R-curve",
                                 values.where("scene"), values.text("scene")));
  for (const char* key : {"shallowest", "deepest", "specimen"})
    if (values.has(key))
      throw InputError(fmt::format("{}: [[curve]] {} chooses among cuts, but with a scene the file is an R-curve",
                                   values.where(key), key));
  const auto k = static_cast<std::size_t>(Observable::resistance);
  for (const data::ResistanceRow& row : data::parse_r_curve(curve.file.content, locate(curve.file.name).string())) {
    MeasuredCut point{.curve = job.curves.size() - 1,
                      .row = static_cast<std::size_t>(row.line),
                      .depth = scene.cut.depth,
                      .rake = 0,
                      .extension = row.extension,
                      .specimen = curve.file.name,
                      .specimen_error = values.number("specimen_error"),
                      .measured = {}};
    point.measured[k] = Estimate{row.G, row.sd.value_or(0)};
    job.cuts.push_back(point);
  }
}

void require_observables(const Job& job, const Contents& contents) {
  for (const Observable observable : job.observables) {
    const auto k = static_cast<std::size_t>(observable);
    const auto has = [&](const MeasuredCut& cut) { return cut.measured[k].has_value(); };
    if (std::none_of(job.cuts.begin(), job.cuts.end(), has))
      throw InputError(fmt::format("{}: no point of the curves holds a {}", contents.at("").where("observables"),
                                   observable_names[k]));
  }
}

/// Finds what the base scene cannot be patched to, before the first run.
void require_readable_scenes(const Job& job) {
  const ParameterSpace space(job);
  for (const bool at_upper : {false, true})
    for (const MeasuredCut& cut : job.cuts) {
      const Eigen::VectorXd& corner = at_upper ? space.upper() : space.lower();
      try {
        forward::read_scene(space.scene(corner, cut));
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: with every free parameter at its {} bound the scene cannot be read: {}",
                                     job.source.name, at_upper ? "upper" : "lower", error.what()));
      }
    }
}

/// Changes written PATH=VALUE; without any, half the cells through the chip.
Coarse read_coarse(const Contents& contents, const Document& scene) {
  const std::vector<Block>& blocks = forward::scene_blocks();
  Coarse coarse{.closed_form = false, .scene = scene};
  const bool given = contents.has("coarse");
  if (given) coarse.closed_form = contents.at("coarse").text("model") == "closed_form";
  if (!given || !contents.at("coarse").has("changes")) {
    const Contents all = forward::with_preset(scene).read(blocks);
    const double cells = all.at("resolution").number("cells_through_chip");
    coarse.scene.add_table("resolution", blocks);
    coarse.scene.set_number("resolution.cells_through_chip", std::min(cells, std::max(3.0, std::floor(cells / 2))),
                            blocks);
    return coarse;
  }
  const Values& values = contents.at("coarse");
  apply_changes(values, coarse.scene);
  forward::read_scene(coarse.scene);
  return coarse;
}

std::vector<NumericsChoice> read_numerics(const Contents& contents, const Document& scene) {
  std::vector<NumericsChoice> all;
  for (const Values& values : contents.all("numerics")) {
    const auto taken = [&](const NumericsChoice& other) { return other.name == values.text("name"); };
    if (std::any_of(all.begin(), all.end(), taken))
      throw InputError(
          fmt::format("{}: the name \"{}\" is taken; choose another one", values.where("name"), values.text("name")));
    all.push_back({.name = values.text("name"), .scene = scene});
    apply_changes(values, all.back().scene);
    forward::read_scene(all.back().scene);
  }
  return all;
}

std::size_t whole_number(const Values& values, std::string_view key) {
  const double value = values.number(key);
  if (value != std::floor(value))
    throw InputError(fmt::format("{}: {} = {} must be a whole number", values.where(key), key, value));
  return static_cast<std::size_t>(value);
}

}  // namespace

const char* name(CuttingShare share) {
  return share == CuttingShare::friction ? "friction" : "none";
}

std::string InputFile::hash() const {
  return sha256(content);
}

std::string Job::identity() const {
  std::string all = source.hash() + scene_file.hash();
  for (const MeasuredCurve& curve : curves)
    all += curve.file.hash() + (curve.specimen_file ? curve.specimen_file->hash() : "");
  return sha256(all);
}

Job read_job(const fs::path& file) {
  return read_job(file, file.string(), [&](const std::string& name) { return file.parent_path() / name; });
}

Job read_job(const fs::path& file, const std::string& name, const Locate& locate) {
  InputFile source{.name = name, .content = read_file(file)};
  const Document document = Document::parse(source.content, name);
  if (!document.has("scene") && document.has("material"))
    throw InputError(name +
                     ": is a scene; a job names one (scene = \"...\"), curves and what is free in it; see data/jobs");
  const Contents contents = document.read(job_blocks());
  const Values& top = contents.at("");
  InputFile scene = load(top, "scene", locate);
  Document base = Document::parse(scene.content, locate(scene.name).string());
  if (top.has("preset")) forward::impose_preset(base, top.text("preset"), top.where("preset"));
  forward::read_scene(base);

  Job job{.title = top.text("title"),
          .source = std::move(source),
          .scene_file = std::move(scene),
          .curves = {},
          .cuts = {},
          .scene = base,
          .free = read_free_parameters(contents, base),
          .ties = {},
          .derived = {},
          .observables = {},
          .edge_force = {},
          .budget = {},
          .optimiser = {},
          .coarse = {.closed_form = false, .scene = base},
          .numerics = {}};
  job.ties = read_ties(contents, base, job.free);
  for (const Values& values : contents.all("derived")) job.derived.push_back(read_derived(values, job));
  job.verify = contents.at("uncertainty").flag("verify");
  job.posterior_moves = static_cast<int>(whole_number(contents.at("uncertainty"), "posterior_moves"));
  for (std::size_t k = 0; k < observable_count; ++k) {
    const std::vector<std::string>& wanted = top.list("observables");
    if (std::find(wanted.begin(), wanted.end(), observable_names[k]) != wanted.end())
      job.observables.push_back(static_cast<Observable>(k));
  }
  for (const Values& values : contents.all("curve")) {
    job.curves.push_back({.file = load(values, "file", locate),
                          .changes = values.has("changes") ? values.list("changes") : std::vector<std::string>(),
                          .specimen_file = {},
                          .specimen = {}});
    if (values.has("scene")) {
      add_resistance(job, top, values, locate);
      continue;
    }
    const InputFile& file = job.curves.back().file;
    add_cuts(job, values, data::parse_curve(file.content, locate(file.name).string()));
  }
  const auto is_pull = [](const MeasuredCut& cut) { return cut.extension.has_value(); };
  const bool pulls = std::any_of(job.cuts.begin(), job.cuts.end(), is_pull);
  if (pulls &&
      std::find(job.observables.begin(), job.observables.end(), Observable::resistance) == job.observables.end())
    job.observables.push_back(Observable::resistance);
  require_observables(job, contents);

  if (contents.has("edge_force")) {
    const Values& edge = contents.at("edge_force");
    job.edge_force = {
        .cutting_share = edge.text("cutting_share") == "none" ? CuttingShare::none : CuttingShare::friction,
        .lower = edge.number("lower"),
        .upper = edge.number("upper"),
        .compare = edge.flag("compare")};
    if (job.edge_force->lower >= job.edge_force->upper)
      throw InputError(fmt::format("{}: [edge_force] lower must be below upper", edge.where("lower")));
  }
  const Values& budget = contents.at("budget");
  job.budget = {.max_runs = whole_number(budget, "max_runs"),
                .parallel = static_cast<int>(whole_number(budget, "parallel")),
                .tolerance = budget.number("tolerance"),
                .failing_share = budget.number("failing_share"),
                .time_out = budget.number("time_out"),
                .shortest_time_out = budget.number("shortest_time_out"),
                .first_time_out = budget.number("first_time_out"),
                .backend = budget.text("backend"),
                .shared_runs = {}};
  const Values& optimiser = contents.at("optimiser");
  job.optimiser.method = optimiser.text("method");
  job.optimiser.central = optimiser.flag("central");
  job.optimiser.step_given = optimiser.has("step");
  job.optimiser.noise_given = optimiser.has("noise");
  if (optimiser.has("step")) job.optimiser.step = optimiser.number("step");
  if (optimiser.has("noise")) job.optimiser.noise = job.optimiser.roughness = optimiser.number("noise");
  job.optimiser.audit =
      optimiser.has("audit") ? optimiser.flag("audit") : !optimiser.has("step") || !optimiser.has("noise");
  job.coarse = read_coarse(contents, base);
  job.numerics = read_numerics(contents, base);
  if (contents.has("discrepancy")) job.discrepancy = contents.at("discrepancy").number("relative");
  require_readable_scenes(job);
  return job;
}

}  // namespace kerf::inverse
