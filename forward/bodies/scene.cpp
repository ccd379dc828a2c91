#include "forward/bodies/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/base/error.hpp"

namespace kerf::forward::bodies {
namespace {

template <class Names>
std::size_t index_of(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::optional<Shape::Slab> read_slab(const Values& values, const char* block) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto given = [&](const char* key, double otherwise) {
    return values.has(key) ? values.number(key) : otherwise;
  };
  if (!values.has("slab_angle")) {
    for (const char* key : {"slab_x", "slab_y", "slab_thickness", "slab_period"})
      if (values.has(key))
        throw InputError(
            fmt::format("{}: [[{}]] has the key \"{}\" and lacks \"slab_angle\"", values.where(key), block, key));
    return {};
  }
  const Shape::Slab slab{.x = given("slab_x", 0.0),
                         .y = given("slab_y", 0.0),
                         .angle = values.number("slab_angle"),
                         .thickness = given("slab_thickness", infinite),
                         .period = given("slab_period", infinite)};
  if (std::isfinite(slab.period) && !(slab.thickness < slab.period))
    throw InputError(fmt::format("{}: [[{}]] repeats its slab after {:.4g} mm (allowed: more than its slab_thickness)",
                                 values.where("slab_period"), block, slab.period));
  return slab;
}

Shape read_shape(const Values& values, const char* block, double length, double height) {
  Shape shape{.left = values.number("left"),
              .bottom = values.number("bottom"),
              .width = 0,
              .height = 0,
              .angle = values.number("angle"),
              .disc = {},
              .slab = read_slab(values, block)};
  shape.width = values.has("width") ? values.number("width") : length - shape.left;
  shape.height = values.has("height") ? values.number("height") : height - shape.bottom;
  const double rounding = 1e-9 * (length + height);
  bool fits = shape.width > 0.0 && shape.height > 0.0;
  for (const Place& corner : shape.corners())
    fits &=
        corner.x > -rounding && corner.x < length + rounding && corner.y > -rounding && corner.y < height + rounding;
  if (!fits)
    throw InputError(
        fmt::format("{}: [[{}]] of {:.4g} x {:.4g} mm at ({:.4g}, {:.4g}) mm{} does not fit into the box "
                    "of {:.4g} x {:.4g} mm",
                    values.where("width"), block, shape.width, shape.height, shape.left, shape.bottom,
                    shape.angle != 0.0 ? ", turned," : "", length, height));
  if (shape.slab && divide(shape, shape.width / 64, shape.height / 64).empty())
    throw InputError(
        fmt::format("{}: [[{}]] has no part of its slab in its rectangle", values.where("slab_angle"), block));
  if (!values.has("radius") && !values.has("center_x") && !values.has("center_y")) return shape;
  for (const char* key : {"radius", "center_x", "center_y"})
    if (!values.has(key))
      throw InputError(fmt::format("{}: [[{}]] lacks the key \"{}\" of its disc", values.where("law"), block, key));
  shape.disc = {.x = values.number("center_x"), .y = values.number("center_y"), .radius = values.number("radius")};
  if (divide(shape, shape.width / 64, shape.height / 64).empty())
    throw InputError(fmt::format("{}: [[{}]] has no part of its disc in its rectangle", values.where("radius"), block));
  return shape;
}

BodyPlan read_body(const Values& values, double length, double height) {
  BodyPlan body{.law = laws::make_body_law(values),
                .shape = read_shape(values, "body", length, height),
                .velocity_x = values.number("velocity_x"),
                .velocity_y = values.number("velocity_y"),
                .wavelength = values.has("wavelength") ? values.number("wavelength") : 0.0,
                .spin = values.number("spin"),
                .where = values.where("law")};
  if (laws::heat_capacity(body.law) > 0.0)
    body.temperature = values.has("temperature") ? values.number("temperature") : laws::reference_temperature(body.law);
  return body;
}

RigidPlan read_rigid(const Values& values, double length, double height) {
  return {.shape = read_shape(values, "rigid", length, height),
          .velocity_x = values.number("velocity_x"),
          .velocity_y = values.number("velocity_y"),
          .ramp = values.number("ramp"),
          .stop = values.has("stop") ? values.number("stop") : std::numeric_limits<double>::infinity(),
          .where = values.where("left")};
}

/// No place belongs to two bodies, as seen at every quarter of a cell.
void refuse_shared_places(const Scene& scene) {
  struct One {
    const Shape* shape;
    const std::string* where;
  };
  std::vector<One> all;
  for (const BodyPlan& body : scene.bodies) all.push_back({&body.shape, &body.where});
  for (const RigidPlan& rigid : scene.rigids) all.push_back({&rigid.shape, &rigid.where});
  for (const One& a : all)
    for (const Part& part : divide(*a.shape, 0.25 * scene.cell, 0.25 * scene.cell))
      for (const One& b : all)
        if (&a != &b && b.shape->contains(part.at, 0.01 * scene.cell))
          throw InputError(fmt::format("{}: this body and the one at {} both hold the place ({:.4g}, {:.4g}) mm",
                                       *a.where, *b.where, part.at.x, part.at.y));
}

void refuse_what_numerics_exclude(const Scene& scene, const Contents& contents) {
  if (!contents.has("numerics")) return;
  const Values& values = contents.at("numerics");
  const auto refuse = [&](const char* key, const char* why) {
    throw InputError(fmt::format("{}: [numerics] {}", values.where(key), why));
  };
  if (scene.pic_damping && !std::holds_alternative<Flip>(scene.numerics.transfer))
    refuse("transfer", "leaves [pic_damping] nothing to do: it blends FLIP with PIC (allowed: FLIP)");
  if (scene.interface && scene.numerics.shape.index() != 0)
    refuse("shape", "of a scene with an [interface] is \"spline\"");
  if (contents.has("contact") && scene.is_thermal() && scene.numerics.shape.index() != 0)
    refuse("shape", "of a scene whose friction warms bodies is \"spline\"");
  if (scene.interface && scene.numerics.stress_update != StressUpdate::first)
    refuse("stress_update", "of a scene with an [interface] is \"USF\": its springs pull once in a step");
  if (scene.numerics.frame == Frame::reference || contents.has("contact")) return;
  if (scene.interface || scene.conduction) refuse("frame", "= \"current\" excludes [interface] and [conduction]");
  for (const Stroke& stroke : scene.strokes)
    if (stroke.speed != 0.0 || stroke.until_stretch) refuse("frame", "= \"current\" holds the piston still");
}

Contact read_contact(const Values& values, const Scene& scene) {
  const std::string &normal = values.text("normal"), &overlap = values.text("overlap");
  Contact contact{.friction = values.number("friction"),
                  .normal = normal == "MVG"   ? Normal::largest_gradient
                            : normal == "AVG" ? Normal::mean_gradient
                                              : Normal::specified,
                  .screening = values.number("screening"),
                  .approach = values.flag("approach"),
                  .overlap = overlap == "off"        ? Overlap::off
                             : overlap == "position" ? Overlap::position
                                                     : Overlap::displacement};
  const auto refuse = [&](const char* key, const std::string& why) {
    throw InputError(fmt::format("{}: [contact] {}", values.where(key), why));
  };
  if ((contact.normal == Normal::specified) != (values.has("normal_x") || values.has("normal_y")))
    refuse("normal", contact.normal == Normal::specified
                         ? "has normal = \"SN\" and lacks normal_x and normal_y"
                         : fmt::format("has a direction, which only normal = \"SN\" uses (found: \"{}\")", normal));
  if (contact.normal == Normal::specified) {
    const double x = values.has("normal_x") ? values.number("normal_x") : 0.0;
    const double y = values.has("normal_y") ? values.number("normal_y") : 0.0;
    const double length = std::hypot(x, y);
    if (!(length > 0.0)) refuse("normal_x", "has a normal of no length");
    contact.normal_x = x / length;
    contact.normal_y = y / length;
  }
  if (scene.bodies.size() + scene.rigids.size() < 2)
    refuse("normal", "needs a second [[body]], or a [[rigid]] one, to touch");
  if (scene.interface) refuse("normal", "and [interface] exclude each other: joined faces do not part");
  if (scene.conduction) refuse("normal", "and [conduction] exclude each other: heat would cross gaps");
  for (const Stroke& stroke : scene.strokes)
    if (stroke.speed != 0.0 || stroke.until_stretch)
      refuse("normal",
             "holds the piston still: it is a [[rigid]] body that pushes (allowed: strokes without "
             "piston_speed and until_stretch)");
  return contact;
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
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const BodyPlan& body) { return laws::heat_capacity(body.law) > 0.0; });
}

bool has_bodies(const Document& document) {
  return document.has("body") || document.has("box");
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
              .numerics = {},
              .walls = {},
              .bodies = {},
              .strokes = {},
              .interface = {},
              .conduction = {},
              .pic_damping = {},
              .rigids = {},
              .gravity = {},
              .contact = {},
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
  for (const Values& rigid : contents.all("rigid"))
    scene.rigids.push_back(read_rigid(rigid, scene.length, scene.height));
  const bool thermal = scene.is_thermal();
  for (const Values& stroke : contents.all("stroke")) scene.strokes.push_back(read_stroke(stroke, thermal));
  for (std::size_t i = 0; i < scene.strokes.size(); ++i)
    for (const BodyPlan& body : scene.bodies)
      if (scene.strokes[i].heat == Heat::isothermal && !laws::is_thermal(body.law))
        throw InputError(
            fmt::format("{}: [[stroke]] has heat = \"isothermal\", but the body at {} only heats by yielding (allowed: "
                        "adiabatic)",
                        contents.all("stroke")[i].where("heat"), body.where));
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
          fmt::format("{}: [conduction] needs a body with a temperature (ideal_gas, ideal_rubber, "
                      "mie_gruneisen, or any with a specific_heat)",
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
  if (contents.has("gravity"))
    scene.gravity = {.x = contents.at("gravity").number("x"), .y = contents.at("gravity").number("y")};
  scene.numerics = read_numerics(contents.has("numerics") ? &contents.at("numerics") : nullptr,
                                 scene.particles_per_cell_side, contents.has("contact"));
  refuse_what_numerics_exclude(scene, contents);
  if (contents.has("contact")) scene.contact = read_contact(contents.at("contact"), scene);
  if (!scene.contact && !scene.rigids.empty())
    throw InputError(fmt::format("{}: a [[rigid]] body is felt only through a [contact]", scene.rigids[0].where));
  if (scene.numerics.frame == Frame::reference && scene.walls[right] == Wall::open)
    throw InputError(
        fmt::format("{}: right = \"open\", but without a [contact] the right wall is the piston (allowed: roller)",
                    box.where("right")));
  refuse_shared_places(scene);
  return scene;
}

}  // namespace kerf::forward::bodies
