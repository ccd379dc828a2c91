#include "inverse/job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "data/curve.hpp"
#include "data/r_curve.hpp"
#include "forward/scene/preset.hpp"
#include "forward/scene/scene.hpp"
#include "inverse/derived.hpp"
#include "inverse/parameter_space.hpp"
#include "inverse/sweep_axis.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

namespace fs = std::filesystem;

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('.') + 1);
}

/// A bound or start: its unit must measure what `parameter` measures, its value lie in the parameter's physical range.
double read_quantity(const Values& values, std::string_view key, const Parameter& parameter) {
  const std::string& written = values.text(key);
  try {
    const Quantity quantity = split_quantity(written);
    if (quantity.unit.empty() && parameter.unit != "1")
      throw std::invalid_argument(fmt::format("needs a unit, such as \"{} {}\"", written, parameter.unit));
    return in_range(quantity.number, quantity.unit.empty() ? "1" : quantity.unit, parameter);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: [[free]] {} = \"{}\" {}", values.where(key), key, written, error.what()));
  }
}

/// The declaration of a number that this base scene really holds.
const Parameter& number_of_scene(const Document& scene, const Values& values, std::string_view key) {
  const std::string& path = values.text(key);
  const Parameter& parameter = Document::find_number(path, forward::scene_blocks(), values.where(key));
  if (const std::string block = path.substr(0, std::min(path.rfind('.'), path.size())); !scene.has(block))
    throw InputError(fmt::format("{}: {} = \"{}\", but {} has no table [{}]; add it there", values.where(key), key,
                                 path, scene.name(), block));
  return parameter;
}

FreeParameter read_free(const Values& values, const Document& scene) {
  const Parameter& parameter = number_of_scene(scene, values, "path");
  FreeParameter free;
  free.path = values.text("path");
  if (free.path == "cut.depth" || free.path == "tool.rake")
    throw InputError(
        fmt::format("{}: \"{}\" comes from the measured curve and cannot be free", values.where("path"), free.path));
  free.unit = parameter.unit;
  free.logarithmic = values.text("scale") == "log";
  free.lower = read_quantity(values, "lower", parameter);
  free.upper = read_quantity(values, "upper", parameter);
  free.key = values.flag("key");
  if (free.lower >= free.upper)
    throw InputError(fmt::format("{}: [[free]] lower = \"{}\" must be below upper = \"{}\"", values.where("lower"),
                                 values.text("lower"), values.text("upper")));
  if (free.logarithmic && free.lower <= 0)
    throw InputError(
        fmt::format("{}: [[free]] lower = \"{}\" must be positive on a logarithmic scale; "
                    "or set scale = \"linear\"",
                    values.where("lower"), values.text("lower")));
  if (values.has("start")) {
    free.start = read_quantity(values, "start", parameter);
    if (*free.start < free.lower || *free.start > free.upper)
      throw InputError(fmt::format("{}: [[free]] start = \"{}\" is outside lower = \"{}\" and upper = \"{}\"",
                                   values.where("start"), values.text("start"), values.text("lower"),
                                   values.text("upper")));
  }
  if (values.has("prior") != values.has("prior_error"))
    throw InputError(fmt::format("{}: [[free]] prior and prior_error go together", values.where("path")));
  if (values.has("prior")) {
    Parameter error = parameter;
    error.lower = 0;
    error.upper = std::numeric_limits<double>::infinity();
    free.prior = {read_quantity(values, "prior", parameter), read_quantity(values, "prior_error", error)};
    if (!(free.prior->standard_error > 0))
      throw InputError(fmt::format("{}: [[free]] prior_error = \"{}\" must be positive", values.where("prior_error"),
                                   values.text("prior_error")));
  }
  // "coefficient" says nothing alone: friction.coefficient is friction.
  const std::string block = free.path.substr(0, free.path.rfind('.'));
  free.name = values.has("name")                      ? values.text("name")
              : last_part(free.path) == "coefficient" ? last_part(block)
                                                      : last_part(free.path);
  return free;
}

std::vector<FreeParameter> read_free_parameters(const Contents& contents, const Document& scene) {
  std::vector<FreeParameter> all;
  std::set<std::string> paths;
  for (const Values& values : contents.all("free")) {
    all.push_back(read_free(values, scene));
    if (!paths.insert(all.back().path).second)
      throw InputError(fmt::format("{}: \"{}\" is free twice", values.where("path"), all.back().path));
  }
  const std::vector<FreeParameter> declared = all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto same = [&](const FreeParameter& other) { return other.name == declared[i].name; };
    if (std::count_if(declared.begin(), declared.end(), same) == 1 && all[i].name != "edge_force") continue;
    const Values& values = contents.all("free")[i];
    if (values.has("name"))
      throw InputError(
          fmt::format("{}: the name \"{}\" is taken; choose another one", values.where("name"), all[i].name));
    all[i].name = all[i].path;
  }
  return all;
}

std::vector<Tie> read_ties(const Contents& contents, const Document& scene, const std::vector<FreeParameter>& free) {
  std::set<std::string> set{"cut.depth", "tool.rake"};
  for (const FreeParameter& parameter : free) set.insert(parameter.path);
  std::vector<Tie> ties;
  for (const Values& values : contents.all("tie")) {
    const Parameter& follows = number_of_scene(scene, values, "path");
    const Parameter& leads = number_of_scene(scene, values, "of");
    const Tie tie{.path = values.text("path"), .factor = values.number("equals"), .of = values.text("of")};
    if (!set.insert(tie.path).second)
      throw InputError(
          fmt::format("{}: \"{}\" is already free, tied or given by the curve", values.where("path"), tie.path));
    if (!same_dimension(follows.unit, leads.unit))
      throw InputError(fmt::format("{}: \"{}\" [{}] cannot follow \"{}\" [{}]: different dimensions",
                                   values.where("of"), tie.path, follows.unit, tie.of, leads.unit));
    ties.push_back(tie);
  }
  return ties;
}

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
