#include "inverse/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "forward/scene/scene.hpp"
#include "inverse/scene_kind.hpp"
#include "inverse/sweep_axis.hpp"
#include "models/base/error.hpp"
#include "models/base/quantity.hpp"
#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

/// A value of a knob, and how it is written into a scene.
struct Turn {
  std::string value;
  std::optional<double> number;
  std::vector<std::pair<std::string, double>> numbers;  ///< factors: path and number in consistent units
  std::optional<SweepValue> given;                      ///< anything else
};

struct Knob {
  SweepAxis axis;
  bool scaled = false;
  std::vector<Turn> turns;
};

std::pair<std::string, std::string> split_path(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == path.npos ? std::pair(std::string(), path) : std::pair(path.substr(0, dot), path.substr(dot + 1));
}

/// What the scene has at a numeric path, its fallback included.
std::optional<double> own_number(const Document& scene, const std::string& path) {
  const auto [block, key] = split_path(path);
  const Contents contents = SceneKind::of(scene).read(scene);
  if (!contents.has(block) || !contents.at(block).has(key)) return std::nullopt;
  return contents.at(block).number(key);
}

/// x0.5,x2 behind the equals sign: the factors; nothing for values of any other kind.
std::vector<double> read_factors(const std::string& text, std::string_view where) {
  std::vector<double> factors;
  std::string items = text.substr(text.find('=') + 1) + ",";
  bool others = false;
  for (std::size_t comma; (comma = items.find(',')) != items.npos; items.erase(0, comma + 1)) {
    const std::string item = items.substr(0, comma);
    if (!item.starts_with('x')) {
      others = true;
      continue;
    }
    const auto refuse = [&](const char* why) {
      throw InputError(fmt::format("{}: {}: \"{}\" {}", where, text, item, why), ExitCode::usage);
    };
    try {
      const Quantity factor = split_quantity(item.substr(1));
      if (!factor.unit.empty()) refuse("has a unit; a factor of what the scene has is a pure number");
      if (!(factor.number >= 0)) refuse("is negative");
      factors.push_back(factor.number);
    } catch (const std::invalid_argument&) {
      refuse("is no factor; write for example x0.5");
    }
  }
  if (others && !factors.empty())
    throw InputError(fmt::format("{}: {}: mixes factors and values", where, text), ExitCode::usage);
  return factors;
}

/// The factor applied to every path; nothing when the scene lacks one of them.
std::optional<Turn> scaled(const SweepAxis& axis, double factor, const Document& scene) {
  Turn turn{.value = fmt::format("x {:g}", factor), .number = factor, .numbers = {}, .given = {}};
  for (const std::string& path : axis.paths) {
    const std::optional<double> own = own_number(scene, path);
    if (!own) return std::nullopt;
    const Parameter& parameter = Document::find_number(path, SceneKind::of(scene).blocks(), scene.name());
    double value = factor * *own / consistent_units_in(parameter.unit);
    if (parameter.whole) value = std::round(value);
    turn.numbers.emplace_back(path, value * consistent_units_in(parameter.unit));
    if (axis.paths.size() > 1) continue;
    turn.number = value;
    turn.value = fmt::format("{:g}", value);
  }
  return turn;
}

/// Paths alone, so that their spelling is looked at by the one who knows: "-" is allowed for any key.
SweepAxis parse_paths(const std::string& text, const std::vector<Block>& known, std::string_view where) {
  SweepAxis axis = parse_axis(text.substr(0, text.find('=')) + "=-", known, where);
  axis.values.clear();
  for (const std::string& path : axis.paths) {
    try {
      const Parameter& parameter = Document::find_number(path, known, where);
      axis.unit = axis.paths.size() > 1 ? "1" : parameter.unit;
    } catch (const InputError& error) {
      throw InputError(error.what(), ExitCode::usage);
    }
  }
  return axis;
}

/// A table's name for several of its keys: [window]; else as in a sweep.
void name(Knob& knob) {
  std::vector<SweepAxis> one{knob.axis};
  name_axes(one);
  knob.axis.short_name = one.front().short_name;
  std::set<std::string> blocks;
  for (const std::string& path : knob.axis.paths) blocks.insert(split_path(path).first);
  if (knob.axis.paths.size() > 1 && blocks.size() == 1) knob.axis.short_name = *blocks.begin();
}

std::optional<Knob> read_knob(const std::string& text, const Document& scene, std::string_view where, bool is_default) {
  Knob knob;
  const std::vector<double> factors = read_factors(text, where);
  const std::vector<Block>& known = SceneKind::of(scene).blocks();
  knob.scaled = !factors.empty();
  knob.axis = knob.scaled ? parse_paths(text, known, where) : parse_axis(text, known, where);
  name(knob);
  for (const double factor : factors) {
    std::optional<Turn> turn = scaled(knob.axis, factor, scene);
    if (!turn && is_default) return std::nullopt;
    if (!turn)
      throw InputError(
          fmt::format("{}: {}: the scene has no {} to take a part of; give values", where, text, knob.axis.name()),
          ExitCode::usage);
    knob.turns.push_back(std::move(*turn));
  }
  if (!knob.scaled)
    for (const SweepValue& value : knob.axis.values)
      knob.turns.push_back({.value = value.text, .number = value.shown, .numbers = {}, .given = value});
  return knob;
}

void write(const Knob& knob, const Turn& turn, Document& scene) {
  const std::vector<Block>& known = SceneKind::of(scene).blocks();
  if (turn.given) return apply(knob.axis, *turn.given, scene, known);
  for (const auto& [path, number] : turn.numbers) {
    if (const std::string block = split_path(path).first; !block.empty()) scene.add_table(block, known);
    scene.set_number(path, number, known);
  }
}

/// Does the scene have all that this value would write?
bool has_already(const Knob& knob, const Turn& turn, const Document& scene) {
  std::vector<std::pair<std::string, double>> numbers = turn.numbers;
  if (turn.given) {
    if (turn.given->absent || !knob.axis.numeric) return false;
    for (const std::string& path : knob.axis.paths) numbers.emplace_back(path, turn.given->number);
  }
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](const auto& entry) { return own_number(scene, entry.first) == entry.second; });
}

std::string label_of(const Knob& knob, const Turn& turn) {
  if (turn.given) return knob.axis.label(*turn.given);
  if (knob.axis.paths.size() > 1) return fmt::format("{} {}", knob.axis.short_name, turn.value);
  const std::string& unit = knob.axis.unit;
  return fmt::format("{} = {}{}{}", knob.axis.short_name, turn.value, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

Document reference_of(const Document& scene, const std::vector<std::string>& settings, std::string_view where) {
  Document reference = scene;
  std::vector<Knob> knobs;
  std::vector<SweepAxis> axes;
  std::set<std::string> paths;
  for (const std::string& setting : settings) {
    const Knob& knob = knobs.emplace_back(*read_knob(setting, scene, where, false));
    const auto refuse = [&](const std::string& why) {
      throw InputError(fmt::format("{}: --reference {}: {}", where, setting, why), ExitCode::usage);
    };
    if (knob.turns.size() != 1) refuse("one value belongs here");
    for (const std::string& path : knob.axis.paths)
      if (!paths.insert(path).second) refuse(fmt::format("\"{}\" is set twice", path));
    axes.push_back(knob.axis);
  }
  for (const std::size_t k : order_of_writing(axes)) write(knobs[k], knobs[k].turns.front(), reference);
  SceneKind::of(reference).check(reference);
  return reference;
}

}  // namespace

// What a knob may change by itself, from the coarsest to the finest that a quarter of an hour allows.
const std::vector<std::string>& default_knobs(const Document& scene) {
  static const std::vector<std::string> of_cuts{"resolution.cells_through_chip=x0.5,x0.75,x1.25,x1.5",
                                                "cut.speed=x0.5,x2,x4",
                                                "resolution.courant_number=x0.5,x1.25",
                                                "pic_damping.rate=x0,x4",
                                                "window.ahead+window.behind+window.below+window.above=x0.75,x1.5",
                                                "resolution.cell_stretch=1,2,3",
                                                "resolution.particles_per_cell_side=1,3",
                                                "resolution.single_particle_below=0.5,1,2",
                                                "steady_state.tolerance=x0.25,x4",
                                                "steady_state.not_before=x0.5,x1.5",
                                                "preset=draft,standard,reference"};
  static const std::vector<std::string> of_bodies{"box.cell=x2,x1.5,x0.75",
                                                  "box.particles_per_cell_side=1,3",
                                                  "box.courant_number=x0.5,x1.5",
                                                  "pic_damping.rate=x0,x4",
                                                  "numerics.shape=uGIMP,linear",
                                                  "numerics.transfer=PIC,APIC,XPIC",
                                                  "numerics.stress_update=USF,USL,MUSL,USAVG"};
  return SceneKind::of(scene).has_bodies ? of_bodies : of_cuts;
}

const std::vector<std::string>& default_reference(const Document& scene) {
  static const std::vector<std::string> of_cuts{"resolution.cells_through_chip=x1.5", "cut.speed=x0.5",
                                                "steady_state.tolerance=x0.25"};
  static const std::vector<std::string> of_bodies{"box.cell=x0.5"};
  return SceneKind::of(scene).has_bodies ? of_bodies : of_cuts;
}

std::vector<std::size_t> Study::resolutions() const {
  std::vector<std::size_t> found{as_it_is};
  const std::string cell = SceneKind::of(scene).cell_path();
  for (std::size_t run = 0; run < runs.size(); ++run)
    if (runs[run].knob && knobs[*runs[run].knob].paths == std::vector<std::string>{cell}) found.push_back(run);
  return found;
}

Study lay_out_study(const Document& scene, const std::vector<std::string>& knobs,
                    const std::vector<std::string>& reference, std::string_view where) {
  const SceneKind kind = SceneKind::of(scene);
  kind.check(scene);
  if (!kind.has_bodies && forward::read_scene(scene).grips)
    throw InputError(fmt::format("{}: {}: a specimen in [grips] has no cutting force to study", where, scene.name()),
                     ExitCode::usage);
  Study study{.scene = scene, .knobs = {}, .result = {}, .runs = {}};
  const auto add = [&](std::optional<std::size_t> knob, std::string value, std::optional<double> number, Document run,
                       std::string label) {
    study.runs.push_back({knob, std::move(value), number, std::move(run), std::move(label)});
  };
  add({}, "", {}, reference_of(scene, reference.empty() ? default_reference(scene) : reference, where), "reference");
  add({}, "", {}, scene, "the scene as it is");
  const bool is_default = knobs.empty();
  std::set<std::string> studied;
  for (const std::string& text : is_default ? default_knobs(scene) : knobs) {
    const std::optional<Knob> knob = read_knob(text, scene, where, is_default);
    if (!knob) continue;
    for (const std::string& path : knob->axis.paths)
      if (!studied.insert(path).second)
        throw InputError(fmt::format("{}: \"{}\" is studied twice", where, path), ExitCode::usage);
    study.knobs.push_back({.paths = knob->axis.paths, .short_name = knob->axis.short_name, .unit = knob->axis.unit});
    for (const Turn& turn : knob->turns) {
      if (has_already(*knob, turn, scene)) continue;
      Document run = scene;
      write(*knob, turn, run);
      if (!is_default) kind.check(run);
      add(study.knobs.size() - 1, turn.value, turn.number, std::move(run), label_of(*knob, turn));
    }
  }
  std::vector<std::string> names;
  for (const StudyKnob& knob : study.knobs) names.push_back(knob.short_name);
  for (StudyKnob& knob : study.knobs)
    if (std::count(names.begin(), names.end(), knob.short_name) > 1)
      knob.short_name = fmt::format("{}", knob.paths.front());
  return study;
}

std::vector<RunRequest> requests_of(const Study& study) {
  std::vector<RunRequest> requests;
  for (const StudyRun& run : study.runs)
    requests.push_back({.scene = run.scene, .label = run.label, .cut = requests.size()});
  return requests;
}

}  // namespace kerf::inverse
