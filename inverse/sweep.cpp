#include "inverse/sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "inverse/scene_kind.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

constexpr std::size_t most_runs = 100000;

/// A single value holds for all pairs.
std::vector<std::vector<std::size_t>> zipped(const std::vector<SweepAxis>& axes, std::string_view where) {
  const auto shorter = [](const SweepAxis& a, const SweepAxis& b) { return a.values.size() < b.values.size(); };
  const SweepAxis& longest = *std::max_element(axes.begin(), axes.end(), shorter);
  for (const SweepAxis& axis : axes)
    if (axis.values.size() != longest.values.size() && axis.values.size() != 1)
      throw InputError(fmt::format("{}: --zip pairs values one to one, but {} has {} and {} has {}", where, axis.name(),
                                   axis.values.size(), longest.name(), longest.values.size()),
                       ExitCode::usage);
  std::vector<std::vector<std::size_t>> choices;
  for (std::size_t i = 0; i < longest.values.size(); ++i) {
    choices.emplace_back();
    for (const SweepAxis& axis : axes) choices.back().push_back(axis.values.size() == 1 ? 0 : i);
  }
  return choices;
}

std::vector<std::vector<std::size_t>> product(const std::vector<SweepAxis>& axes, std::string_view where) {
  std::size_t count = 1;
  for (const SweepAxis& axis : axes) {
    count *= axis.values.size();
    if (count > most_runs)
      throw InputError(fmt::format("{}: more than {} runs; sweep fewer values", where, most_runs), ExitCode::usage);
  }
  std::vector<std::vector<std::size_t>> choices;
  std::vector<std::size_t> choice(axes.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    choices.push_back(choice);
    for (std::size_t a = axes.size(); a-- > 0 && ++choice[a] == axes[a].values.size();) choice[a] = 0;
  }
  return choices;
}

void refuse_shared_paths(const std::vector<SweepAxis>& axes, std::string_view where) {
  std::set<std::string> paths;
  for (const SweepAxis& axis : axes)
    for (const std::string& path : axis.paths)
      if (!paths.insert(path).second)
        throw InputError(fmt::format("{}: \"{}\" is swept twice", where, path), ExitCode::usage);
}

/// Why the scene cannot be read, if so.
std::optional<InputError> refusal_of(const Document& scene) {
  try {
    SceneKind::of(scene).check(scene);
    return std::nullopt;
  } catch (const InputError& error) {
    return error;
  }
}

void refuse_hopeless_values(const Sweep& sweep) {
  std::map<std::pair<std::size_t, std::size_t>, std::optional<InputError>> refusals;
  for (const SweepRun& run : sweep.runs) {
    const std::optional<InputError> refusal = refusal_of(run.scene);
    for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
      const auto [entry, first] = refusals.try_emplace({a, run.choice[a]}, refusal);
      if (!first && !refusal) entry->second.reset();
    }
  }
  for (const auto& [place, refusal] : refusals)
    if (refusal) {
      const SweepAxis& axis = sweep.axes[place.first];
      throw InputError(fmt::format("{} (with {})", refusal->what(), axis.label(axis.values[place.second])));
    }
}

}  // namespace

Sweep lay_out_sweep(const Document& scene, const std::vector<std::string>& axes, bool zip, std::string_view where) {
  const SceneKind kind = SceneKind::of(scene);
  const std::vector<Block>& known = kind.blocks();
  kind.check(scene);
  Sweep sweep{.scene = scene, .axes = {}, .zip = zip, .runs = {}};
  for (const std::string& axis : axes) sweep.axes.push_back(parse_axis(axis, known, where, zip));
  if (sweep.axes.empty()) throw InputError(fmt::format("{}: nothing to sweep", where), ExitCode::usage);
  refuse_shared_paths(sweep.axes, where);
  name_axes(sweep.axes);
  const std::vector<std::size_t> order = order_of_writing(sweep.axes);
  const auto several =
      std::count_if(sweep.axes.begin(), sweep.axes.end(), [](const SweepAxis& axis) { return axis.values.size() > 1; });
  for (auto& choice : zip ? zipped(sweep.axes, where) : product(sweep.axes, where)) {
    SweepRun run{.choice = std::move(choice), .scene = scene, .label = {}};
    std::vector<std::string> told;
    for (const std::size_t a : order) apply(sweep.axes[a], sweep.value(run, a), run.scene, known);
    for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
      const SweepAxis& axis = sweep.axes[a];
      const SweepValue& value = sweep.value(run, a);
      // A key with one value does not tell this run from another.
      if (axis.values.size() > 1 || several == 0) told.push_back(axis.label(value));
    }
    run.label = fmt::format("{}", fmt::join(told, ", "));
    sweep.runs.push_back(std::move(run));
  }
  refuse_hopeless_values(sweep);
  return sweep;
}

std::vector<RunRequest> requests_of(const Sweep& sweep) {
  std::vector<RunRequest> requests;
  for (const SweepRun& run : sweep.runs)
    requests.push_back({.scene = run.scene, .label = run.label, .cut = requests.size()});
  return requests;
}

std::vector<std::vector<std::size_t>> lines_along(const Sweep& sweep, std::size_t axis) {
  std::vector<std::vector<std::size_t>> lines;
  std::map<std::vector<std::size_t>, std::size_t> place;  // of the line with these choices of the other axes
  for (std::size_t i = 0; i < sweep.runs.size(); ++i) {
    std::vector<std::size_t> held;
    for (std::size_t a = 0; a < sweep.axes.size(); ++a)
      if (a != axis && !sweep.zip) held.push_back(sweep.runs[i].choice[a]);
    const auto [line, is_new] = place.try_emplace(std::move(held), lines.size());
    if (is_new) lines.emplace_back();
    lines[line->second].push_back(i);
  }
  return lines;
}

}  // namespace kerf::inverse
