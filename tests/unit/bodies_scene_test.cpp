// Scenes of bodies: what is wrong is said with its place, and what a scene does not name has no stage and no byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "forward/bodies/step.hpp"
#include "models/base/error.hpp"
#include "tests/shipped_scene.hpp"
#include "tests/unit/run_kerf.hpp"

namespace kerf::forward::bodies {
namespace {

using kerf::testing::replaced;
using kerf::testing::shipped_text;

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string complaint(const std::string& text) {
  try {
    read_scene(Document::parse(text, "bodies.toml"));
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_data);
    return error.what();
  }
  return "no complaint";
}

std::vector<std::string> stages_of(const std::string& text) {
  const Scene scene = read_scene(Document::parse(text, "bodies.toml"));
  State state = lay_out(scene);
  Joint joint(state, scene);
  std::vector<std::string> names;
  for (const Stage& stage : plan(scene, joint)) names.push_back(stage.name);
  return names;
}

TEST(BodiesScene, BadInputIsSaidWithItsPlace) {
  const std::string gas = shipped_text("carnot_gas");
  EXPECT_THAT(complaint(replaced(gas, "\"600 K\"\nheat_ratio", "\"-600 K\"\nheat_ratio")), HasSubstr("reference_temp"));
  EXPECT_THAT(complaint(replaced(gas, "heat_ratio", "heat_ration")), HasSubstr("did you mean \"heat_ratio\""));
  EXPECT_THAT(complaint(replaced(gas, "ideal_gas", "ideal_gaz")), HasSubstr("did you mean \"ideal_gas\""));
  EXPECT_THAT(complaint(replaced(gas, "until_stretch = 2", "until_stretch = 0.5")), HasSubstr("cannot reach"));
  EXPECT_THAT(complaint(replaced(gas, "until_stretch = 2", "")), HasSubstr("never ends"));
  EXPECT_THAT(complaint(replaced(gas, "temperature = \"600 K\"\npiston", "piston")), HasSubstr("lacks the key \"temp"));
  EXPECT_THAT(complaint(replaced(gas, "\"adiabatic\"", "\"none\"")), HasSubstr("a body has a temperature"));
  EXPECT_THAT(complaint(replaced(gas, "cell = \"1 mm\"", "cell = \"3 mm\"")), HasSubstr("less than four cells"));
  EXPECT_THAT(complaint(replaced(gas, "[[body]]", "[[body]]\nwidth = \"11 mm\"")), HasSubstr("does not fit"));
  EXPECT_THAT(complaint(gas + "\n[interface]\nnormal = \"1 MPa/mm\"\ntangential = \"1 MPa/mm\"\n"),
              HasSubstr("joins two bodies"));
  const std::string bar = shipped_text("interface_bar");
  EXPECT_THAT(complaint(replaced(bar, "normal = \"10 MPa", "normal = \"-10 MPa")), HasSubstr("normal"));
  EXPECT_THAT(complaint(replaced(bar, "[[body]]", "[[body]]\nslab_x = \"1 mm\"")), HasSubstr("lacks \"slab_angle\""));
  const std::string laminate = shipped_text("laminate");
  EXPECT_THAT(complaint(replaced(laminate, "\"34 mm\"", "\"16 mm\"")), HasSubstr("more than its slab_thickness"));
  EXPECT_THAT(complaint(replaced(laminate, "\"-120 deg\"", "\"60 deg\"")), HasSubstr("both hold the place"));
  EXPECT_THAT(complaint(bar + "\n[conduction]\nconductivity = \"1 W/(m K)\"\n"),
              HasSubstr("a body with a temperature"));
}

TEST(BodiesScene, BadContactIsSaidWithItsPlace) {
  const std::string incline = shipped_text("incline");
  EXPECT_THAT(complaint(replaced(incline, "friction = 0.3", "friction = -0.3")), HasSubstr("friction"));
  EXPECT_THAT(complaint(replaced(incline, "\"SN\"", "\"MVQ\"")), HasSubstr("MVG"));
  EXPECT_THAT(complaint(replaced(replaced(incline, "normal_x = -0.5", ""), "normal_y = 0.8660254037844386", "")),
              HasSubstr("lacks normal_x"));
  EXPECT_THAT(complaint(replaced(incline, "\"SN\"", "\"MVG\"")), HasSubstr("only normal = \"SN\""));
  EXPECT_THAT(complaint(replaced(incline, "left = \"30.713 mm\"", "left = \"53 mm\"")), HasSubstr("does not fit"));
  EXPECT_THAT(complaint(replaced(incline, "bottom = \"21.465 mm\"", "bottom = \"20 mm\"")),
              HasSubstr("both hold the place"));
  EXPECT_THAT(complaint(replaced(incline, "width = \"16 mm\"", "width = \"16 mm\"\nradius = \"3 mm\"")),
              HasSubstr("\"center_x\" of its disc"));
  EXPECT_THAT(complaint(incline.substr(0, incline.find("[contact]")) + incline.substr(incline.find("[[stroke]]"))),
              HasSubstr("only through a [contact]"));
  EXPECT_THAT(complaint(replaced(incline, "longest", "piston_speed = \"1 m/s\"\nlongest")),
              HasSubstr("holds the piston still"));
}

TEST(BodiesScene, TemperaturesOfYieldingBodiesAreAskedForWhole) {
  const std::string bar = shipped_text("interface_bar"), law = "law = \"j2\"\n",
                    heat = "specific_heat = \"1 kJ/(kg K)\"\n";
  EXPECT_THAT(complaint(replaced(bar, law, law + "taylor_quinney = 0.9\n")), HasSubstr("lacks \"specific_heat\""));
  EXPECT_THAT(complaint(replaced(bar, law, law + heat)), HasSubstr("a body has a temperature"));
  const auto stroke = [&](const std::string& how) {
    std::string text = replaced(bar, law, law + heat);
    for (const char* begin : {"piston_speed = \"0.02", "piston_speed = \"0 "})
      text = replaced(text, begin, how + begin);
    return text;
  };
  EXPECT_THAT(complaint(stroke("heat = \"isothermal\"\ntemperature = \"300 K\"\n")),
              HasSubstr("only heats by yielding"));
  const State state = lay_out(read_scene(Document::parse(stroke("heat = \"adiabatic\"\n"), "bar.toml")));
  EXPECT_EQ(state.bodies[0].points.temperature.size(), state.bodies[0].points.size());
  EXPECT_EQ(state.bodies[1].points.temperature.capacity(), 0u);
  EXPECT_EQ(stages_of(stroke("heat = \"adiabatic\"\n")), stages_of(bar));
}

TEST(BodiesScene, BadNumericsAreSaidWithTheirPlace) {
  const auto gas = [](const std::string& keys) {
    return complaint(shipped_text("carnot_gas") + "\n[numerics]\n" + keys + "\n");
  };
  EXPECT_THAT(gas("shape = \"splime\""), HasSubstr("did you mean \"spline\""));
  EXPECT_THAT(gas("transfer = \"APIK\""), HasSubstr("FLIP"));
  EXPECT_THAT(gas("xpic_order = 3"), HasSubstr("is for transfer = \"XPIC\""));
  EXPECT_THAT(gas("transfer = \"APIC\""), HasSubstr("leaves [pic_damping] nothing to do"));
  EXPECT_THAT(gas("frame = \"current\""), HasSubstr("holds the piston still"));
  EXPECT_THAT(gas("frame = \"current\"\nstress_update = \"MUSL\""), HasSubstr("allowed: USF, USL"));
  for (const auto& [keys, who] :
       {std::pair{"transfer = \"APIC\"", "APIC sees"}, {"stress_update = \"USL\"", "USL sees"}})
    EXPECT_THAT(gas(std::string("frame = \"current\"\nshape = \"linear\"\n") + keys),
                ::testing::AllOf(HasSubstr("hardly any mass"), HasSubstr(who)));
  EXPECT_THAT(complaint(shipped_text("interface_bar") + "\n[numerics]\nshape = \"linear\"\n"),
              HasSubstr("with an [interface] is \"spline\""));
  EXPECT_THAT(complaint(shipped_text("incline") + "\n[numerics]\nshape = \"uGIMP\"\n"),
              HasSubstr("with [contact] is \"spline\""));
}

TEST(BodiesScene, AnAbsentEffectHasNoStageAndNoByte) {
  EXPECT_THAT(stages_of(shipped_text("carnot_gas")),
              ElementsAre("project", "strain", "accelerate", "advance", "piston"));
  EXPECT_THAT(stages_of(shipped_text("interface_bar")),
              ElementsAre("project", "share", "strain", "accelerate", "join", "advance", "piston"));
  EXPECT_THAT(stages_of(shipped_text("carnot_gas") + "\n[conduction]\nconductivity = \"1 W/(m K)\"\n"),
              ElementsAre("project", "strain", "conduct", "accelerate", "advance", "piston"));
  EXPECT_THAT(stages_of(shipped_text("incline")),
              ElementsAre("project", "meet", "strain", "gravity", "accelerate", "touch", "advance", "push", "piston"));
  EXPECT_THAT(stages_of(shipped_text("friction_heat")),
              ElementsAre("project", "meet", "strain", "gravity", "accelerate", "touch", "warm", "advance", "piston"));
  const std::string gas = shipped_text("carnot_gas");
  const std::string undamped = gas.substr(0, gas.find("[pic_damping]"));
  EXPECT_THAT(stages_of(gas + "\n[numerics]\nstress_update = \"USL\"\n"),
              ElementsAre("project", "push", "accelerate", "strain", "advance", "piston"));
  EXPECT_THAT(stages_of(gas + "\n[numerics]\nstress_update = \"USAVG\"\n"),
              ElementsAre("project", "strain", "accelerate", "advance", "project", "strain", "piston"));
  EXPECT_THAT(stages_of(undamped + "\n[numerics]\ntransfer = \"XPIC\"\n"),
              ElementsAre("project", "strain", "accelerate", "filter", "advance", "piston"));
  const State bar = lay_out(read_scene(Document::parse(shipped_text("interface_bar"), "bar.toml")));
  EXPECT_EQ(bar.bodies[0].points.affine.xx.capacity(), 0u);
  EXPECT_EQ(bar.bodies[0].points.temperature.capacity(), 0u);
  EXPECT_EQ(bar.bodies[0].points.memory.size(), 1u);
  EXPECT_EQ(bar.bodies[0].field.filtered.capacity(), 0u);
  EXPECT_TRUE(bar.contact.presence.empty() && bar.contact.rigids.empty() && bar.contact.heat.empty() &&
              bar.contact.velocity.empty());
}

TEST(BodiesScene, BodiesFillTheirRectangles) {
  const State bar = lay_out(read_scene(Document::parse(shipped_text("interface_bar"), "bar.toml")));
  for (const Body& body : bar.bodies) {
    double volume = 0;
    for (const double part : body.points.volume) volume += part;
    EXPECT_NEAR(volume, 200.0, 1e-9);
  }
}

TEST(BodiesScene, SimulateKeepsAndPrintsWhatTheSceneIsFor) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "kerf_bodies";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const ProcessOutput run = run_kerf("simulate '" KERF_SOURCE_DIR "/data/scenes/interface_bar.toml' --json -o '" +
                                         (folder / "bar.json").string() + "'",
                                     folder);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto printed = nlohmann::json::parse(run.out), kept = nlohmann::json::parse(content_of(folder / "bar.json"));
  EXPECT_EQ(printed, kept);
  EXPECT_LT(printed.at("results").at("effective_modulus_error").get<double>(), 5e-3);
  const std::string file = "report '" + (folder / "bar.json").string() + "'";
  EXPECT_EQ(run_kerf(file, folder).exit_code, 0);
  EXPECT_THAT(content_of(folder / "bar.html"), HasSubstr("effective modulus error"));
  std::ofstream(folder / "bar.json") << "{\"a\": 1}";
  const ProcessOutput broken = run_kerf(file, folder);
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("bar.json: not what `kerf simulate -o` keeps of bodies"));
  EXPECT_EQ(run_kerf("check '" KERF_SOURCE_DIR "/data/scenes/carnot_gas.toml'", folder).exit_code, 0);
  EXPECT_THAT(run_kerf("explain '" KERF_SOURCE_DIR "/data/scenes/carnot_gas.toml'", folder).out,
              HasSubstr("Not simulated"));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace kerf::forward::bodies
