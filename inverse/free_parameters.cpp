#include "inverse/free_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "forward/scene/scene.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

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

}  // namespace

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

}  // namespace kerf::inverse
