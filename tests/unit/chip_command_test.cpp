// `kerf predict` and `kerf reduce` as a user types them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace {

using nlohmann::json;
using testing::HasSubstr;

struct Outcome {
  int exit_code;
  std::string output;  ///< standard output and error together
};

Outcome kerf(const std::string& arguments, bool with_errors = true) {
  const std::string command =
      std::string("\"") + KERF_EXECUTABLE + "\" " + arguments + (with_errors ? " 2>&1" : " 2>/dev/null");
  Outcome outcome{-1, ""};
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  char buffer[4096];
  while (const auto count = std::fread(buffer, 1, sizeof buffer, pipe)) outcome.output.append(buffer, count);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

json predict(const std::string& arguments) {
  const auto outcome = kerf("predict " + arguments + " --json", false);
  EXPECT_EQ(outcome.exit_code, 0) << arguments;
  return json::parse(outcome.output);
}

const std::string shear_cut = "depth=0.5mm rake=45deg yield_stress=28.867513459481287MPa toughness=2000J/m^2";
const std::string bent_cut =
    "depth=500um rake=45deg yield_stress=\"25 MPa\" toughness=\"2 kJ/m^2\" elastic_modulus=1GPa poisson_ratio=0.33";
const std::string titanium = std::string(KERF_SOURCE_DIR) + "/data/sets/ti6al4v/10_m_min.csv";

TEST(PredictCommand, PrintsTheReferenceValues) {
  for (const char* model : {"shear_minimised ", "atkins "}) {
    const auto result = predict(model + shear_cut);
    EXPECT_NEAR(result["F_c"]["value"].get<double>(), 7978.66, 1e-5 * 7978.66);
    EXPECT_EQ(result["F_c"]["unit"], "N/m");
    EXPECT_NEAR(result["F_t"]["value"].get<double>(), -7978.66, 1e-5 * 7978.66);
    EXPECT_NEAR(result["shear_angle"]["value"].get<double>(), 67.5, 1e-5);
    EXPECT_EQ(result["shear_angle"]["unit"], "deg");
    EXPECT_EQ(result["valid"], true);
  }
  const auto bent = predict("plastic_bending " + bent_cut);
  EXPECT_NEAR(bent["F_c"]["value"].get<double>(), 5810.55, 1e-5 * 5810.55);
  EXPECT_EQ(bent["valid"], false);
  EXPECT_THAT(bent["reason"].get<std::string>(), HasSubstr("root rotation"));
}

TEST(PredictCommand, KnowsTheMeasuredShearAngle) {
  const auto result = predict("chip_force " + shear_cut + " shear_angle=67.5deg");
  EXPECT_NEAR(result["F_c"]["value"].get<double>(), 7978.66, 0.01) << "the angle of least force";
  EXPECT_GT(predict("chip_force " + shear_cut + " shear_angle=50deg")["F_c"]["value"].get<double>(), 7979.0);
}

TEST(PredictCommand, BottomForceAndPlaneStressCount) {
  const auto without = predict("shear_minimised friction=0.4 " + shear_cut);
  const auto with = predict("shear_minimised friction=0.4 bottom_force=\"3 N/mm\" " + shear_cut);
  EXPECT_NEAR(with["F_c"]["value"].get<double>() - without["F_c"]["value"].get<double>(), 0.4 * 3000, 1e-6);
  EXPECT_NEAR(with["F_t"]["value"].get<double>() - without["F_t"]["value"].get<double>(), 3000, 1e-6);
  EXPECT_NE(predict("plastic_bending plane=stress " + bent_cut)["F_c"], predict("plastic_bending " + bent_cut)["F_c"]);
}

TEST(PredictCommand, ErrorsNameTheKeyAndTheRemedy) {
  struct Case {
    const char* arguments;
    const char* message;
  };
  for (const auto& [arguments, message] : {
           Case{"atkin depth=1mm", "did you mean \"atkins\"?"},
           Case{"atkins detph=1mm", "did you mean \"depth\"?"},
           Case{"atkins depth=1", "has no unit"},
           Case{"atkins depth=1MPa", "depth"},
           Case{"atkins depth", "key=value"},
           Case{"atkins depth=1mm", "rake"},
           Case{"atkins depth=1mm rake=45deg yield_stress=25MPa toughness=2kJ/m^2 friction=-1", "friction"},
           Case{"atkins depth=1mm rake=45deg yield_stress=25MPa toughness=2kJ/m^2 plane=strain", "plane"},
           Case{"plastic_bending depth=1mm rake=45deg yield_stress=25MPa toughness=2kJ/m^2 elastic_modulus=1GPa "
                "plane=strian",
                "strain"},
           Case{"atkins depth=1mm depth=2mm", "depth"},
           Case{"atkins depth=nanmm", "depth"},
       }) {
    const auto outcome = kerf(std::string("predict ") + arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.output, HasSubstr(message)) << arguments;
  }
}

TEST(ReduceCommand, PrintsEveryMethod) {
  const auto outcome = kerf("reduce " + titanium + " --json", false);
  ASSERT_EQ(outcome.exit_code, 0);
  const auto result = json::parse(outcome.output);
  EXPECT_GE(result["methods"].size(), 10U);
  EXPECT_TRUE(result["friction_line"].is_object());
  EXPECT_FALSE(result["warnings"].empty());
  EXPECT_THAT(kerf("reduce " + titanium).output, HasSubstr("indistinguishable from zero"));
}

TEST(ReduceCommand, KeepsToTheMethodsAskedFor) {
  const auto result =
      json::parse(kerf("reduce " + titanium + " --method shear_minimised --method chip_force --json", false).output);
  EXPECT_EQ(result["methods"].size(), 2U);
}

TEST(ReduceCommand, RefusesWhatItDoesNotKnow) {
  const auto misspelt = kerf("reduce " + titanium + " --method shear_minimized");
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.output, HasSubstr("did you mean \"shear_minimised\"?"));
  EXPECT_EQ(kerf("reduce " + titanium + " --elastic-modulus 114").exit_code, 2);
  EXPECT_EQ(kerf("reduce no_such_file.csv").exit_code, 3);
}

}  // namespace
