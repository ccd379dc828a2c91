#include "forward/bodies/scene.hpp"

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
                      wall("left"),
                      text("right", "the piston, a wall that moves; open only beside a [contact]", {"open", "roller"})
                          .or_else("roller"),
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
            number("piston_speed", "m/s", -1e4, 1e4, "outwards positive").or_else("0 m/s"),
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
      {.path = "gravity",
       .variant = "",
       .meaning = "an acceleration of all that deforms",
       .parameters = {number("x", "m/s^2", -1e9, 1e9, "along x").or_else("0 m/s^2"),
                      number("y", "m/s^2", -1e9, 1e9, "along y").or_else("0 m/s^2")}},
      {.path = "contact",
       .variant = "",
       .meaning = "bodies meet, slide and part, on a grid in the current configuration",
       .parameters =
           {number("friction", "1", 0, 10, "Coulomb's coefficient").or_else("0"),
            text("normal",
                 "of two surfaces at a node: along the larger of their volume gradients (MVG), the average of both "
                 "weighted by volume (AVG), or specified (SN)",
                 {"MVG", "AVG", "SN"})
                .or_else("MVG"),
            number("normal_x", "1", -1, 1, "a specified normal's direction, either way").if_given(),
            number("normal_y", "1", -1, 1, "and along y").if_given(),
            number("screening", "1", 0, 1, "contact only where two bodies fill this much of a node's cell")
                .or_else("0"),
            flag("approach", "contact only where bodies come closer; else they stick once they overlap")
                .or_else("true"),
            text(
                "overlap",
                "contact only where surfaces overlap, by where the points are (position), or by how far they have come "
                "from where they touched at the start (displacement)",
                {"off", "position", "displacement"})
                .or_else("position")}},
      {.path = "pic_damping",
       .variant = "",
       .meaning = "FLIP velocities blended towards PIC; damps where velocity gradients are high",
       .parameters = {number("rate", "1", 0.0, 1.0, "damping per transit of a wave through a cell")}},
  };
  blocks.push_back(numerics_block());
  const std::vector<Parameter> place{
      number("left", "mm", 0, 1e5, "left edge of the rectangle").or_else("0 mm"),
      number("bottom", "mm", 0, 1e5, "lower edge").or_else("0 mm"),
      number("width", "mm", 1e-5, 1e5, "along x; absent: up to the piston").if_given(),
      number("height", "mm", 1e-5, 1e5, "along y; absent: up to the top of the box").if_given(),
      number("angle", "deg", -180, 180, "by which the rectangle is turned about its lower left corner")
          .or_else("0 deg"),
      number("radius", "mm", 1e-5, 1e5, "of a disc: the body is what of it lies in the rectangle").if_given(),
      number("center_x", "mm", -1e5, 1e5, "of the disc").if_given(),
      number("center_y", "mm", -1e5, 1e5, "of the disc").if_given(),
      number("slab_angle", "deg", -180, 180,
             "direction of a line: the body is what of the rectangle lies to the left of it")
          .if_given(),
      number("slab_x", "mm", -1e5, 1e5, "of a place on that line; absent: 0").if_given(),
      number("slab_y", "mm", -1e5, 1e5, "and along y; absent: 0").if_given(),
      number("slab_thickness", "mm", 1e-5, 1e5, "no further from the line than this; absent: however far").if_given(),
      number("slab_period", "mm", 1e-5, 1e5, "and again at every multiple of this; absent: once").if_given(),
      number("velocity_x", "m/s", -1e5, 1e5, "along x, at the start; of a rigid body, what it takes").or_else("0 m/s"),
      number("velocity_y", "m/s", -1e5, 1e5, "along y").or_else("0 m/s")};
  std::vector<Parameter> start = place;
  for (const Parameter& parameter :
       {number("wavelength", "mm", 1e-5, 1e9,
               "at the start the velocity is a sine along x, zero at the left edge; absent: even")
            .if_given(),
        number("spin", "rad/s", -1e9, 1e9, "at the start, about the middle, anticlockwise").or_else("0 rad/s")})
    start.push_back(parameter);
  for (Block& block : laws::body_blocks(start)) blocks.push_back(std::move(block));
  blocks.push_back({.path = "rigid",
                    .variant = "",
                    .meaning = "a body that nothing deforms or deflects",
                    .parameters = place,
                    .repeated = true});
  for (const Parameter& parameter :
       {number("ramp", "ms", 0, 1e6, "time constant in which it takes its velocity, and loses it").or_else("0 ms"),
        number("stop", "ms", 0, 1e9, "time from which it comes to rest").if_given()})
    blocks.back().parameters.push_back(parameter);
  return blocks;
}

}  // namespace

const std::vector<Block>& scene_blocks() {
  static const std::vector<Block> blocks = declare();
  return blocks;
}

}  // namespace kerf::forward::bodies
