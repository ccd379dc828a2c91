#include "forward/scene/scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "forward/scene/preset.hpp"
#include "models/base/error.hpp"

namespace kerf::forward {
namespace {

std::vector<Block> declare() {
  std::vector<Block> blocks{
      {.path = "",
       .variant = "",
       .meaning = "the scene itself",
       .parameters = {text("title", "what this scene shows"),
                      text("preset",
                           "what accuracy may cost: gives values to the knobs that `kerf list preset` shows, except "
                           "those that the scene sets itself",
                           {preset_names.begin(), preset_names.end()})
                          .if_given()},
       .required = true},
      {.path = "cohesive",
       .variant = "",
       .meaning = "how the modes act together: failure at (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1",
       .parameters = {number("exponent_n", "1", 0.1, 10, "n, of the mode I term").or_else("1"),
                      number("exponent_m", "1", 0.1, 10, "m, of the mode II term").or_else("1"),
                      text("mixed_mode",
                           "G_I and G_II of the criterion: areas under the laws, the dissipated part of them, or both "
                           "laws coupled at one share of their critical openings (no criterion)",
                           {"areas", "dissipated", "coupled"})
                          .or_else("areas")},
       .required = true},
  };
  for (const Block& law : laws::material_blocks()) blocks.push_back(law);
  for (const char* mode : {"cohesive.mode_I", "cohesive.mode_II"})
    for (const laws::TractionLawKind& law : laws::traction_laws())
      blocks.push_back(
          {.path = mode, .variant = law.name, .meaning = law.meaning, .parameters = law.parameters, .required = true});
  const std::vector<Block> rest{
      {.path = "cut",
       .variant = "",
       .meaning = "the cut: a layer of the given depth is separated along a straight plane",
       .parameters = {number("depth", "mm", 1e-4, 1e2, "depth of cut h"),
                      number("speed", "m/s", 1e-3, 1e3, "tool speed; rate-independent laws only feel its inertia"),
                      number("ramp", "ms", 0.0, 1e3, "time in which the tool reaches its speed").or_else("0 ms"),
                      number("notch", "1", 0.1, 20, "length separated beforehand, in depths of cut").or_else("1"),
                      number("travel", "1", 0.01, 1e3,
                             "longest tool travel, or opening of a specimen, in depths of cut")},
       .required = true},
      {.path = "tool",
       .variant = "",
       .meaning = "a rigid tool whose tip runs in the crack plane; a scene has it or [grips]",
       .parameters =
           {number("rake", "deg", -30, 75, "rake angle alpha, from the normal of the crack plane"),
            number("clearance", "deg", 0.5, 60,
                   "clearance angle, between clearance face and crack plane; 12 deg when neither it nor bevel is given")
                .if_given(),
            number("bevel", "deg", 5, 85, "grinding angle of the tool, 90 deg - rake - clearance; instead of clearance")
                .if_given(),
            number("tip_radius", "mm", 0, 10, "radius of a tip that is round on both sides; 0 is sharp")
                .or_else("0 mm"),
            number(
                "separation_angle", "deg", 5, 165,
                "where the work parts on a round tip, as the angle of the tip's normal from straight down; before the "
                "arc below it stands a dead zone. Only a tip that touches the crack's tip feels it")
                .or_else("115 deg"),
            number("blunting", "1", 0.5, 100,
                   "tool travel over which the tip grows round after the notch, in depths of cut; begun blunt, a tool "
                   "never starts to cut")
                .or_else("5"),
            number("lead_in", "deg", 5, 45,
                   "angle to the crack plane of a face ahead of a sharp tip that holds down the lower side where it "
                   "rises; absent: there is none")
                .if_given()}},
      {.path = "grips",
       .variant = "",
       .meaning = "a cracked specimen pulled apart at its end instead of a cut; cut.notch is its crack, cut.travel the "
                  "opening of a grip, window.ahead its length, all in depths",
       .parameters = {text("arms", "pull both arms (double cantilever beam) or the upper one, the far end clamped",
                           {"both", "upper"}),
                      number("lower_arm", "1", 0.2, 50, "height of the lower arm, in depths of cut").or_else("1"),
                      number("position", "1", 0.1, 10, "of the grips from the end, in depths of cut").or_else("1.5"),
                      number("width", "1", 0.01, 5, "of a grip along the arm, in depths of cut").or_else("0.25"),
                      number("gauge", "1", 0.05, 5, "length over which an arm's rotation is read, in depths of cut")
                          .or_else("0.5")}},
      {.path = "log",
       .variant = "",
       .meaning = "a log that turns against the tool instead of a flat piece of work, and is peeled along a spiral; "
                  "x of the material runs around it, y outwards. A spindle holds what lies deeper than window.below; "
                  "the layer is prepared to part over cut.travel and window.ahead",
       .parameters = {number("radius", "mm", 1e-3, 1e4, "of the log before it is peeled")}},
      {.path = "chip_breaker",
       .variant = "",
       .meaning = "a second iron on the rake face that turns the chip",
       .parameters = {number("distance", "mm", 1e-4, 1e2, "b, from the tip up along the rake face"),
                      number("angle", "deg", -80, 60, "of its face from the crack plane's normal, like a rake angle"),
                      number("land", "mm", 1e-4, 1e2, "length of its face").or_else("2 mm")}},
      {.path = "sole",
       .variant = "",
       .meaning = "the sole of a plane on the uncut surface; give opening or opening_in_depths",
       .parameters =
           {number("opening", "mm", 1e-3, 1e3, "mouth m, from the tip to its front edge along the cut").if_given(),
            number("opening_in_depths", "1", 0.2, 100, "mouth in depths of cut, m/d").if_given(),
            number("corner_radius", "mm", 1e-4, 1e2, "radius of the mouth's front edge").or_else("0.05 mm")}},
      {.path = "nose_bar",
       .variant = "",
       .meaning = "a round bar that presses on the uncut surface ahead of the tool",
       .parameters = {number("lead", "mm", 1e-3, 1e3, "of its lowest point ahead of the tip"),
                      number("radius", "mm", 1e-3, 1e3, "radius of the bar"),
                      number("compression", "mm", 0, 1e2, "how far it lies below the uncut surface").or_else("0 mm")}},
      {.path = "friction",
       .variant = "",
       .meaning = "Coulomb friction on the tool; leave the block out for a frictionless tool",
       .parameters =
           {number("coefficient", "1", 0.0, 2.0, "coefficient of friction mu of the rake face and the tip"),
            number("yield_cap", "1", 0.1, 1.0, "the shear traction never exceeds this share of the shear yield stress")
                .or_else("0.9"),
            number("chip_breaker", "1", 0.0, 2.0, "mu of the chip breaker; absent: the coefficient").if_given(),
            number("sole", "1", 0.0, 2.0, "mu of the sole; absent: the coefficient").if_given(),
            number("nose_bar", "1", 0.0, 2.0, "mu of the nose bar; absent: the coefficient").if_given()}},
      {.path = "bridging",
       .variant = "",
       .meaning = "what the tool does to the bonds that still hold where its edge arrives; absent: it ignores them",
       .parameters = {text("tool", "whether the edge cuts them or leaves them alone", {"cuts", "ignores"})}},
      {.path = "face_friction",
       .variant = "",
       .meaning =
           "Coulomb friction between crack faces without bonds that close on each other; absent: they slide freely",
       .parameters = {number("coefficient", "1", 0.0, 2.0, "coefficient of friction mu of the faces")}},
      {.path = "edge_contact",
       .variant = "",
       .meaning =
           "a worn edge that presses on the freshly cut face and follows it; leave the block out for a sharp edge",
       .parameters =
           {number("press_in", "1", 1e-4, 0.2, "depth to which the edge presses into the face, in depths of cut"),
            number("edge_radius", "1", 0.05, 10.0, "radius of the lower edge, in depths of cut"),
            number("coefficient", "1", 0.0, 2.0, "coefficient of friction of the clearance side").or_else("0")}},
      {.path = "pic_damping",
       .variant = "",
       .meaning = "FLIP velocities blended towards PIC; damps where velocity gradients are high",
       .parameters = {number("rate", "1", 0.0, 1.0, "damping per transit of an elastic wave through a cell")}},
      {.path = "xpic_damping",
       .variant = "",
       .meaning = "FLIP velocities blended towards XPIC of an order m: damps only what the grid cannot resolve",
       .parameters = {number("rate", "1", 0.0, 1.0, "damping per transit of an elastic wave through a cell"),
                      number("order", "1", 2, 10, "m; 1 would be PIC damping").or_else("2")}},
      {.path = "thermostat",
       .variant = "",
       .meaning = "feedback damping that holds the kinetic energy near a share of the elastic energy",
       .parameters = {number("kinetic_share", "1", 1e-6, 1.0, "wanted kinetic energy over elastic energy"),
                      number("gain", "1", 1e-6, 1.0,
                             "damping per transit of an elastic wave through a cell when the energy is twice the "
                             "wanted one")
                          .or_else("0.01")}},
      {.path = "thermal",
       .variant = "",
       .meaning = "plastic work heats the material, which does not grow softer by it; absent: no temperature",
       .parameters =
           {number("temperature", "K", 1.0, 1e4, "of the work before the cut").or_else("293.15 K"),
            number("specific_heat", "J/(kg K)", 1.0, 1e5, "specific heat c"),
            number("taylor_quinney", "1", 0.0, 1.0, "share of the plastic work that becomes heat").or_else("0.9"),
            number("conductivity", "W/(m K)", 1e-6, 1e9,
                   "thermal conductivity k; absent: adiabatic, heat stays where it arises")
                .if_given(),
            number("friction_share", "1", 0.0, 1.0,
                   "share of the work of friction on the tool that stays in the work as heat; absent: none")
                .if_given(),
            number("expansion", "1/K", 0.0, 1e-2,
                   "linear thermal expansion: what is pulled elastically cools by it; absent: it does not")
                .if_given()}},
      {.path = "window",
       .variant = "",
       .meaning =
           "material that is simulated around the tool tip; virgin material is fed ahead, wake and chip end leave",
       .parameters =
           {number("ahead", "1", 2, 100, "length ahead of the tip, in depths of cut").or_else("6"),
            number("behind", "1", 1, 100, "length behind the tip, in depths of cut").or_else("3"),
            number("below", "1", 1, 100, "material below the crack plane, in depths of cut").or_else("4"),
            number("above", "1", 1.5, 100, "height up to which the chip is followed, in depths of cut").or_else("4"),
            number(
                "zone", "mm", 0, 1e2,
                "length added ahead, behind and above whatever the depth: room for a bridging zone or a chip breaker")
                .or_else("0 mm")},
       .required = true},
      {.path = "resolution",
       .variant = "",
       .meaning = "the price of accuracy",
       .parameters =
           {number("cells_through_chip", "1", 2, 64, "grid cells across the depth of cut")
                .in_whole_numbers()
                .or_else("8"),
            number("particles_per_cell_side", "1", 1, 4, "particles along each side of a cell")
                .in_whole_numbers()
                .or_else("2"),
            number("markers_per_cell", "1", 1, 32, "crack-face markers along a cell").in_whole_numbers().or_else("8"),
            number("courant_number", "1", 0.01, 0.9, "time step in transits of an elastic wave through a cell")
                .or_else("0.6"),
            number("cell_stretch", "1", 1, 8,
                   "length of a cell along the cut over its height; for chips that are stiff along the grain")
                .or_else("1"),
            number("contact_stiffness", "1", 0.05, 4,
                   "stiffness of the contacts in multiples of twice the plane-strain modulus per cell")
                .or_else("1")},
       .required = true},
      {.path = "steady_state",
       .variant = "",
       .meaning = "when the cut has told its mean force well enough",
       .parameters = {number("tolerance", "1", 0.0, 0.2, "relative standard error of F_c at which the cut may stop")
                          .or_else("0.002"),
                      number("not_before", "1", 0.5, 1e3, "tool travel before which it never stops, in depths of cut")
                          .or_else("5")},
       .required = true},
  };
  blocks.insert(blocks.end(), rest.begin(), rest.end());
  return blocks;
}

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

const std::vector<Block>& scene_blocks() {
  static const std::vector<Block> blocks = declare();
  return blocks;
}

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
