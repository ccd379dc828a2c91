#include "forward/scene/scene.hpp"

#include <fmt/format.h>

#include "models/base/error.hpp"

namespace kerf::forward {
namespace {

std::vector<Block> declare() {
  std::vector<Block> blocks{
      {.path = "",
       .variant = "",
       .meaning = "the scene itself",
       .parameters = {text("title", "what this scene shows")},
       .required = true},
      laws::J2::block(),
      {.path = "cohesive",
       .variant = "",
       .meaning = "how the modes act together: failure at (G_I/G_Ic)^n + (G_II/G_IIc)^m = 1",
       .parameters = {number("exponent_n", "1", 0.1, 10, "n, of the mode I term").or_else("1"),
                      number("exponent_m", "1", 0.1, 10, "m, of the mode II term").or_else("1")},
       .required = true},
  };
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
                      number("travel", "1", 1.0, 1e3, "longest tool travel, in depths of cut")},
       .required = true},
      {.path = "tool",
       .variant = "",
       .meaning = "a rigid, sharp tool; its tip runs in the crack plane",
       .parameters = {number("rake", "deg", -30, 75, "rake angle alpha, from the normal of the crack plane"),
                      number("clearance", "deg", 0.5, 45, "clearance angle, between clearance face and crack plane")
                          .or_else("12 deg")},
       .required = true},
      {.path = "friction",
       .variant = "",
       .meaning = "Coulomb friction on the rake face; leave the block out for a frictionless tool",
       .parameters = {number("coefficient", "1", 0.0, 2.0, "coefficient of friction mu"),
                      number("yield_cap", "1", 0.1, 1.0,
                             "the shear traction never exceeds this share of the shear yield stress")
                          .or_else("0.9")}},
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
      {.path = "window",
       .variant = "",
       .meaning =
           "material that is simulated around the tool tip; virgin material is fed ahead, wake and chip end leave",
       .parameters =
           {number("ahead", "1", 2, 100, "length ahead of the tip, in depths of cut").or_else("6"),
            number("behind", "1", 1, 100, "length behind the tip, in depths of cut").or_else("3"),
            number("below", "1", 1, 100, "material below the crack plane, in depths of cut").or_else("4"),
            number("above", "1", 1.5, 100, "height up to which the chip is followed, in depths of cut").or_else("4")},
       .required = true},
      {.path = "resolution",
       .variant = "",
       .meaning = "the price of accuracy",
       .parameters = {number("cells_through_chip", "1", 2, 64, "grid cells across the depth of cut").or_else("8"),
                      number("particles_per_cell_side", "1", 1, 4, "particles along each side of a cell").or_else("2"),
                      number("markers_per_cell", "1", 1, 32, "crack-face markers along a cell").or_else("8"),
                      number("courant_number", "1", 0.01, 0.9,
                             "time step in transits of an elastic wave through a cell")
                          .or_else("0.6")},
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

Cohesive read_cohesive(const Contents& contents) {
  return {.mode_I = laws::make_traction_law(contents.at("cohesive.mode_I")),
          .mode_II = laws::make_traction_law(contents.at("cohesive.mode_II")),
          .exponent_n = contents.at("cohesive").number("exponent_n"),
          .exponent_m = contents.at("cohesive").number("exponent_m")};
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
  const Contents contents = document.read(scene_blocks());
  const Values& window = contents.at("window");
  const Values& resolution = contents.at("resolution");
  const Values& steady = contents.at("steady_state");
  Scene scene{
      .title = contents.at("").text("title"),
      .material = laws::J2::from(contents.at("material")),
      .cohesive = read_cohesive(contents),
      .cut = read_cut(contents.at("cut")),
      .tool = {.rake = contents.at("tool").number("rake"), .clearance = contents.at("tool").number("clearance")},
      .friction = {},
      .edge_contact = {},
      .pic_damping = {},
      .window = {.ahead = window.number("ahead"),
                 .behind = window.number("behind"),
                 .below = window.number("below"),
                 .above = window.number("above")},
      .resolution = {.cells_through_chip = whole_number(resolution, "cells_through_chip"),
                     .particles_per_cell_side = whole_number(resolution, "particles_per_cell_side"),
                     .markers_per_cell = whole_number(resolution, "markers_per_cell"),
                     .courant_number = resolution.number("courant_number")},
      .steady_state = {.tolerance = steady.number("tolerance"), .not_before = steady.number("not_before")}};
  if (contents.has("friction")) {
    const Values& friction = contents.at("friction");
    scene.friction = {.coefficient = friction.number("coefficient"), .yield_cap = friction.number("yield_cap")};
  }
  if (contents.has("edge_contact")) {
    const Values& edge = contents.at("edge_contact");
    scene.edge_contact = {.press_in = edge.number("press_in") * scene.cut.depth,
                          .edge_radius = edge.number("edge_radius") * scene.cut.depth,
                          .friction = edge.number("coefficient")};
  }
  if (contents.has("pic_damping")) scene.pic_damping = {.rate = contents.at("pic_damping").number("rate")};
  return scene;
}

}  // namespace kerf::forward
