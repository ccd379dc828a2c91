// Blocks of a scene that exclude or need one another: what is wrong is said with its place.
#include "forward/scene/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "models/base/error.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using kerf::testing::replaced;
using kerf::testing::shipped_text;

using ::testing::HasSubstr;

std::string complaint(const std::string& text) {
  try {
    read_scene(Document::parse(text, "cut.toml"));
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_data);
    return error.what();
  }
  ADD_FAILURE() << "was read without complaint";
  return {};
}

int line_of(const std::string& text, const std::string& what) {
  const auto at = text.begin() + static_cast<std::ptrdiff_t>(text.find(what));
  return 1 + static_cast<int>(std::count(text.begin(), at, '\n'));
}

struct Mistake {
  const char* name;
  const char* scene;
  const char* what;  ///< replaced in the scene ...
  const char* with;  ///< ... by this
  const char* at;    ///< the line that is named holds it; empty where a missing table has no line
  std::vector<std::string> said;
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.name;
}

class SceneMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(SceneMistake, IsRefusedWithItsPlace) {
  const Mistake& mistake = GetParam();
  const std::string text = replaced(shipped_text(mistake.scene), mistake.what, mistake.with);
  const std::string message = complaint(text);
  const std::string place =
      *mistake.at ? "cut.toml:" + std::to_string(line_of(text, mistake.at)) + ":" : std::string("cut.toml");
  EXPECT_THAT(message, HasSubstr(place));
  for (const std::string& part : mistake.said) EXPECT_THAT(message, HasSubstr(part));
}

constexpr const char* rake = "rake = \"45 deg\"\n";

INSTANTIATE_TEST_SUITE_P(
    Table, SceneMistake,
    ::testing::Values(
        Mistake{"bevel_and_clearance",
                "verification_45",
                rake,
                "rake = \"45 deg\"\nbevel = \"30 deg\"\nclearance = \"15 deg\"\n",
                "bevel",
                {"bevel and clearance", "one"}},
        Mistake{"bevel_without_clearance_left",
                "verification_45",
                rake,
                "rake = \"45 deg\"\nbevel = \"50 deg\"\n",
                "bevel",
                {"bevel = 50 deg", "rake of 45 deg", "clearance of -5 deg", "0.5 deg"}},
        Mistake{"sole_without_opening", "plane_breaker", "opening_in_depths = 4\n", "", "", {"[sole]", "opening"}},
        Mistake{"sole_with_both_openings",
                "plane_breaker",
                "opening_in_depths = 4\n",
                "opening_in_depths = 4\nopening = \"1.2 mm\"\n",
                "opening = ",
                {"[sole]", "opening or opening_in_depths", "only one"}},
        Mistake{"tip_radius_below_a_cell",  // 0.5 mm / 8 = 0.0625 mm
                "verification_45",
                rake,
                "rake = \"45 deg\"\ntip_radius = \"0.06 mm\"\n",
                "tip_radius",
                {"tip_radius = 0.06 mm", "cell of 0.0625 mm", "cells_through_chip"}},
        Mistake{"tip_radius_with_edge_contact",
                "verification_45",
                rake,
                "rake = \"45 deg\"\ntip_radius = \"0.1 mm\"\n[edge_contact]\npress_in = 0.01\nedge_radius = 1\n",
                "press_in",
                {"[edge_contact]", "tip_radius", "one of them"}},
        Mistake{"lead_in_with_tip_radius",
                "verification_45",
                rake,
                "rake = \"45 deg\"\ntip_radius = \"0.1 mm\"\nlead_in = \"20 deg\"\n",
                "lead_in = ",
                {"lead_in", "sharp", "tip_radius"}},
        Mistake{"log_smaller_than_its_spindle",
                "veneer",
                "radius = \"8 mm\"",
                "radius = \"2.6 mm\"",
                "radius = \"2.6",
                {"spindle", "window.below", "three cells"}},
        Mistake{"log_peeled_for_more_than_a_turn",
                "veneer",
                "travel = 48",
                "travel = 95",
                "radius = \"8",
                {"cut.travel + window.ahead", "one turn"}},
        Mistake{"log_with_stretched_cells",
                "veneer",
                "[resolution]",
                "[resolution]\ncell_stretch = 2",
                "radius = \"8",
                {"[log]", "resolution.cell_stretch"}},
        Mistake{"lead_in_with_edge_contact",
                "verification_45",
                rake,
                "rake = \"45 deg\"\nlead_in = \"20 deg\"\n[edge_contact]\npress_in = 0.01\nedge_radius = 1\n",
                "press_in",
                {"[edge_contact]", "lead_in", "sharp"}},
        Mistake{"heat_of_friction_without_friction",
                "heat_45",
                "taylor_quinney = 0.9",
                "taylor_quinney = 0.9\nfriction_share = 0.5",
                "friction_share",
                {"[thermal]", "no face of the tool rubs", "[friction]"}},
        Mistake{"grips_with_tool",
                "dcb_rcurve",
                "[grips]\n",
                "[tool]\nrake = \"45 deg\"\n\n[grips]\n",
                "rake = ",
                {"[grips]", "no [tool]"}},
        Mistake{
            "neither_grips_nor_tool", "verification_45", "[tool]\nrake = \"45 deg\"\n", "", "", {"[tool]", "[grips]"}},
        Mistake{"grips_without_arms", "dcb_rcurve", "arms = \"both\"\n", "", "", {"[grips]", "arms", "upper"}},
        Mistake{"grips_at_the_very_end",  // 0.7 depths of 4 mm less 1 mm; cells of 1 mm
                "dcb_rcurve",
                "arms = \"both\"\n",
                "arms = \"both\"\nposition = 0.7\n",
                "position = ",
                {"gauge", "1.8 mm from the specimen's end", "two cells, 2 mm", "position"}},
        Mistake{"grips_with_an_unknown_arm",
                "dcb_rcurve",
                "arms = \"both\"",
                "arms = \"uper\"",
                "uper",
                {"did you mean \"upper\""}},
        Mistake{"bridging_in_other_words",
                "plane_breaker",
                "tool = \"cuts\"",
                "tool = \"cut\"",
                "tool = ",
                {"did you mean \"cuts\"", "ignores"}},
        Mistake{"unknown_mixed_mode",
                "verification_45",
                "exponent_m = 1\n",
                "exponent_m = 1\nmixed_mode = \"area\"\n",
                "mixed_mode",
                {"did you mean \"areas\"", "coupled"}},
        Mistake{"first_order_xpic",
                "verification_45",
                "[pic_damping]\nrate = 0.025\n",
                "[xpic_damping]\nrate = 0.025\norder = 1\n",
                "order = ",
                {"order = 1", "2 to 10"}},
        Mistake{"half_an_order_of_xpic",
                "verification_45",
                "[pic_damping]\nrate = 0.025\n",
                "[xpic_damping]\nrate = 0.025\norder = 2.5\n",
                "order = ",
                {"whole number"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Scene, ABevelLeavesTheClearanceThatRakeAndBevelDoNotTake) {
  const Scene scene = read_scene(Document::parse(
      replaced(shipped_text("verification_45"), rake, "rake = \"45 deg\"\nbevel = \"30 deg\"\n"), "cut.toml"));
  EXPECT_NEAR(scene.tool.clearance * 180 / std::acos(-1), 15, 1e-12);
}

TEST(Scene, AMouthInDepthsFollowsTheDepth) {
  Document document = Document::parse(shipped_text("plane_breaker"), "cut.toml");
  document.set_number("cut.depth", 0.2, scene_blocks());
  EXPECT_NEAR(read_scene(document).sole->opening, 0.8, 1e-12);
}

TEST(Scene, PartsRubAsTheRakeFaceUnlessTheyHaveTheirOwnCoefficient) {
  const std::string text = shipped_text("plane_breaker") + "\n[friction]\ncoefficient = 0.3\nsole = 0.1\n";
  const Scene scene = read_scene(Document::parse(text, "cut.toml"));
  EXPECT_EQ(scene.friction->sole, 0.1);
  EXPECT_EQ(scene.friction->chip_breaker, 0.3);
}

/// A zone in mm is room whatever the depth: ahead, behind and above grow by it, the base does not.
TEST(Scene, AZoneLengthensTheWindow) {
  const Scene scene = read_scene(Document::parse(shipped_text("plane_breaker"), "cut.toml"));  // 1.5 mm = 5 depths
  EXPECT_NEAR(scene.window.ahead, 6 + 5, 1e-12);
  EXPECT_NEAR(scene.window.behind, 3 + 5, 1e-12);
  EXPECT_NEAR(scene.window.above, 4 + 5, 1e-12);
  EXPECT_NEAR(scene.window.below, 4, 1e-12);
}

}  // namespace
}  // namespace kerf::forward
