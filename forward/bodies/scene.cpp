#include "forward/bodies/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/base/error.hpp"

namespace kerf::forward::bodies {
namespace {

std::vector<Block> declare() {
  const auto wall = [](const char* edge) {
    return text(edge, "open, or a wall without friction", {"open", "roller"}).or_else("roller");
  };
  std::vector<Block> blocks{
      {.path = "",
       .variant = "",
       .meaning = "the experiment itself",
       .parameters = {text("title", "what this scene shows"),
                      list("measures", "what to read off the run", {measure_names.begin(), measure_names.end()})},
       .required = true},
      {.path = "box",
       .variant = "",
       .meaning = "the box that the bodies lie in, its lower left corner at the origin",
       .parameters = {number("length", "mm", 1e-4, 1e5, "length along x at the start"),
                      number("height", "mm", 1e-4, 1e5, "height along y"),
                      number("cell", "mm", 1e-5, 1e4, "side of a grid cell; the cells are stretched to fit the box"),
                      number("particles_per_cell_side", "1", 1, 4, "particles along each side of a cell")
                          .in_whole_numbers()
                          .or_else("2"),
                      number("courant_number", "1", 0.01, 0.9,
                             "time step in transits of the fastest wave through a cell")
                          .or_else("0.5"),
                      wall("left"), text("right", "the piston, a wall that moves", {"roller"}).or_else("roller"),
                      wall("bottom"), wall("top")},
       .required = true},
      {.path = "stroke",
       .variant = "",
       .meaning = "a motion of the piston, until one of its conditions holds",
       .parameters =
           {text("heat", "whether heat passes: no temperature at all, adiabatic, or isothermal with a bath",
                 {"none", "adiabatic", "isothermal"})
                .or_else("none"),
            number("temperature", "K", 1.0, 1e5, "of the bath of an isothermal stroke").if_given(),
            number("exchange_time", "ms", 0, 1e6,
                   "in which bodies and bath come to 1/e of their difference; 0: at once")
                .or_else("0 ms"),
            number("piston_speed", "m/s", -1e4, 1e4, "outwards positive"),
            number("ramp", "ms", 0, 1e6, "time constant in which the piston takes that speed").or_else("0 ms"),
            number("longest", "ms", 1e-9, 1e9, "the stroke ends after this time at the latest").if_given(),
            number("until_stretch", "1", 1e-3, 1e3, "length of the box over its first length").if_given(),
            number("until_temperature", "K", 1.0, 1e5, "mean temperature of the bodies").if_given(),
            flag("until_entropy_returns", "until the bodies' entropy is what it was at the start").or_else("false")},
       .required = true,
       .repeated = true},
      {.path = "interface",
       .variant = "",
       .meaning = "springs between two bodies along their common edge: t = D [u]; absent: bodies share their velocity",
       .parameters =
           {number("normal", "MPa/mm", 0, 1e15, "D_n where the faces part"),
            number("compressive", "MPa/mm", 0, 1e15, "D_n where they overlap; absent: as where they part").if_given(),
            number("tangential", "MPa/mm", 0, 1e15, "D_t")}},
      {.path = "conduction",
       .variant = "",
       .meaning =
           "heat flows within bodies, and through walls that are given a temperature; absent: it stays where it is",
       .parameters = {number("conductivity", "W/(m K)", 1e-6, 1e9, "thermal conductivity k"),
                      number("left", "K", 1.0, 1e5, "temperature of this wall").if_given(),
                      number("right", "K", 1.0, 1e5, "temperature of the piston").if_given(),
                      number("bottom", "K", 1.0, 1e5, "temperature of this wall").if_given(),
                      number("top", "K", 1.0, 1e5, "temperature of this wall").if_given()}},
      {.path = "pic_damping",
       .variant = "",
       .meaning = "FLIP velocities blended towards PIC; damps where velocity gradients are high",
       .parameters = {number("rate", "1", 0.0, 1.0, "damping per transit of a wave through a cell")}},
  };
  const std::vector<Parameter> place{
      number("left", "mm", 0, 1e5, "left edge of the rectangle").or_else("0 mm"),
      number("bottom", "mm", 0, 1e5, "lower edge").or_else("0 mm"),
      number("width", "mm", 1e-5, 1e5, "along x; absent: up to the piston").if_given(),
      number("height", "mm", 1e-5, 1e5, "along y; absent: up to the top of the box").if_given()};
  for (Block& block : laws::body_blocks(place)) blocks.push_back(std::move(block));
  return blocks;
}

template <class Names>
std::size_t index_of(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

BodyPlan read_body(const Values& values, double length, double height) {
  BodyPlan body{.law = laws::make_body_law(values),
                .left = values.number("left"),
                .bottom = values.number("bottom"),
                .width = 0,
                .height = 0,
                .where = values.where("law")};
  const double room_x = length - body.left, room_y = height - body.bottom;
  body.width = values.has("width") ? values.number("width") : room_x;
  body.height = values.has("height") ? values.number("height") : room_y;
  constexpr double rounding = 1.0 + 1e-9;
  if (!(body.width > 0.0) || !(body.height > 0.0) || body.width > room_x * rounding || body.height > room_y * rounding)
    throw InputError(
        fmt::format("{}: [[body]] of {:.4g} x {:.4g} mm at ({:.4g}, {:.4g}) mm does not fit into the box "
                    "of {:.4g} x {:.4g} mm",
                    body.where, body.width, body.height, body.left, body.bottom, length, height));
  std::visit(
      [&](const auto& law) {
        if constexpr (std::decay_t<decltype(law)>::is_thermal)
          body.temperature = values.has("temperature") ? values.number("temperature") : law.reference;
      },
      body.law);
  return body;
}

Stroke read_stroke(const Values& values, bool thermal) {
  const std::string& heat = values.text("heat");
  Stroke stroke{.heat = heat == "none"        ? Heat::none
                        : heat == "adiabatic" ? Heat::adiabatic
                                              : Heat::isothermal,
                .temperature = values.has("temperature") ? values.number("temperature") : 0.0,
                .exchange_time = values.number("exchange_time"),
                .speed = values.number("piston_speed"),
                .ramp = values.number("ramp"),
                .until_stretch = {},
                .until_temperature = {},
                .until_entropy_returns = values.flag("until_entropy_returns")};
  if (values.has("longest")) stroke.longest = values.number("longest");
  if (values.has("until_stretch")) stroke.until_stretch = values.number("until_stretch");
  if (values.has("until_temperature")) stroke.until_temperature = values.number("until_temperature");
  const auto refuse = [&](const char* key, const std::string& why) {
    throw InputError(fmt::format("{}: [[stroke]] {}", values.where(key), why));
  };
  if (thermal == (stroke.heat == Heat::none))
    refuse("heat", thermal ? "has heat = \"none\", but a body has a temperature (allowed: adiabatic, isothermal)"
                           : fmt::format("has heat = \"{}\", but no body has a temperature (allowed: none)", heat));
  if ((stroke.heat == Heat::isothermal) != values.has("temperature"))
    refuse("temperature", stroke.heat == Heat::isothermal
                              ? "is isothermal and lacks the key \"temperature\" of its bath"
                              : "has a temperature, but only an isothermal one has a bath");
  if (!stroke.until_stretch && !stroke.until_temperature && !stroke.until_entropy_returns && !values.has("longest"))
    refuse("piston_speed", "never ends: give until_stretch, until_temperature, until_entropy_returns or longest");
  if (stroke.until_temperature && stroke.heat != Heat::adiabatic)
    refuse("until_temperature", "waits for a temperature, which only an adiabatic one reaches");
  return stroke;
}

}  // namespace

bool Scene::is_thermal() const {
  return std::any_of(bodies.begin(), bodies.end(), [](const BodyPlan& body) {
    return std::visit([](const auto& law) { return std::decay_t<decltype(law)>::is_thermal; }, body.law);
  });
}

bool has_bodies(const Document& document) {
  return document.has("body") || document.has("box");
}

const std::vector<Block>& scene_blocks() {
  static const std::vector<Block> blocks = declare();
  return blocks;
}

Scene read_scene(const Document& document) {
  const Contents contents = document.read(scene_blocks());
  const Values& top_level = contents.at("");
  const Values& box = contents.at("box");
  Scene scene{.title = top_level.text("title"),
              .length = box.number("length"),
              .height = box.number("height"),
              .cell = box.number("cell"),
              .particles_per_cell_side = static_cast<int>(box.number("particles_per_cell_side")),
              .courant_number = box.number("courant_number"),
              .walls = {},
              .bodies = {},
              .strokes = {},
              .interface = {},
              .conduction = {},
              .pic_damping = {},
              .measures = {}};
  for (const std::string& name : top_level.list("measures"))
    scene.measures.push_back(static_cast<Measure>(index_of(measure_names, name)));
  for (std::size_t edge = 0; edge < edge_names.size(); ++edge)
    scene.walls[edge] = box.text(edge_names[edge]) == "open" ? Wall::open : Wall::roller;
  if (scene.cell > 0.25 * std::min(scene.length, scene.height))
    throw InputError(
        fmt::format("{}: cell = {:.4g} mm leaves less than four cells along a side of the box of {:.4g} x "
                    "{:.4g} mm",
                    box.where("cell"), scene.cell, scene.length, scene.height));
  for (const Values& body : contents.all("body")) scene.bodies.push_back(read_body(body, scene.length, scene.height));
  const bool thermal = scene.is_thermal();
  for (const Values& stroke : contents.all("stroke")) scene.strokes.push_back(read_stroke(stroke, thermal));
  double stretch = 1.0;
  for (std::size_t i = 0; i < scene.strokes.size(); ++i) {
    const Stroke& stroke = scene.strokes[i];
    if (!stroke.until_stretch) continue;
    // After strokes that end on another condition nobody knows yet from where this one starts.
    const bool known = i == 0 || scene.strokes[i - 1].until_stretch.has_value();
    if (known && (*stroke.until_stretch - stretch) * stroke.speed <= 0.0)
      throw InputError(fmt::format(
          "{}: [[stroke]] cannot reach until_stretch = {:g} from {:g} at a piston_speed of {:g} m/s",
          contents.all("stroke")[i].where("until_stretch"), *stroke.until_stretch, stretch, stroke.speed / 1e3));
    stretch = *stroke.until_stretch;
  }
  if (contents.has("interface")) {
    const Values& values = contents.at("interface");
    if (scene.bodies.size() != 2)
      throw InputError(fmt::format("{}: [interface] joins two bodies; this scene has {}", values.where("normal"),
                                   scene.bodies.size()));
    const double normal = values.number("normal");
    scene.interface = {.normal = normal,
                       .compressive = values.has("compressive") ? values.number("compressive") : normal,
                       .tangential = values.number("tangential")};
  }
  if (contents.has("conduction")) {
    const Values& values = contents.at("conduction");
    if (!thermal)
      throw InputError(
          fmt::format("{}: [conduction] needs a body with a temperature (allowed: ideal_gas, ideal_rubber, "
                      "mie_gruneisen)",
                      values.where("conductivity")));
    scene.conduction = {.conductivity = values.number("conductivity"), .wall_temperature = {}};
    for (std::size_t edge = 0; edge < edge_names.size(); ++edge) {
      if (!values.has(edge_names[edge])) continue;
      if (scene.walls[edge] == Wall::open)
        throw InputError(fmt::format("{}: the {} edge of the [box] is open; only a wall has a temperature",
                                     values.where(edge_names[edge]), edge_names[edge]));
      scene.conduction->wall_temperature[edge] = values.number(edge_names[edge]);
    }
  }
  if (contents.has("pic_damping")) scene.pic_damping = {.rate = contents.at("pic_damping").number("rate")};
  return scene;
}

}  // namespace kerf::forward::bodies
