// Presets: whose value counts, that they touch numerical knobs alone, and that without one nothing changes.
#include "forward/scene/preset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "inverse/sweep.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryFolder;

const std::string cells = "resolution.cells_through_chip";

/// The scene of the tests, which sets the cells through its chip, with `top` before its first line.
std::string scene_with(const std::string& top) {
  return top + "\n" + testing::scene_text;
}

std::string without_cells(const std::string& scene) {
  return testing::replaced(scene, "[resolution]\ncells_through_chip = 4\n", "");
}

forward::Scene read(const std::string& text) {
  return forward::read_scene(Document::parse(text, "scene.toml"));
}

/// What a knob is in a scene, as its file would hold it.
double value_in(const Document& scene, const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return scene.read(forward::scene_blocks()).at(path.substr(0, dot)).number(path.substr(dot + 1));
}

double cells_of(const char* preset) {
  Document scene = Document::parse(testing::scene_text, "scene.toml");
  forward::impose_preset(scene, preset, "test");
  return value_in(scene, cells);
}

TEST(Preset, FillsWhatTheSceneLeavesOutAndNothingElse) {
  const forward::Scene own = read(scene_with("preset = \"reference\""));
  EXPECT_EQ(own.resolution.cells_through_chip, 4);
  const forward::Scene filled = read(without_cells(scene_with("preset = \"reference\"")));
  EXPECT_EQ(filled.resolution.cells_through_chip, cells_of("reference"));
  EXPECT_NE(filled.resolution.cells_through_chip,
            read(without_cells(testing::scene_text)).resolution.cells_through_chip);
}

TEST(Preset, OnTheCommandLineOverridesTheSceneAndIsOverriddenByKeysBesideIt) {
  Document scene = Document::parse(scene_with("preset = \"draft\""), "scene.toml");
  inverse::apply_settings({"steady_state.not_before=7", "preset=reference"}, scene, forward::scene_blocks(), "test");
  EXPECT_EQ(value_in(scene, cells), cells_of("reference"));
  EXPECT_EQ(forward::read_scene(scene).steady_state.not_before, 7);
  EXPECT_EQ(scene.text_at("preset"), "reference");

  inverse::apply_settings({cells + "=5", "preset=standard"}, scene, forward::scene_blocks(), "test");
  EXPECT_EQ(value_in(scene, cells), 5);

  const inverse::Sweep sweep = inverse::lay_out_sweep(Document::parse(testing::scene_text, "scene.toml"),
                                                      {cells + "=3,5", "preset=-,draft"}, false, "test");
  ASSERT_EQ(sweep.runs.size(), 4u);
  for (const inverse::SweepRun& run : sweep.runs) EXPECT_EQ(value_in(run.scene, cells), run.choice[0] == 0 ? 3 : 5);
}

TEST(Preset, OfAJobIsWrittenOverItsScene) {
  const TemporaryFolder folder;
  const inverse::Job job = testing::write_job(folder, std::string("preset = \"reference\"\n") + testing::job_text);
  EXPECT_EQ(value_in(job.scene, cells), cells_of("reference"));
  EXPECT_EQ(value_in(testing::write_job(folder).scene, cells), 4);
}

TEST(Preset, SetsNumericalKnobsAlone) {
  for (const forward::PresetKnob& knob : forward::preset_knobs())
    for (const char* physics : {"material", "cohesive", "tool", "friction", "cut.depth", "bridging", "sole", "title"})
      EXPECT_THAT(knob.path, ::testing::Not(::testing::StartsWith(physics)));
}

TEST(Preset, EveryOneOfThemCanBeReadWithAnyShippedCut) {
  for (const auto& file : std::filesystem::directory_iterator(KERF_SOURCE_DIR "/data/scenes")) {
    for (const char* preset : forward::preset_names) {
      Document scene = Document::load(file.path());
      if (scene.has("grips") || scene.has("body"))
        continue;  // arms ask for a resolution of their own; bodies are no cut
      forward::impose_preset(scene, preset, "test");
      EXPECT_NO_THROW(forward::read_scene(scene)) << file.path() << " " << preset;
      EXPECT_EQ(forward::preset_settings(scene).size(), forward::preset_knobs().size());
    }
  }
}

TEST(Preset, ThatIsNoneIsRefusedWithTheNearest) {
  EXPECT_THAT([] { read(scene_with("preset = \"standart\"")); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("scene.toml:1:10: preset = \"standart\" is not known; did "
                                                             "you mean \"standard\"?")));
  Document scene = Document::parse(testing::scene_text, "scene.toml");
  EXPECT_THAT([&] { forward::impose_preset(scene, "drafty", "kerf simulate --preset"); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("did you mean \"draft\"?")));
}

TEST(Preset, IsToldByListExplainAndCheck) {
  const TemporaryFolder folder;
  write_atomically(folder / "scene.toml", scene_with("preset = \"draft\""));
  const std::string scene = (folder / "scene.toml").string();
  const ProcessOutput list = run_kerf("list preset", folder.path());
  EXPECT_EQ(list.exit_code, 0);
  for (const forward::PresetKnob& knob : forward::preset_knobs()) EXPECT_THAT(list.out, HasSubstr(knob.path));
  EXPECT_THAT(run_kerf("list scene", folder.path()).out, HasSubstr(list.out));
  EXPECT_THAT(run_kerf("explain " + scene, folder.path()).out,
              HasSubstr("cells_through_chip = " + std::string(forward::preset_knobs()[0].values[0]) +
                        ", but the scene's own value counts"));
  EXPECT_THAT(run_kerf("check " + scene, folder.path()).out, HasSubstr("(preset draft)"));
  const ProcessOutput wrong = run_kerf("simulate --preset fine " + scene, folder.path());
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("allowed: draft, standard, reference"));
}

}  // namespace
}  // namespace kerf
