// Measured curves: real files are messy, and each mess is either read right or refused with its place.
#include "data/curve.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "data/csv.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::data {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

const std::string sets = std::string(KERF_SOURCE_DIR) + "/data/sets/";
const std::string rake = "#: rake = 15 deg\n";

std::string error_of(const std::string& text) {
  try {
    parse_curve(text, "c.csv");
  } catch (const InputError& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_data);
    return error.what();
  }
  return "no error";
}

TEST(Curve, ReadsTheTitaniumSetsInConsistentUnits) {
  const Curve curve = read_curve(sets + "ti6al4v/10_m_min.csv");
  ASSERT_EQ(curve.points.size(), 3u);
  EXPECT_TRUE(curve.notes.empty());
  const CurvePoint& first = curve.points.front();
  EXPECT_DOUBLE_EQ(first.depth, 0.04);
  EXPECT_DOUBLE_EQ(first.F_c.value, 97.16);
  EXPECT_DOUBLE_EQ(*first.F_c.sd, 13.37 / 2) << "the article gives two standard deviations";
  EXPECT_DOUBLE_EQ(*first.F_c.standard_error(), 13.37 / 2 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(first.F_t->value, 46.58);
  EXPECT_DOUBLE_EQ(first.chip_ratio->value, 1.767);
  EXPECT_DOUBLE_EQ(*first.chip_ratio->sd, 0.072);
  EXPECT_DOUBLE_EQ(first.rake, 15 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(*first.width, 1.0);
  EXPECT_DOUBLE_EQ(*first.speed, 10e3 / 60);
  EXPECT_DOUBLE_EQ(*first.tool_radius, 0.02);
  EXPECT_EQ(first.specimen, "Ti-6Al-4V");
  EXPECT_EQ(first.line, 10);
  EXPECT_EQ(read_curve(sets + "ti6al4v/5_m_min.csv").points.size(), 3u);
}

TEST(Curve, ThePolymerTablesAreNoCurvesAndSaySo) {
  for (const char* file : {"chang2016/chip_geometry.csv", "chang2016/fitted_values.csv"})
    EXPECT_THROW(read_curve(sets + file), InputError) << file;
}

TEST(Curve, ThePrintedShearStrainsFollowFromChipRatioAndRake) {
  const std::string file = sets + "chang2016/chip_geometry.csv";
  const Csv table = split_csv(read_file(file), file);
  const auto column = [&](const std::string& title) {
    for (std::size_t i = 0; i < table.header.size(); ++i)
      if (table.header[i].text == title) return i;
    ADD_FAILURE() << "no column " << title;
    return std::size_t{0};
  };
  const std::size_t alpha_at = column("rake[deg]"), ratio_at = column("chip_ratio"), gamma_at = column("shear_strain");
  ASSERT_EQ(table.rows.size(), 26u);
  for (const auto& row : table.rows) {
    const double alpha = std::stod(row[alpha_at].text) * std::numbers::pi / 180;
    const auto gamma = [&](double ratio) {
      const double phi = std::atan2(std::cos(alpha), ratio - std::sin(alpha));
      return 1 / std::tan(phi) + std::tan(phi - alpha);
    };
    // Both numbers are printed to 0.01, so the ratio stands for an interval and so does gamma.
    const double ratio = std::stod(row[ratio_at].text), printed = std::stod(row[gamma_at].text), half = 0.005 + 1e-9;
    EXPECT_GE(printed, gamma(ratio - half) - half) << "line " << row.front().line;
    EXPECT_LE(printed, gamma(ratio + half) + half) << "line " << row.front().line;
  }
}

TEST(Curve, MessyFilesAreReadAsWhatTheyMean) {
  const std::string tidy = rake + "depth[um],Fc[N/mm],Ft[N/mm]\n40,97.5,46\n60,129,53.25\n";
  const Curve expected = parse_curve(tidy, "tidy");
  const std::string files[] = {
      "\xEF\xBB\xBF" + tidy,                                                                // byte-order mark
      "#: rake = 15 deg\r\ndepth[um],Fc[N/mm],Ft[N/mm]\r\n40,97.5,46\r\n60,129,53.25\r\n",  // CRLF
      "#: rake = 15 deg\rdepth[um],Fc[N/mm],Ft[N/mm]\r40,97.5,46\r60,129,53.25",            // old CR, no last line end
      rake + "depth[um];Fc[N/mm];Ft[N/mm]\n40;97,5;46\n60;129;53,25\n",                     // decimal commas
      rake + "depth[um];Fc[N/mm];Ft[N/mm]\n40;97.5;46\n60;129;53.25\n",                     // semicolons, points
      rake + "depth[um]\tFc[N/mm]\tFt[N/mm]\n40\t97,5\t46\n60\t129\t53,25\n",               // tabs
      rake + "depth[um],Fc[N/mm],Ft[N/mm],,\n40,97.5,46,,\n60,129,53.25,\n",                // trailing separators
      "\n \n" + rake + "\n# note\ndepth[um],Fc[N/mm],Ft[N/mm]\n,,\n40,97.5,46\n\n  # x\n60,129,53.25\n\n",  // blanks
      rake + "\"depth[um]\",\"Fc[N/mm]\",\"Ft[N/mm]\"\n\"40\",\"97.5\",\"46\"\n\"60\",129,53.25\n",         // quotes
      rake + " depth [um] , Fc [N/mm] ,Ft[N/mm]\n 40 , 97.5\t,46 \n60\xC2\xA0,129,53.25\n",                 // spaces
      rake + "Ft[N/mm],depth[um],Fc[N/mm]\n46,40,97.5\n53.25,60,129\n",                   // other order of columns
      rake + "depth[mm],Fc[kN/m],Ft[N/m]\n0.04,97.5,46e3\n0.06,129,53250\n",              // other units
      rake + "depth[µm],Fc[N/mm],Ft[N/mm]\n4E1,9.75e+1,46.\n+60,129,53.25\n",             // other spellings
      rake + "#: width = 2 mm\ndepth[um],Fc[N],Ft[N]\n40,195,92\n60,258,106.5\n",         // forces, constant width
      rake + "depth[um],Fc[N],Ft[N],width[mm]\n40,195,92,2\n60,387,159.75,3\n",           // forces, width by row
      "depth[um],Fc[N/mm],Ft[N/mm],rake[deg]\n40,97.5,46,15\n60,129,53.25,15\n",          // rake by row
      "\"#: rake = 15 deg\",,\ndepth[um],Fc[N/mm],Ft[N/mm]\n40,97.5,46\n60,129,53.25\n",  // a spreadsheet's comment
      "# \xE9t\xE9 (Latin-1 in a comment)\n" + tidy,
      rake + "depth[um],Fc[N/mm],Ft[N/mm]\n60,129,53.25\n40,97.5,46\n",           // unsorted
      rake + "depth[um],Fc[N/mm],Ft[N/mm]\n40,97.5,46\n50,NaN,\n60,129,53.25\n",  // a row without forces
  };
  for (const std::string& file : files) {
    const Curve curve = parse_curve(file, "messy.csv");
    ASSERT_EQ(curve.points.size(), 2u) << file;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_DOUBLE_EQ(curve.points[i].depth, expected.points[i].depth) << file;
      EXPECT_DOUBLE_EQ(curve.points[i].F_c.value, expected.points[i].F_c.value) << file;
      EXPECT_DOUBLE_EQ(curve.points[i].F_t->value, expected.points[i].F_t->value) << file;
      EXPECT_DOUBLE_EQ(curve.points[i].rake, expected.points[i].rake) << file;
    }
  }
}

TEST(Curve, NotesSayWhatTheReaderDid) {
  const std::string header = rake + "depth[um],Fc[N/mm],Ft[N/mm]\n";
  EXPECT_THAT(parse_curve(header + "60,3,1\n40,2,1\n", "c").notes, ElementsAre(HasSubstr("sorted")));
  EXPECT_THAT(parse_curve(header + "40,nan,NA\n60,3,1\n80,,-\n", "c").notes, ElementsAre(HasSubstr("line 3, 5")));
}

TEST(Curve, AbsentValuesAreAbsentAndReplicatesAreKept) {
  const Curve curve = parse_curve(rake +
                                      "depth[um];Fc[N/mm];Ft[N/mm];Fc_sd[N/mm];chip_ratio;chip_ratio_sd;specimen\n"
                                      "40;2;-1;0,5;1,5;0,1;A\n"
                                      "40;3;−1;;NaN;;A\n"
                                      "40;4;-1;n/a;1,5;;B\n",
                                  "c");
  ASSERT_EQ(curve.points.size(), 3u);
  EXPECT_EQ(curve.points[0].F_c.sd, 0.5);
  EXPECT_EQ(curve.points[0].F_c.standard_error(), 0.5);
  EXPECT_EQ(curve.points[1].F_c.sd, std::nullopt);
  EXPECT_EQ(curve.points[1].F_c.standard_error(), std::nullopt);
  EXPECT_EQ(curve.points[1].F_t->value, -1.0) << "a typographic minus";
  EXPECT_FALSE(curve.points[1].chip_ratio.has_value());
  EXPECT_EQ(curve.points[2].chip_ratio->sd, std::nullopt);
  EXPECT_EQ(curve.points[0].replicate, 1);
  EXPECT_EQ(curve.points[1].replicate, 2);
  EXPECT_EQ(curve.points[2].replicate, 1) << "another specimen";
  EXPECT_EQ(curve.points[0].width, std::nullopt);
}

TEST(Curve, TheTransverseForceMayNotHaveBeenMeasured) {
  const Curve alone = parse_curve("#: rake = 15 deg\ndepth[um],Fc[N/mm]\n40,3\n", "c.csv");
  EXPECT_FALSE(alone.points.front().F_t);
  const Curve partly = parse_curve("#: rake = 15 deg\ndepth[um],Fc[N/mm],Ft[N/mm]\n40,3,\n50,4,2\n", "c.csv");
  EXPECT_FALSE(partly.points[0].F_t);
  EXPECT_DOUBLE_EQ(partly.points[1].F_t->value, 2);
}

TEST(Curve, RefusalsSayWhereWhatAndWhatIsAllowed) {
  const std::string header = rake + "depth[um],Fc[N/mm],Ft[N/mm]\n";
  struct Case {
    std::string file, place;
    std::vector<std::string> fragments;
  };
  const Case cases[] = {
      // the header
      {"", "1:1", {"no header"}},
      {"# only a comment\n\n", "1:1", {"no header"}},
      {header, "2:1", {"no row with forces"}},
      {header + "40,nan,nan\n", "2:1", {"no row with forces"}},
      {rake + "depth,Fc[N/mm],Ft[N/mm]\n", "2:1", {"\"depth\" lacks its unit", "write depth[mm]"}},
      {rake + "depth[um],Fc,Ft[N/mm]\n", "2:11", {"\"Fc\" lacks its unit", "Fc[N] or Fc[N/mm]"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],Fc_sd\n", "2:29", {"\"Fc_sd\" lacks its unit"}},
      {rake + "depth[um],Fc[kg],Ft[N/mm]\n", "2:11", {"\"kg\" does not measure this", "Fc[N] or Fc[N/mm]"}},
      {rake + "depth[um],Fc[Nn],Ft[N/mm]\n", "2:11", {"\"Nn\" is not a unit"}},
      {rake + "depth[deg],Fc[N/mm],Ft[N/mm]\n", "2:1", {"\"deg\" does not measure this"}},
      {rake + "depth[um,Fc[N/mm],Ft[N/mm]\n", "2:1", {"closing bracket"}},
      {rake + "dept[um],Fc[N/mm],Ft[N/mm]\n", "2:1", {"no column \"dept\"", "did you mean \"depth\"?"}},
      {rake + "depth[um],FC[N/mm],Ft[N/mm]\n", "2:11", {"no column \"FC\"", "did you mean \"Fc\"?"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],temperature[K]\n", "2:29", {"\"temperature\"", "known columns: depth, Fc"}},
      {rake + "depth[um],Fc[N/mm],Fc[N/mm],Ft[N/mm]\n", "2:20", {"\"Fc\" stands twice"}},
      {rake + "depth[um],,Ft[N/mm]\n", "2:11", {"column 2 has no name"}},
      {rake + "depth[um],Ft[N/mm]\n", "2:1", {"the column \"Fc\" is missing", "cutting force"}},
      {rake + "depth[um],Ft[N/mm],Fc_sd[N/mm]\n", "2:1", {"the column \"Fc\" is missing"}},
      {"depth[um],Fc[N/mm],Ft[N/mm]\n", "1:1", {"\"rake\" is missing", "#: rake = 15 deg"}},
      {rake + "depth[um],Fc[N],Ft[N]\n40,3,1\n", "2:11", {"the width of cut is needed", "#: width = 1 mm"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],chip_ratio[%]\n", "2:29", {"has no unit; write chip_ratio"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],chip_ratio_sd\n", "2:29", {"chip_ratio_sd but no chip_ratio"}},
      // constants
      {"#: rake 15 deg\n" + header, "1:2", {"#: rake = 15 deg"}},
      {"#: rake = 15\ndepth[um],Fc[N/mm],Ft[N/mm]\n40,3,1\n", "1:2", {"has no unit", "15 deg"}},
      {"#: rake = 15 mm\ndepth[um],Fc[N/mm],Ft[N/mm]\n40,3,1\n", "1:2", {"is in mm", "deg"}},
      {"#: rake = 15 rad\ndepth[um],Fc[N/mm],Ft[N/mm]\n40,3,1\n", "1:2", {"above 85 deg", "did you mean deg?"}},
      {"#: rak = 15 deg\n" + header, "1:2", {"no column \"rak\"", "did you mean \"rake\"?"}},
      {"#: Fc = 15 N\n" + header, "1:2", {"\"Fc\" differs from row to row"}},
      {rake + header, "2:2", {"\"rake\" is given twice"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],rake[deg]\n40,3,1,15\n", "1:2", {"\"rake\" is given twice"}},
      {"#: repeats = 2.5\n" + header + "40,3,1\n", "1:2", {"not a whole number"}},
      {"#: repeats = 0\n" + header + "40,3,1\n", "1:2", {"below 1"}},
      {"#: repeats = 3 N\n" + header + "40,3,1\n", "1:2", {"is a pure number"}},
      // cells
      {header + "40,97.2 N,1\n", "3:4", {"Fc[N/mm] = 97.2 N", "unit belongs in the header"}},
      {header + "40,abc,1\n", "3:4", {"Fc[N/mm] = abc", "does not begin with a number"}},
      {header + "40,inf,1\n", "3:4", {"not a finite number"}},
      {header + "40,,1\n", "3:4", {"Fc[N/mm] is empty; a number belongs here"}},
      {header + "40,nan,3\n", "3:4", {"Fc[N/mm] = nan says that nothing was measured"}},
      {header + ",3,1\n", "3:1", {"depth[um] is empty"}},
      {header + "0,3,1\n", "3:1", {"depth[um] = 0 is below 1e-06 mm"}},
      {header + "-40,3,1\n", "3:1", {"is below"}},
      {header + "40,-3,1\n", "3:4", {"Fc[N/mm] = -3 is below 0 N/mm"}},
      {rake + "depth[m],Fc[N/mm],Ft[N/mm]\n40,3,1\n", "3:1", {"above 100 mm", "did you mean mm?"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],Fc_sd[N/mm]\n40,3,1,-0.5\n", "3:8", {"Fc_sd[N/mm] = -0.5 is below"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],Fc_sd[N/mm]\n40,3,1,0\n", "3:8", {"Fc_sd[N/mm] = 0 is below"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],chip_ratio,chip_ratio_sd\n40,3,1,,0.1\n",
       "3:9",
       {"no chip_ratio in this row"}},
      {rake + "depth[um],Fc[N],Ft[N],width[mm]\n40,3,1,\n", "3:8", {"width[mm] is empty"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],replicate\n40,3,1,1\n40,3,1,1\n", "4:1", {"replicate 1", "line 3"}},
      {rake + "depth[um],Fc[N/mm],Ft[N/mm],replicate\n40,3,1,1.5\n", "3:8", {"not a whole number"}},
      // layout
      {header + "40,3\n", "3:4", {"2 cells where the header names 3"}},
      {header + "40,3,1,7\n", "3:8", {"4 cells where the header names 3"}},
      {header + "0,04,97,5,46\n", "3:11", {"5 cells", "decimal commas need semicolons"}},
      {header + "40,\"97,5\",46\n", "3:4", {"decimal comma", "semicolons"}},
      {rake + "depth[um];Fc[N/mm];Ft[N/mm]\n40;1.234,5;1\n", "3:4", {"thousands separators"}},
      {rake + "depth[um];Fc[N/mm];Ft[N/mm]\n40;97,5;1\n60;129.5;1\n", "4:4", {"decimal '.'", "decimal ','"}},
      {header + "40,\"3,1\n", "3:4", {"quote is not closed"}},
      {header + "40,\"3\"x,1\n", "3:7", {"text follows the closing quote"}},
      {header + "40,3\xff,1\n", "3:5", {"byte 0xFF is not UTF-8"}},
      {rake + "depth[\xb5m],Fc[N/mm],Ft[N/mm]\n", "2:7", {"byte 0xB5 is not UTF-8"}},
      {header + std::string("40,3\0,1\n", 8), "3:5", {"control character 0x00"}},
      {std::string("\xff\xfe"
                   "d\0",
                   4),
       "1:1",
       {"UTF-16", "UTF-8"}},
      {rake + "depth[um] Fc[N/mm] Ft[N/mm]\n40 3 1\n", "2:1", {"one column only", "commas, semicolons or tabs"}},
  };
  for (const Case& c : cases) {
    const std::string message = error_of(c.file);
    EXPECT_THAT(message, StartsWith("c.csv:" + c.place + ": ")) << c.file;
    for (const std::string& fragment : c.fragments) EXPECT_THAT(message, HasSubstr(fragment)) << c.file;
  }
}

TEST(Curve, NumbersSurviveEverySeparatorAndDecimalMark) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> depth(1, 999), force(-99, 99);
  for (int i = 0; i < 2000; ++i) {
    const double h = depth(random), F = force(random);
    for (const char separator : {',', ';', '\t'})
      for (const char mark : {'.', ','}) {
        if (separator == mark) continue;
        const auto spelled = [&](double value) {
          std::string text = std::to_string(value);
          text[text.find('.')] = mark;
          return text;
        };
        const std::string file = fmt::format("{0}depth[mm]{1}Fc[N/mm]{1}Ft[N/mm]\n{2}{1}1{1}{3}\n", rake, separator,
                                             spelled(h / 100), spelled(F));
        const Curve curve = parse_curve(file, "c");
        ASSERT_EQ(curve.points.front().depth, std::stod(std::to_string(h / 100)));
        ASSERT_EQ(curve.points.front().F_t->value, std::stod(std::to_string(F)));
      }
  }
}

TEST(Curve, AnyBytesAreReadOrRefusedWithAPlace) {
  const std::string sound = rake +
                            "#: width = 2 mm\ndepth[um];Fc[N];Ft[N/mm];Fc_sd[N];chip_ratio;specimen\n"
                            "40;97,5;46;1;1,5;\"A\"\n60;129;-53,25;;;B\n";
  const std::vector<std::string> bits{"\"",
                                      "\"\"",
                                      ";",
                                      ",",
                                      "\t",
                                      "\r",
                                      "\n",
                                      "#",
                                      "#:",
                                      "[",
                                      "]",
                                      "[um]",
                                      "nan",
                                      "inf",
                                      "-",
                                      "1e999",
                                      "\xEF\xBB\xBF",
                                      "\xC2\xA0",
                                      "\xB5",
                                      std::string(1, '\0'),
                                      "rake = 5 deg",
                                      "=",
                                      "0x1p3",
                                      ".",
                                      "−",
                                      "mm^0.5",
                                      "Fc[N]",
                                      "replicate",
                                      "1e-320",
                                      "((((("};
  std::mt19937_64 random(5);
  std::uniform_int_distribution<std::size_t> edits(1, 3), bit(0, bits.size() - 1), kind(0, 3), byte(0, 255);
  int read = 0, refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text = sound;
    for (std::size_t n = edits(random); n > 0; --n) {
      const std::size_t at = std::uniform_int_distribution<std::size_t>(0, text.size())(random);
      switch (kind(random)) {
        case 0:
          text.insert(at, bits[bit(random)]);
          break;
        case 1:
          text.erase(at, byte(random) % 10);
          break;
        case 2:
          text.insert(at, text.substr(at / 2, byte(random) % 40));
          break;
        default:
          text.insert(at, 1, static_cast<char>(byte(random)));
      }
    }
    try {
      for (const CurvePoint& point : parse_curve(text, "f").points)
        ASSERT_TRUE(point.depth > 0 && std::isfinite(point.F_c.value) &&
                    (!point.F_t || std::isfinite(point.F_t->value)))
            << text;
      ++read;
    } catch (const InputError& error) {
      ASSERT_THAT(error.what(), MatchesRegex("f:[0-9]+:[0-9]+: .*")) << text;
      ++refused;
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 5000);
}

}  // namespace
}  // namespace kerf::data
