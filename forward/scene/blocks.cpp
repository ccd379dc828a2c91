#include "forward/scene/preset.hpp"
#include "forward/scene/scene.hpp"

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
            number(
                "single_particle_below", "1", 0.5, 1e2,
                "depths of cut under the crack plane from which on a cell of the base holds one particle, for material "
                "that stays elastic; a specimen and a log have no base")
                .or_else("100"),
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

}  // namespace

const std::vector<Block>& scene_blocks() {
  static const std::vector<Block> blocks = declare();
  return blocks;
}

}  // namespace kerf::forward
