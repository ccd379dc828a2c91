// Every mistake in an input file is answered with its place, what was found and what is allowed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "models/base/document.hpp"
#include "models/base/error.hpp"

namespace kerf {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::vector<Block>& blocks() {
  static const std::vector<Block> known{
      {.path = "", .variant = "", .meaning = "the scene", .parameters = {text("title", "a name").or_else("untitled")}},
      {.path = "cut",
       .variant = "",
       .meaning = "the cut",
       .parameters = {number("depth", "mm", 1e-4, 10, "depth of cut"),
                      number("rake", "deg", -30, 70, "rake angle").or_else("15 deg"),
                      number("friction", "1", 0, 1, "Coulomb coefficient").or_else("0.3"),
                      number("speed", "m/s", 1e-3, 100, "tool speed").if_given(),
                      flag("draft", "coarse and fast").or_else("false"),
                      text("plane", "which plane problem", {"strain", "stress"}).or_else("strain"),
                      list("observables", "what is compared", {"F_c", "F_t"}).or_else("[\"F_c\"]")},
       .required = true},
      {.path = "material",
       .variant = "j2",
       .meaning = "isotropic",
       .parameters = {number("yield_stress", "MPa", 1e-3, 1e4, "uniaxial yield stress")},
       .required = true},
      {.path = "material",
       .variant = "hill",
       .meaning = "orthotropic",
       .parameters = {number("ratio", "1", 0, 1, "yield stress ratio")},
       .required = true},
      {.path = "cohesive.mode_I",
       .variant = "",
       .meaning = "opening",
       .parameters = {number("strength", "MPa", 1e-3, 1e3, "peak traction"),
                      number("toughness", "J/m^2", 1e-3, 1e6, "area under the law")},
       .required = true},
      {.path = "heat", .variant = "", .meaning = "heat", .parameters = {number("conductivity", "1", 0, 1, "k")}},
      {.path = "heat.source", .variant = "", .meaning = "source", .parameters = {flag("on", "")}, .required = true},
      {.path = "curve", .variant = "", .meaning = "measured", .parameters = {text("file", "path")}, .repeated = true}};
  return known;
}

const std::string sound =
    "[cut]\n"
    "depth = \"0.5 mm\"\n"
    "[material]\n"
    "law = \"j2\"\n"
    "yield_stress = \"25 MPa\"\n"
    "[cohesive.mode_I]\n"
    "strength = \"40 MPa\"\n"
    "toughness = \"2000 J/m^2\"\n";

std::string error_of(const std::string& toml) {
  try {
    Document::parse(toml, "cut.toml").read(blocks());
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_data);
    return error.what();
  }
  return "no error";
}

TEST(InputErrors, TheDocumentTheTableStartsFromIsSound) {
  EXPECT_EQ(error_of(sound), "no error");
}

TEST(InputErrors, SayWhereWhatAndWhatIsAllowed) {
  struct Case {
    std::string old_text, new_text;  ///< edit of the sound document
    std::string place;               ///< line:column
    std::vector<std::string> fragments;
  };
  const std::string depth = "depth = \"0.5 mm\"\n", strength = "strength = \"40 MPa\"";
  const Case cases[] = {
      // numbers and units
      {"40 MPa",
       "40 GPa",
       "7:12",
       {"[cohesive.mode_I] strength = \"40 GPa\" is above 1000 MPa", "0.001 to 1000 MPa", "did you mean MPa?"}},
      {"40 MPa", "-40 MPa", "7:12", {"is below 0.001 MPa", "allowed: 0.001 to 1000 MPa"}},
      {"0.5 mm", "0.5 m", "2:9", {"[cut] depth = \"0.5 m\" is above 10 mm", "did you mean mm?"}},
      {"2000 J/m^2", "2000 kN/m", "8:13", {"above 1e+06 J/m^2", "did you mean N/m?"}},
      {depth, depth + "rake = \"15 rad\"\n", "3:8", {"above 70 deg", "did you mean deg?"}},
      {"\"40 MPa\"", "40", "7:12", {"strength = 40 has no unit", "\"40 MPa\""}},
      {"\"40 MPa\"", "\"40\"", "7:12", {"has no unit", "\"40 MPa\""}},
      {"40 MPa", "40 mm", "7:12", {"is in mm, which does not measure this", "MPa"}},
      {"40 MPa", "40 Mpa", "7:12", {"\"Mpa\" is not a unit", "did you mean MPa?"}},
      {"40 MPa", "40 MPa MPa", "7:12", {"does not measure this"}},
      {"40 MPa", "1 200 MPa", "7:12", {"\"200 MPa\" is not a unit"}},
      {"40 MPa", "40,5 MPa", "7:12", {"comma", "decimal point"}},
      {"40 MPa", "forty MPa", "7:12", {"does not begin with a number", "\"1 MPa\""}},
      {"40 MPa", "", "7:12", {"does not begin with a number"}},
      {"40 MPa", "inf MPa", "7:12", {"not a finite number"}},
      {"40 MPa", "nan MPa", "7:12", {"not a finite number"}},
      {"40 MPa", "1e400 MPa", "7:12", {"too large"}},
      {"40 MPa", "40 degC", "7:12", {"\"degC\" is not made of", "MPa"}},
      {depth, depth + "friction = \"0.3 mm\"\n", "3:12", {"a pure number belongs here", "write 0.3"}},
      {depth, depth + "friction = \"0.3\"\n", "3:12", {"a pure number belongs here", "write 0.3"}},
      {depth, depth + "friction = 1.5\n", "3:12", {"friction = 1.5 is above 1 (allowed: 0 to 1)"}},
      {depth, depth + "friction = inf\n", "3:12", {"not a finite number"}},
      {depth, depth + "friction = nan\n", "3:12", {"not a finite number"}},
      {depth, depth + "friction = true\n", "3:12", {"is true or false; a number belongs here"}},
      {depth, depth + "friction = 99999999999999999\n", "3:12", {"99999999999999999 is too large"}},
      {"\"40 MPa\"", "[40]", "7:12", {"strength = [40.0] is a list", "\"1 MPa\""}},
      // names
      {"strength", "strenght", "7:1", {"[cohesive.mode_I] has no key \"strenght\"", "did you mean \"strength\"?"}},
      {"strength", "colour", "7:1", {"has no key \"colour\"", "known here: strength, toughness"}},
      {depth, depth + "yield_stress = 1\n", "3:1", {"[cut] has no key \"yield_stress\"", "it belongs in [material]"}},
      {"[cut]\n", "depht = 1\n[cut]\n", "1:1", {"the top of the file has no key \"depht\""}},
      {"[cut]\n", "[cuts]\n", "1:2", {"there is no table [cuts]", "did you mean \"cut\"?"}},
      {"mode_I]", "mode_II]", "6:11", {"there is no table [cohesive.mode_II]", "\"cohesive.mode_I\""}},
      {"yield_stress = \"25 MPa\"",
       "yield_stress = \"25 MPa\"\nratio = 0.5",
       "6:1",
       {"[material] has no key \"ratio\"", "it belongs to law = \"hill\""}},
      {"law = \"j2\"", "law = \"hil\"", "4:7", {"[material] law = \"hil\"", "did you mean \"hill\"?", "j2, hill"}},
      {"law = \"j2\"\n", "", "3:1", {"[material] lacks the key \"law\"", "j2, hill"}},
      {"law = \"j2\"", "law = 2", "4:7", {"law = 2 is a number; a string belongs here"}},
      // missing and doubled
      {depth, "", "1:1", {"[cut] lacks the key \"depth\"", "0.0001 to 10 mm", "depth of cut"}},
      {"[cut]\n" + depth, "", "1:1", {"the table [cut] is missing"}},
      {depth, depth + depth, "3:", {"depth"}},
      {"[material]", "[cut]\n[material]", "3:", {"cut"}},
      {depth, depth + "[heat]\nconductivity = 0.5\n", "1:1", {"the table [heat.source] is missing"}},
      // kinds
      {depth, depth + "draft = 1\n", "3:9", {"draft = 1 is a number; true or false belongs here"}},
      {depth, depth + "plane = \"stres\"\n", "3:9", {"did you mean \"stress\"?", "allowed: strain, stress"}},
      {depth, depth + "plane = true\n", "3:9", {"a string belongs here"}},
      {depth, depth + "observables = \"F_c\"\n", "3:15", {"a list of strings belongs here"}},
      {depth, depth + "observables = [\"F_x\"]\n", "3:15", {"holds \"F_x\"", "F_c, F_t"}},
      {depth, depth + "observables = [\"F_c\", \"F_c\"]\n", "3:15", {"holds \"F_c\" twice"}},
      {depth, depth + "observables = [1]\n", "3:15", {"holds a number; only strings belong here"}},
      {depth, depth + "speed = 1979-05-27\n", "3:9", {"a date or time has no meaning here"}},
      {"[cut]\n", "curve = 3\n[cut]\n", "1:9", {"curve is a number; tables [[curve]] belong here"}},
      {"[cut]\n", "curve = [3]\n[cut]\n", "1:10", {"curve holds a number"}},
      {"[cut]\n", "[curve]\nfile = \"a\"\n[cut]\n", "1:1", {"tables [[curve]] belong here"}},
      {"[cut]\n", "[[cut]]\n", "1:1", {"cut is a list; a table [cut] belongs here"}},
      {"[cut]\n", "[[curve]]\nfile = \"a\"\n[[curve]]\n[cut]\n", "3:1", {"[curve] lacks the key \"file\": path"}},
      {"[cohesive.mode_I]\nstrength = \"40 MPa\"\ntoughness = \"2000 J/m^2\"\n",
       "[cohesive]\nmode_I = 1\n",
       "7:10",
       {"a table [cohesive.mode_I] belongs here"}},
      // TOML itself
      {"\"40 MPa\"", "\"40 MPa", "7:", {"string"}},
      {"\"40 MPa\"", "", "7:", {""}},
      {"40 MPa", "40 \xff", "7:", {""}},
      {"[cut]\n", "x = " + std::string(40, '[') + std::string(40, ']') + "\n[cut]\n", "1:", {"nested deeper"}},
  };
  for (const Case& c : cases) {
    std::string toml = sound;
    const std::size_t at = toml.find(c.old_text);
    ASSERT_NE(at, toml.npos) << c.old_text;
    toml.replace(at, c.old_text.size(), c.new_text);
    const std::string message = error_of(toml);
    EXPECT_THAT(message, StartsWith("cut.toml:" + c.place)) << toml;
    for (const std::string& fragment : c.fragments) EXPECT_THAT(message, HasSubstr(fragment)) << toml;
  }
}

TEST(InputErrors, AFileThatIsNotThereIsNamed) {
  try {
    Document::load("no/such/scene.toml");
    FAIL() << "a missing file was read";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "no/such/scene.toml: there is no such file");
  }
}

TEST(InputErrors, PathsOfFreeParametersAreCheckedTheSameWay) {
  struct Case {
    const char* path;
    const char* fragment;
  };
  for (const Case& c :
       {Case{"cohesive.mode_I.toughnes", "did you mean \"cohesive.mode_I.toughness\"?"},
        Case{"toughness", "did you mean \"cohesive.mode_I.toughness\"?"},
        Case{"material.ratio", "with this law has no key \"ratio\""},
        Case{"heat.conductivity", "there is no table [heat]"}, Case{"cut.draft", "no numeric parameter"},
        Case{"curve.file", "no numeric parameter"}, Case{"", "no numeric parameter"}}) {
    Document document = Document::parse(sound, "cut.toml");
    try {
      document.set_number(c.path, 0.5, blocks());
      ADD_FAILURE() << c.path << " was set";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.fragment));
      EXPECT_EQ(document.canonical(), Document::parse(sound, "cut.toml").canonical());
    }
  }
}

}  // namespace
}  // namespace kerf
