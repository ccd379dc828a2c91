#include "forward/record/result_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/sample_cut.hpp"

namespace kerf::forward {
namespace {

TEST(ResultJson, ConvertsForcesToNewtonPerMetreAndEnergiesToJoulePerMetre) {
  const auto json = result_json(sample_cut());
  EXPECT_DOUBLE_EQ(json["F_c"]["value"], 7612);
  EXPECT_DOUBLE_EQ(json["F_c"]["se"], 12);
  EXPECT_EQ(json["F_c"]["unit"], "N/m");
  EXPECT_DOUBLE_EQ(json["F_t"]["value"], -7601);
  EXPECT_DOUBLE_EQ(json["faces"]["rake_normal"]["value"], 10760);
  EXPECT_DOUBLE_EQ(json["faces"]["bottom_tangential"]["value"], 62.5);
  // 1 N mm per mm of width is 1 mJ/mm = 1 J/m.
  EXPECT_DOUBLE_EQ(json["ledger"]["tool_work"], 20);
  EXPECT_EQ(json["ledger"]["unit"], "J/m");
}

TEST(ResultJson, HoldsEveryPromisedKey) {
  const auto json = result_json(sample_cut());
  for (const char* key : {"F_c", "F_t", "steady", "steady_from", "accepted", "refusals", "branch", "crack_lead",
                          "mode_I_fraction", "fracture_energy_ratio", "chip_ratio", "curl_radius", "faces", "ledger",
                          "deepest_penetration", "inertia_share", "cost"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const char* key : {"tool_work", "fracture", "plastic", "elastic", "kinetic", "friction", "damping", "residue"})
    EXPECT_TRUE(json["ledger"].contains(key)) << key;
  for (const char* key : {"wall_s", "processor_s", "particle_steps", "particle_steps_per_s"})
    EXPECT_TRUE(json["cost"].contains(key)) << key;
}

TEST(ResultJson, LedgerResidueIsWhatTheOthersLeave) {
  const auto ledger = result_json(sample_cut())["ledger"];
  double rest = ledger["tool_work"];
  for (const char* key : {"fracture", "plastic", "elastic", "kinetic", "friction", "damping"})
    rest -= ledger[key].get<double>();
  EXPECT_NEAR(ledger["residue"].get<double>(), rest, 1e-12);
  EXPECT_DOUBLE_EQ(ledger["residue"], 0.25);
}

TEST(ResultJson, DerivesSpeedAndCurlRadius) {
  const auto json = result_json(sample_cut());
  EXPECT_DOUBLE_EQ(json["cost"]["particle_steps_per_s"], 2e6);
  EXPECT_EQ(json["cost"]["stages"][1]["stage"], "stress");
  EXPECT_DOUBLE_EQ(json["cost"]["stages"][1]["cpu_s"], 3);
  EXPECT_DOUBLE_EQ(json["curl_radius"]["value"], 4);  // 1 / 0.25 per mm
  EXPECT_DOUBLE_EQ(json["curl_radius"]["se"], 0.8);   // 4 * 0.05 / 0.25
  EXPECT_EQ(json["curl_radius"]["unit"], "mm");
}

TEST(ResultJson, WritesNullForWhatIsNotFinite) {
  CutResult cut = sample_cut();
  cut.F_c = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  cut.crack_lead.value = std::numeric_limits<double>::quiet_NaN();
  cut.chip_curvature = {0, 0};
  cut.cost.wall_seconds = 0;
  const auto json = result_json(cut);
  EXPECT_TRUE(json["F_c"]["value"].is_null());
  EXPECT_TRUE(json["F_c"]["se"].is_null());
  EXPECT_TRUE(json["crack_lead"].is_null());
  EXPECT_TRUE(json["curl_radius"]["value"].is_null());
  EXPECT_TRUE(json["cost"]["particle_steps_per_s"].is_null());
  EXPECT_EQ(nlohmann::ordered_json::parse(json.dump()), json);
}

TEST(ResultJson, SaysWhyARunWasRefused) {
  CutResult cut = sample_cut();
  cut.accepted = cut.steady = false;
  cut.refusals = {"no steady force within 4.5 mm"};
  cut.branch = Branch::bending;
  const auto json = result_json(cut);
  EXPECT_FALSE(json["accepted"].get<bool>());
  EXPECT_FALSE(json["steady"].get<bool>());
  EXPECT_EQ(json["refusals"][0], "no steady force within 4.5 mm");
  EXPECT_EQ(json["branch"], "bending");
}

}  // namespace
}  // namespace kerf::forward
