// A document keeps its meaning when it is patched, written and read again, and survives any bytes.
#include "models/base/document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "models/base/error.hpp"
#include "models/base/units.hpp"

namespace kerf {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<Block>& blocks() {
  static const std::vector<Block> known{
      {.path = "", .variant = "", .meaning = "", .parameters = {text("title", "").or_else("untitled")}},
      {.path = "cut",
       .variant = "",
       .meaning = "",
       .parameters = {number("depth", "um", 1e-9, 1e9, ""), number("rake", "deg", -90, 90, "").or_else("15 deg"),
                      number("friction", "1", -1e300, 1e300, "").or_else("0.25"),
                      number("density", "kg/m^3", 0, 1e9, "").if_given(), flag("draft", "").or_else("true"),
                      list("observables", "").or_else("[\"F_c\", \"F_t\"]")},
       .required = true},
      {.path = "cohesive.mode_I",
       .variant = "cubic",
       .meaning = "",
       .parameters = {number("toughness", "J/m^2", -1e300, 1e300, "")}},
      {.path = "window",
       .variant = "",
       .meaning = "",
       .parameters = {number("ahead", "1", 0, 9, "").or_else("3")},
       .required = true},
      {.path = "curve", .variant = "", .meaning = "", .parameters = {text("file", "")}, .repeated = true}};
  return known;
}

const char* const sound =
    "# a comment\n"
    "cohesive.mode_I = {law = \"cubic\", toughness = \"2 kJ/m^2\"}\n"
    "[cut]\n"
    "depth = \"500 um\"\n"
    "[[curve]]\n"
    "file = \"a.csv\"\n"
    "[[curve]]\n"
    "file = \"b.csv\"\n";

TEST(Document, GivesConsistentUnitsFallbacksAndRepeats) {
  const Contents contents = Document::parse(sound, "cut.toml").read(blocks());
  const Values& cut = contents.at("cut");
  EXPECT_DOUBLE_EQ(cut.number("depth"), 0.5);
  EXPECT_DOUBLE_EQ(cut.number("rake"), 15 * consistent_units_in("deg"));
  EXPECT_EQ(cut.number("friction"), 0.25);
  EXPECT_TRUE(cut.flag("draft"));
  EXPECT_THAT(cut.list("observables"), ElementsAre("F_c", "F_t"));
  EXPECT_FALSE(cut.has("density"));
  EXPECT_EQ(contents.at("").text("title"), "untitled");
  EXPECT_EQ(contents.at("cohesive.mode_I").variant(), "cubic");
  EXPECT_DOUBLE_EQ(contents.at("cohesive.mode_I").number("toughness"), 2.0);
  EXPECT_EQ(contents.at("window").number("ahead"), 3.0) << "a required block whose keys all have fallbacks";
  ASSERT_EQ(contents.all("curve").size(), 2u);
  EXPECT_EQ(contents.all("curve")[1].text("file"), "b.csv");
  EXPECT_TRUE(contents.all("nothing").empty());
  EXPECT_FALSE(contents.has("nothing"));
  EXPECT_EQ(cut.where("depth"), "cut.toml:4:9");
  EXPECT_EQ(cut.where("rake"), "cut.toml:3:1") << "an absent key is where its table is";
  EXPECT_THROW(cut.number("colour"), std::logic_error);
}

TEST(Document, CanonicalTextForgetsLayoutAndReadsBack) {
  const Document document = Document::parse(sound, "a");
  const Document relaid = Document::parse(
      "curve = [{file='a.csv'}, {file='b.csv'}]\r\n[cut]\r\ndepth='500 um'\r\n"
      "[cohesive]\r\n[cohesive.mode_I]\r\ntoughness='2 kJ/m^2' # same\r\nlaw='cubic'\r\n",
      "b");
  EXPECT_EQ(document.canonical(), relaid.canonical());
  EXPECT_EQ(Document::parse(document.canonical(), "c").canonical(), document.canonical());
  Document other = document;
  other.set_number("cut.friction", 0.25, blocks());
  EXPECT_NE(other.canonical(), document.canonical());
}

TEST(Document, APatchedCopyLeavesTheOriginalAlone) {
  const Document original = Document::parse(sound, "cut.toml");
  Document patched = original;
  patched.set_number("cut.depth", 0.25, blocks());
  EXPECT_DOUBLE_EQ(original.read(blocks()).at("cut").number("depth"), 0.5);
  EXPECT_DOUBLE_EQ(patched.read(blocks()).at("cut").number("depth"), 0.25);
  EXPECT_THAT(patched.canonical(), HasSubstr("depth = \"250 um\""));
  EXPECT_EQ(patched.read(blocks()).at("cut").where("depth"), "cut.toml:4:9") << "a patched value keeps its place";
}

TEST(Document, WordsAreSetAddedAndLeftOut) {
  Document document = Document::parse(sound, "cut.toml");
  document.set_text("title", "another", blocks());
  document.set_text("cut.draft", "false", blocks());
  document.set_text("cohesive.mode_I.law", "cubic", blocks());
  Contents contents = document.read(blocks());
  EXPECT_EQ(contents.at("").text("title"), "another");
  EXPECT_FALSE(contents.at("cut").flag("draft"));
  EXPECT_THROW(document.set_text("cut.draft", "perhaps", blocks()), InputError);
  EXPECT_THROW(document.set_text("cut.observables", "F_c", blocks()), InputError);  // a list is no word
  document.set_text("cohesive.mode_I.law", "cubik", blocks());
  EXPECT_THAT([&] { document.read(blocks()); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("did you mean \"cubic\"?")));

  document.remove("title");
  document.remove("cohesive.mode_I");
  document.remove("no.such.thing");
  contents = document.read(blocks());
  EXPECT_EQ(contents.at("").text("title"), "untitled");
  EXPECT_FALSE(contents.has("cohesive.mode_I"));
  document.add_table("cohesive.mode_I", blocks());
  document.set_text("cohesive.mode_I.law", "cubic", blocks());
  document.set_number("cohesive.mode_I.toughness", 1.5, blocks());
  EXPECT_EQ(document.read(blocks()).at("cohesive.mode_I").number("toughness"), 1.5);
}

TEST(Document, APatchOutOfRangeIsRefusedWhenItIsRead) {
  Document document = Document::parse(sound, "cut.toml");
  document.set_number("cut.rake", 3.0, blocks());
  try {
    document.read(blocks());
    FAIL() << "a rake of 3 rad was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is above 90 deg"));
  }
}

TEST(Document, NumbersThatWereSetReadBackBitForBit) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-6, 3), mantissa(0.1, 1);
  const char* const paths[] = {"cut.depth", "cut.friction", "cut.density", "cohesive.mode_I.toughness"};
  Document document = Document::parse(sound, "cut.toml");
  for (int i = 0; i < 4000; ++i) {
    const std::string path = paths[i % 4];
    const double value = mantissa(random) * std::pow(10.0, exponent(random)) * (path == "cut.density" ? 1e-9 : 1.0);
    document.set_number(path, value, blocks());
    const Document again = Document::parse(document.canonical(), "again");
    const std::size_t dot = path.rfind('.');
    for (const Document& d : {document, again}) {
      const double read = d.read(blocks()).at(path.substr(0, dot)).number(path.substr(dot + 1));
      ASSERT_EQ(std::bit_cast<std::uint64_t>(read), std::bit_cast<std::uint64_t>(value)) << path << " = " << value;
    }
  }
}

TEST(Document, MayBeReadAndPatchedInManyThreads) {
  const Document shared = Document::parse(sound, "cut.toml");
  std::vector<double> depths(8);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < depths.size(); ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) {
        Document own = shared;
        own.set_number("cut.depth", 0.1 * static_cast<double>(t + 1), blocks());
        depths[t] = own.read(blocks()).at("cut").number("depth");
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < depths.size(); ++t) EXPECT_EQ(depths[t], 0.1 * static_cast<double>(t + 1));
}

/// Damages `text` in ways that people and editors do, and in ways that only a fuzzer does.
std::string damaged(std::string text, std::mt19937_64& random) {
  static const std::vector<std::string> bits{"[",
                                             "]",
                                             "[[",
                                             "]]",
                                             "{",
                                             "}",
                                             "=",
                                             "\"",
                                             "'",
                                             "\n",
                                             "\r\n",
                                             ".",
                                             ",",
                                             "#",
                                             "\"\"\"",
                                             "\\u00e9",
                                             "\xc3",
                                             "\xef\xbb\xbf",
                                             std::string(1, '\0'),
                                             "nan",
                                             "inf",
                                             "-0",
                                             "1e308",
                                             "0x1F",
                                             "1979-05-27T07:32:00Z",
                                             "true",
                                             " mm",
                                             " MPa",
                                             "J/m^2",
                                             "°",
                                             "mm^0.5",
                                             "(((((",
                                             "since 2000",
                                             "law",
                                             "cut",
                                             "cohesive",
                                             "mode_I.",
                                             "99999999999999999999",
                                             "\"40 GPa\""};
  std::uniform_int_distribution<std::size_t> edits(1, 6), bit(0, bits.size() - 1), kind(0, 4), byte(0, 255);
  for (std::size_t n = edits(random); n > 0; --n) {
    const std::size_t at = std::uniform_int_distribution<std::size_t>(0, text.size())(random);
    const std::size_t length = std::min(byte(random) % 12, text.size() - at);
    switch (kind(random)) {
      case 0:
        text.insert(at, bits[bit(random)]);
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.replace(at, length, bits[bit(random)]);
        break;
      case 3:
        text.insert(at, text.substr(at / 2, length * 4));
        break;
      default:
        text.insert(at, 1, static_cast<char>(byte(random)));
    }
  }
  return text;
}

TEST(Document, AnyBytesAreReadOrRefusedWithAPlace) {
  std::mt19937_64 random(3);
  int sound_ones = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string text = damaged(sound, random);
    try {
      Document document = Document::parse(text, "fuzz.toml");
      Document::parse(document.canonical(), "canonical");
      document.read(blocks());
      ++sound_ones;
    } catch (const InputError& error) {
      ASSERT_THAT(error.what(), ::testing::MatchesRegex("(fuzz.toml|canonical):[0-9]+:[0-9]+: .*")) << text;
      ASSERT_THAT(error.what(), ::testing::Not(::testing::StartsWith("canonical"))) << text;
      ++refused;
    }
  }
  EXPECT_GT(sound_ones, 500);
  EXPECT_GT(refused, 10000);
}

TEST(Document, DeepNestingIsRefusedAndNotACrash) {
  std::string dotted = "a", braces, brackets;
  for (int i = 0; i < 400000; ++i) dotted += ".a";
  for (int i = 0; i < 100000; ++i) braces += "{a=";
  for (int i = 0; i < 100000; ++i) brackets += "[";
  for (const std::string& text : {dotted + " = 1", "[" + dotted + "]", "x = " + braces, "x = " + brackets})
    EXPECT_THROW(Document::parse(text, "deep.toml").read(blocks()), InputError);
}

}  // namespace
}  // namespace kerf
