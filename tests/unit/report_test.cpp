#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "forward/record/cut_file.hpp"
#include "tests/unit/run_kerf.hpp"
#include "tests/unit/sample_cut.hpp"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using testing::HasSubstr;

Json estimate(double value, double error, double lower, double upper, const char* unit, const char* verdict) {
  return {{"value", value}, {"se", error}, {"interval", {lower, upper}}, {"unit", unit}, {"verdict", verdict}};
}

Json sample_result() {
  Json result;
  result["title"] = "Twin experiment <made by hand> & read back";
  result["statement"] = "The yield stress is measured, the toughness only bounded.";
  result["parameters"] = {{"yield_stress", estimate(1052, 38, 975, 1131, "MPa", "measured")},
                          {"toughness", estimate(13900, 5400, 7800, 25100, "J/m^2", "bounded above and below")},
                          {"friction", estimate(0.391, 0.021, 0.35, 0.433, "1", "measured")}};
  result["chi2"] = 8.8;
  result["degrees_of_freedom"] = 5;
  result["cuts"] = Json::array();
  for (int i = 1; i <= 3; ++i)
    result["cuts"].push_back(
        {{"curve", "twin"},
         {"depth_mm", 0.02 * i},
         {"rake_deg", 15},
         {"F_c", {{"measured", 60e3 * i}, {"se", 2e3}, {"fitted", 61e3 * i}, {"weighted_residual", -0.5 * i}}},
         {"F_t", {{"measured", 20e3 * i}, {"se", 1e3}, {"fitted", 19e3 * i}, {"weighted_residual", 1.0 * i}}}});
  result["identifiability"] = {{"names", {"yield_stress", "toughness", "friction"}},
                               {"singular_values", {40.0, 12.0, 1.5}},
                               {"singular_vectors", {{1, 0, 0}, {0, 0.6, 0.8}, {0, 0.8, -0.6}}},
                               {"correlation", {{1, -0.8, nullptr}, {-0.8, 1, 0.1}, {nullptr, 0.1, 1}}}};
  Json other = {{"assumption", "edge force adds its friction"}, {"parameters", result["parameters"]}, {"chi2", 9.4}};
  result["alternatives"] = Json::array({other});
  result["trace"] = {{{"runs", 3}, {"chi2", 60.0}, {"parameters", {{"yield_stress", 1300}, {"toughness", 9000}}}},
                     {{"runs", 9}, {"chi2", 8.8}, {"parameters", {{"yield_stress", 1052}, {"toughness", 13900}}}}};
  result["error_budget"] = {{"yield_stress", {{"measurement", 0.625}, {"discrepancy", 0.375}}}, {"friction", nullptr}};
  result["parameters"]["toughness"]["profile"] = {{"value", {7000, 13900, 27000}}, {"chi2", {13.0, 8.8, 14.0}}};
  result["method"] = "gauss_newton";
  result["core_s"] = 371.0;
  result["runs"] = 42;
  result["wall_s"] = 203.4;
  return result;
}

Json sample_reduction() {
  const Json curve = {
      {"depth_mm", {0.001, 0.03, 0.06}}, {"rake_deg", {15, 15, 15}}, {"F_c_N_per_m", {30e3, 90e3, nullptr}}};
  return {{"methods",
           {{"intercept_linear",
             {{"parameters", {{"toughness", estimate(33300, 6000, 19700, 46900, "J/m^2", "measured")}}},
              {"verdict", {{"statement", "accepted: chi2 = 0.02"}}},
              {"curve", curve}}},
            {"plastic_bending",
             {{"parameters", Json::object()}, {"verdict", {{"statement", "needs an elastic modulus"}}}}}}},
          {"warnings", {"the intercepts disagree"}}};
}

forward::CutResult write_sample_cut(const fs::path& h5) {
  const forward::CutResult cut = forward::sample_cut();
  write_cut(h5, Document::load(fs::path(KERF_SOURCE_DIR) / "data/scenes/verification_45.toml"), cut);
  return cut;
}

/// Nothing outside the file is asked for: no scripts, no links to sheets, every href and src is inside or data.
void expect_self_contained(const std::string& html) {
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  const std::regex reference(R"re((?:href|src)="([^"]{0,20})|url\(([^)]{0,20}))re");
  for (auto match = std::sregex_iterator(html.begin(), html.end(), reference); match != std::sregex_iterator();
       ++match) {
    const std::string target = (*match)[1].matched ? (*match)[1] : (*match)[2];
    EXPECT_TRUE(target.starts_with("#") || target.starts_with("data:")) << target;
  }
  std::string rest = std::regex_replace(html, std::regex(R"re(xmlns(:xlink)?="http://www\.w3\.org/[^"]*")re"), "");
  EXPECT_EQ(rest.find("http://"), std::string::npos);
  EXPECT_EQ(rest.find("https://"), std::string::npos);
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

class Report : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "run");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void put(const char* name, const Json& json) { std::ofstream(folder_ / "run" / name) << json.dump(2); }
  ProcessOutput report(const std::string& environment = "") {
    return run_kerf("report '" + (folder_ / "run").string() + "'", folder_, environment);
  }

  fs::path folder_ = fs::path(testing::TempDir()) /
                     ("kerf_report_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(Report, TellsACalibrationInOneSelfContainedPage) {
  put("result.json", sample_result());
  put("reduction.json", sample_reduction());
  put("manifest.json", {{"code_version", "0.1.0"}, {"inputs", {{{"name", "job.toml"}, {"sha256", "abc123"}}}}});
  write_sample_cut(folder_ / "run" / "cuts" / "cut_1.h5");
  const ProcessOutput run = report();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, (folder_ / "run" / "report.html").string() + "\n");

  const std::string html = content_of(folder_ / "run" / "report.html");
  expect_self_contained(html);
  for (const char* name : {"yield stress", "toughness", "friction", "bounded above and below", "linear intercept",
                           "the intercepts disagree", "needs an elastic modulus", "edge force adds its friction",
                           "abc123", "&lt;made by hand&gt; &amp; read back"})
    EXPECT_THAT(html, HasSubstr(name));
  const char* thin = "\u202f";  // groups the thousands
  for (const std::string& value :
       {std::string("1") + thin + "052 ± 38 MPa", std::string("13") + thin + "900 ± 5" + thin + "400 J/m²",
        std::string("0.391 ± 0.021"), std::string("0.350 … 0.433")})
    EXPECT_THAT(html, HasSubstr(value));
  // Data, residuals, profiles, directions, correlation, error budget, intercepts and their curves, trace; force
  // history, chip and ledger of the cut.
  EXPECT_EQ(count(html, "<svg "), 12U);
}

TEST_F(Report, HasANumberInEverySection) {
  put("result.json", sample_result());
  put("reduction.json", sample_reduction());
  put("manifest.json", {{"version", "0.1.0"}, {"scene", "resolution = {cells_through_chip = 6.0}\n"}, {"job", ""}});
  ASSERT_EQ(report().exit_code, 0);
  const std::string html = content_of(folder_ / "run" / "report.html");
  const std::vector<std::pair<std::string, std::string>> sections{
      {"verdict", "8.80"},         {"data", "180"},
      {"residuals", "3 measured"}, {"profiles", "rises by 3.84"},
      {"directions", "12: 8.3 %"}, {"correlation", "−0.80"},
      {"budget", "62 %"},          {"edge", "9.40"},
      {"toughness", "33.3"},       {"search", "0 not (hollow)"},
      {"cost", "6.2 min"},         {"methods", "6 cells through the depth of cut"}};
  for (const auto& [anchor, number] : sections) {
    const std::size_t begin = html.find("<section id=\"" + anchor + "\">");
    ASSERT_NE(begin, std::string::npos) << anchor;
    EXPECT_THAT(html.substr(begin, html.find("</section>", begin) - begin), HasSubstr(number)) << anchor;
  }
}

TEST_F(Report, ShowsWhereAStoppedSearchStood) {
  Json result = sample_result();
  result["parameters"] = Json::object();
  result["identifiability"] = {{"names", Json::array()}, {"singular_values", Json::array()}};
  result["partial"] = true;
  result["stopped_at"] = {{"yield_stress", {{"value", 1350}, {"unit", "MPa"}}}};
  result.erase("error_budget");
  result["alternatives"] = Json::array();
  put("result.json", result);
  const ProcessOutput run = report();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string html = content_of(folder_ / "run" / "report.html");
  EXPECT_THAT(html, HasSubstr("Where the search stood"));
  EXPECT_THAT(html, HasSubstr(std::string("1") + "\u202f" + "350 MPa"));
  EXPECT_EQ(html.find("id=\"profiles\""), std::string::npos);
}

TEST_F(Report, LeavesOutWhatIsMissingWithANote) {
  Json bare;
  bare["parameters"] = sample_result()["parameters"];
  bare["parameters"]["toughness"]["se"] = nullptr;
  bare["parameters"]["toughness"]["interval"] = {nullptr, nullptr};
  put("result.json", bare);
  std::ofstream(folder_ / "run" / "cuts.txt") << "not a cut";
  const ProcessOutput run = report();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string html = content_of(folder_ / "run" / "report.html");
  EXPECT_THAT(html, HasSubstr("manifest.json is not there"));
  EXPECT_THAT(html, HasSubstr("holds no measured cuts"));
  EXPECT_THAT(html, HasSubstr("−∞ … ∞"));
}

TEST_F(Report, ClaimsOnlyWhatHoldsUnderEveryEdgeAssumption) {
  Json result = sample_result();
  result["parameters"]["toughness"]["interval_over_assumptions"] = {2500, 59400};
  put("result.json", result);
  ASSERT_EQ(report().exit_code, 0);
  const std::string html = content_of(folder_ / "run" / "report.html");
  EXPECT_THAT(html, HasSubstr("both edge assumptions"));
  EXPECT_THAT(html, HasSubstr(std::string("2\u202f500 … 59\u202f400")));
}

TEST_F(Report, NamesTheCutsThatCountForNothing) {
  Json result = sample_result();
  result["cuts"][1]["usable"] = false;
  result["cuts"][1]["refusals"] = {"no steady force within 1.2 mm"};
  result["cuts"][1]["F_c"]["fitted"] = nullptr;
  result["cuts"][1]["F_c"]["weighted_residual"] = nullptr;
  put("result.json", result);
  ASSERT_EQ(report().exit_code, 0);
  EXPECT_THAT(content_of(folder_ / "run" / "report.html"),
              HasSubstr("The cut at depth 0.0400 mm counts for nothing: no steady force within 1.2 mm"));
}

TEST_F(Report, ShowsASingleCut) {
  const fs::path h5 = folder_ / "one.h5";
  write_sample_cut(h5);
  const ProcessOutput run = run_kerf("report '" + h5.string() + "'", folder_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string html = content_of(folder_ / "one.html");
  expect_self_contained(html);
  EXPECT_THAT(html, HasSubstr(std::string("7") + "\u202f" + "612 ± 12 N/m"));
  EXPECT_THAT(html, HasSubstr("touching"));
  EXPECT_EQ(count(html, "<svg "), 3U);
}

TEST_F(Report, ShowsASpecimen) {
  forward::CutResult pulled = forward::sample_cut();
  pulled.is_specimen = true;
  pulled.faces = {};
  for (std::size_t i = 0; i < pulled.history.size(); ++i) {
    const double grown = 0.5 * static_cast<double>(i);
    pulled.history[i].extension = {
        .opening = 0.1 * grown, .crack = grown, .release = 0.03 * grown, .at_notch_I = 0.031 * grown};
  }
  const fs::path h5 = folder_ / "pulled.h5";
  write_cut(h5, Document::load(fs::path(KERF_SOURCE_DIR) / "data/scenes/dcb_rcurve.toml"), pulled);
  const ProcessOutput run = run_kerf("report '" + h5.string() + "'", folder_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string html = content_of(folder_ / "pulled.html");
  expect_self_contained(html);
  EXPECT_THAT(html, HasSubstr("crack grew by 19.5 mm"));
  EXPECT_EQ(count(html, "<svg "), 3U);
}

TEST_F(Report, ShowsARefusedCutThatNeverMoved) {
  forward::CutResult nothing;
  nothing.refusals = {"broke down at step 3"};
  const fs::path h5 = folder_ / "none.h5";
  write_cut(h5, Document::load(fs::path(KERF_SOURCE_DIR) / "data/scenes/verification_45.toml"), nothing);
  const ProcessOutput run = run_kerf("report '" + h5.string() + "'", folder_);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(content_of(folder_ / "none.html"), HasSubstr("broke down at step 3"));
}

TEST_F(Report, RefusesWhatIsNotThereOrNotAResult) {
  const ProcessOutput absent = run_kerf("report '" + (folder_ / "nowhere").string() + "'", folder_);
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_THAT(absent.err, HasSubstr("nowhere: no such file or directory"));

  const ProcessOutput empty = report();
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_THAT(empty.err, HasSubstr("result.json: not there"));

  std::ofstream(folder_ / "run" / "journal.jsonl") << "{}\n";
  EXPECT_THAT(report().err, HasSubstr("continue it with `kerf resume"));

  std::ofstream(folder_ / "run" / "result.json") << "{\"parameters\": ";
  const ProcessOutput broken = report();
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("result.json: cannot be read"));

  std::ofstream(folder_ / "false.h5") << "not HDF5";
  const ProcessOutput false_cut = run_kerf("report '" + (folder_ / "false.h5").string() + "'", folder_);
  EXPECT_EQ(false_cut.exit_code, 3);
  EXPECT_THAT(false_cut.err, HasSubstr("false.h5: not a cut"));
  EXPECT_FALSE(fs::exists(folder_ / "run" / "report.html"));
  EXPECT_FALSE(fs::exists(folder_ / "false.html"));
}

TEST_F(Report, SaysWhatToInstallWithoutPythonOrItsModules) {
  put("result.json", sample_result());
  const ProcessOutput no_python = report("KERF_PYTHON=/nonexistent/python3");
  EXPECT_EQ(no_python.exit_code, 1);
  EXPECT_THAT(no_python.err, HasSubstr("apt-get install python3"));

  // A Python that finds no packages: isolated, without the site directories.
  const fs::path bare = folder_ / "bare_python";
  std::ofstream(bare) << "#!/bin/sh\nexec /usr/bin/python3 -S \"$@\"\n";
  fs::permissions(bare, fs::perms::owner_all);
  const ProcessOutput no_modules = report("KERF_PYTHON='" + bare.string() + "'");
  EXPECT_EQ(no_modules.exit_code, 1);
  EXPECT_THAT(no_modules.err, HasSubstr("python3-matplotlib"));

  const ProcessOutput no_script = report("KERF_REPORT_SCRIPT=/nonexistent/report.py");
  EXPECT_EQ(no_script.exit_code, 1);
  EXPECT_THAT(no_script.err, HasSubstr("/nonexistent/report.py"));
}

}  // namespace
}  // namespace kerf
