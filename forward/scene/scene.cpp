#include "forward/scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "forward/scene/preset.hpp"
#include "models/base/error.hpp"

namespace kerf::forward {
namespace {

int whole_number(const Values& values, std::string_view key) {
  const double value = values.number(key);
  if (value != static_cast<double>(static_cast<int>(value)))
    throw InputError(fmt::format("{}: {} = {} must be a whole number", values.where(key), key, value));
  return static_cast<int>(value);
}

MixedMode mixed_mode(const std::string& name) {
  if (name == "dissipated") return MixedMode::dissipated;
  return name == "coupled" ? MixedMode::coupled : MixedMode::areas;
}

Cohesive read_cohesive(const Contents& contents) {
  return {.mode_I = laws::make_traction_law(contents.at("cohesive.mode_I")),
          .mode_II = laws::make_traction_law(contents.at("cohesive.mode_II")),
          .exponent_n = contents.at("cohesive").number("exponent_n"),
          .exponent_m = contents.at("cohesive").number("exponent_m"),
          .mixed_mode = mixed_mode(contents.at("cohesive").text("mixed_mode"))};
}

Tool read_tool(const Values& tool, double cell) {
  constexpr double degree = std::numbers::pi / 180.0;
  Tool result{.rake = tool.number("rake"),
              .clearance = 12.0 * degree,
              .tip_radius = tool.number("tip_radius"),
              .separation = tool.number("separation_angle"),
              .blunting = tool.number("blunting"),
              .lead_in = {}};
  if (tool.has("clearance")) result.clearance = tool.number("clearance");
  if (tool.has("lead_in")) {
    result.lead_in = tool.number("lead_in");
    if (result.tip_radius > 0.0)
      throw InputError(
          fmt::format("{}: a lead_in belongs to a sharp tip; tip_radius has rounded this one", tool.where("lead_in")));
  }
  if (tool.has("bevel")) {
    if (tool.has("clearance"))
      throw InputError(fmt::format("{}: [tool] has bevel and clearance; one follows from the other, so give one",
                                   tool.where("bevel")));
    result.clearance = 0.5 * std::numbers::pi - result.rake - tool.number("bevel");
    if (result.clearance < 0.5 * degree)
      throw InputError(fmt::format(
          "{}: bevel = {:.4g} deg with a rake of {:.4g} deg leaves a clearance of {:.3g} deg "
          "(allowed from 0.5 deg)",
          tool.where("bevel"), tool.number("bevel") / degree, result.rake / degree, result.clearance / degree));
  }
  if (result.tip_radius > 0.0 && result.tip_radius < cell)
    throw InputError(
        fmt::format("{}: tip_radius = {:.4g} mm is less than a cell of {:.4g} mm, which cannot see it; "
                    "take 0 mm for a sharp tip, or more cells_through_chip",
                    tool.where("tip_radius"), result.tip_radius, cell));
  return result;
}

Sole read_sole(const Values& sole, double depth) {
  const bool absolute = sole.has("opening"), relative = sole.has("opening_in_depths");
  if (absolute == relative)
    throw InputError(
        fmt::format("{}: [sole] needs opening or opening_in_depths, and only one of them", sole.where("opening")));
  return {.opening = absolute ? sole.number("opening") : sole.number("opening_in_depths") * depth,
          .corner_radius = sole.number("corner_radius")};
}

Friction read_friction(const Values& friction) {
  const auto own = [&](const char* face) { return friction.number(friction.has(face) ? face : "coefficient"); };
  return {.coefficient = friction.number("coefficient"),
          .yield_cap = friction.number("yield_cap"),
          .chip_breaker = own("chip_breaker"),
          .sole = own("sole"),
          .nose_bar = own("nose_bar")};
}

Log read_log(const Values& log, const Scene& scene) {
  const double depth = scene.cut.depth, radius = log.number("radius") - depth;
  const double core = radius - scene.window.below * depth;
  if (core < 3.0 * scene.cell())
    throw InputError(
        fmt::format("{}: radius = {:.4g} mm leaves the spindle {:.4g} mm below a veneer of {:.4g} mm and window.below "
                    "= {:g} depths "
                    "(allowed from three cells, {:.4g} mm)",
                    log.where("radius"), radius + depth, core, depth, scene.window.below, 3.0 * scene.cell()));
  const Spiral path(radius, depth);
  const double length = (scene.cut.travel + scene.window.ahead) * depth, longest = path.turn_length() - 2.0 * depth;
  if (length > longest)
    throw InputError(fmt::format(
        "{}: cut.travel + window.ahead = {:.4g} depths is more than one turn of a log of {:.4g} mm has (allowed up to "
        "{:.4g})",
        log.where("radius"), length / depth, radius + depth, longest / depth));
  const auto refuse = [&](const char* block, const char* why) {
    throw InputError(fmt::format("{}: a scene with [log] has no {}: {}", log.where("radius"), block, why));
  };
  if (scene.grips) refuse("[grips]", "a specimen does not turn");
  if (scene.sole) refuse("[sole]", "it would slide on a flat surface");
  if (scene.bridging && scene.bridging->cut) refuse("[bridging] tool = \"cuts\"", "the edge is not followed around");
  if (scene.resolution.cell_stretch != 1.0) refuse("resolution.cell_stretch", "its grain has every direction");
  return {.path = path, .core = core, .length = length};
}

Cut read_cut(const Values& cut) {
  return {.depth = cut.number("depth"),
          .speed = cut.number("speed"),
          .ramp = cut.number("ramp"),
          .notch = cut.number("notch"),
          .travel = cut.number("travel")};
}

}  // namespace

Scene read_scene(const Document& document) {
  if (document.has("body"))
    throw InputError(fmt::format(
        "{}:1:1: this scene holds bodies instead of a cut; kerf simulate, check and explain take it", document.name()));
  const Contents contents = with_preset(document).read(scene_blocks());
  const Values& window = contents.at("window");
  const Values& resolution = contents.at("resolution");
  const Values& steady = contents.at("steady_state");
  const Cut cut = read_cut(contents.at("cut"));
  Scene scene{.title = contents.at("").text("title"),
              .material = laws::make_material(contents.at("material")),
              .cohesive = read_cohesive(contents),
              .cut = cut,
              .tool = {},
              .friction = {},
              .edge_contact = {},
              .chip_breaker = {},
              .sole = {},
              .nose_bar = {},
              .bridging = {},
              .face_friction = {},
              .grips = {},
              .log = {},
              .pic_damping = {},
              .xpic_damping = {},
              .thermostat = {},
              .thermal = {},
              .window = {.ahead = window.number("ahead") + window.number("zone") / cut.depth,
                         .behind = window.number("behind") + window.number("zone") / cut.depth,
                         .below = window.number("below"),
                         .above = window.number("above") + window.number("zone") / cut.depth},
              .resolution = {.cells_through_chip = whole_number(resolution, "cells_through_chip"),
                             .particles_per_cell_side = whole_number(resolution, "particles_per_cell_side"),
                             .markers_per_cell = whole_number(resolution, "markers_per_cell"),
                             .courant_number = resolution.number("courant_number"),
                             .cell_stretch = resolution.number("cell_stretch"),
                             .single_particle_below = resolution.number("single_particle_below"),
                             .contact_stiffness = resolution.number("contact_stiffness")},
              .steady_state = {.tolerance = steady.number("tolerance"), .not_before = steady.number("not_before")}};
  const auto block = [&](const char* path) { return contents.has(path) ? &contents.at(path) : nullptr; };
  const Values* grips = block("grips");
  if (const Values* tool = block("tool")) {
    if (grips) throw InputError(fmt::format("{}: a specimen in [grips] has no [tool]", tool->where("rake")));
    scene.tool = read_tool(*tool, scene.cell());
  } else if (!grips) {
    throw InputError(fmt::format("{}: a cut needs the table [tool] (or a specimen the table [grips])",
                                 contents.at("").where("title")));
  }
  if (grips)
    scene.grips = {.both_arms = grips->text("arms") == "both",
                   .position = grips->number("position") * cut.depth,
                   .width = grips->number("width") * cut.depth,
                   .gauge = grips->number("gauge") * cut.depth,
                   .lower_arm = grips->number("lower_arm") * cut.depth};
  if (scene.grips) {
    // Where the end takes half of the kernel away, markers follow the material further in and turn too little.
    const double clear = scene.grips->position - 0.5 * scene.grips->gauge, least = 2.0 * scene.cell_length();
    if (clear < least)
      throw InputError(
          fmt::format("{}: the gauge of the grips begins {:.4g} mm from the specimen's end (allowed from two cells, "
                      "{:.4g} mm): move position in, shorten gauge, or take more cells_through_chip",
                      grips->where("position"), clear, least));
  }
  if (const Values* friction = block("friction")) scene.friction = read_friction(*friction);
  if (const Values* edge = block("edge_contact"))
    scene.edge_contact = {.press_in = edge->number("press_in") * cut.depth,
                          .edge_radius = edge->number("edge_radius") * cut.depth,
                          .friction = edge->number("coefficient")};
  if (scene.edge_contact && scene.tool.lead_in)
    throw InputError(fmt::format("{}: [edge_contact] wears the lower side of the tip round; lead_in needs a sharp one",
                                 contents.at("edge_contact").where("press_in")));
  if (scene.edge_contact && scene.tool.tip_radius > 0.0)
    throw InputError(
        fmt::format("{}: [edge_contact] wears the lower side of a tip that tip_radius has rounded already; "
                    "keep one of them",
                    contents.at("edge_contact").where("press_in")));
  if (const Values* breaker = block("chip_breaker"))
    scene.chip_breaker = {
        .distance = breaker->number("distance"), .angle = breaker->number("angle"), .land = breaker->number("land")};
  if (const Values* sole = block("sole")) scene.sole = read_sole(*sole, cut.depth);
  if (const Values* bar = block("nose_bar"))
    scene.nose_bar = {
        .lead = bar->number("lead"), .radius = bar->number("radius"), .compression = bar->number("compression")};
  if (const Values* bridging = block("bridging")) scene.bridging = {.cut = bridging->text("tool") == "cuts"};
  if (const Values* faces = block("face_friction")) scene.face_friction = {.coefficient = faces->number("coefficient")};
  if (const Values* pic = block("pic_damping")) scene.pic_damping = {.rate = pic->number("rate")};
  if (const Values* xpic = block("xpic_damping"))
    scene.xpic_damping = {.rate = xpic->number("rate"), .order = whole_number(*xpic, "order")};
  if (const Values* thermostat = block("thermostat"))
    scene.thermostat = {.kinetic_share = thermostat->number("kinetic_share"), .gain = thermostat->number("gain")};
  if (const Values* thermal = block("thermal"))
    scene.thermal = {.start = thermal->number("temperature"),
                     .specific_heat = thermal->number("specific_heat"),
                     .taylor_quinney = thermal->number("taylor_quinney"),
                     .conductivity = thermal->has("conductivity") ? thermal->number("conductivity") : 0.0,
                     .friction_share = thermal->has("friction_share") ? thermal->number("friction_share") : 0.0,
                     .expansion = thermal->has("expansion") ? thermal->number("expansion") : 0.0};
  if (scene.thermal && scene.thermal->friction_share > 0.0 && !scene.friction &&
      !(scene.edge_contact && scene.edge_contact->friction > 0.0))
    throw InputError(fmt::format("{}: [thermal] has a friction_share, but no face of the tool rubs (add [friction])",
                                 block("thermal")->where("friction_share")));
  if (const Values* log = block("log")) scene.log = read_log(*log, scene);
  return scene;
}

std::vector<ToolFace> faces_of(const Scene& scene) {
  if (scene.grips) return {};
  std::vector<ToolFace> faces{ToolFace::rake, ToolFace::bottom};
  if (scene.tool.tip_radius > 0.0) faces.push_back(ToolFace::tip);
  if (scene.tool.lead_in) faces.push_back(ToolFace::lead_in);
  if (scene.chip_breaker) faces.push_back(ToolFace::chip_breaker);
  if (scene.sole) faces.push_back(ToolFace::sole);
  if (scene.nose_bar) faces.push_back(ToolFace::nose_bar);
  return faces;
}

double Tool::lowest_point(double radius) const {
  return -radius * (1.0 + std::sin(rake)) / std::cos(rake);
}

}  // namespace kerf::forward
