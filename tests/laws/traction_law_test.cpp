#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "models/base/document.hpp"
#include "models/base/error.hpp"
#include "models/laws/cubic.hpp"
#include "models/laws/exponential.hpp"
#include "models/laws/linear_softening.hpp"
#include "models/laws/sawtooth.hpp"
#include "models/laws/traction_law.hpp"
#include "models/laws/trilinear.hpp"

namespace kerf::laws {
namespace {

using ::testing::HasSubstr;

/// A law to hold against the identities of the family, and the openings at which its traction has a kink.
struct Member {
  std::string name;
  std::unique_ptr<TractionLaw> law;
  std::vector<double> kinks;
};

constexpr Trilinear::Shape bridged{
    .strength = 4.65, .peak_opening = 0.01, .bridging_stress = 0.8, .knee_opening = 0.094, .critical_opening = 1.0125};

/// Members of the family. A new law joins with one line.
std::vector<Member> members() {
  std::vector<Member> laws;
  laws.push_back({"cubic", std::make_unique<Cubic>(40.0, 2.0), {}});
  laws.push_back({"cubic", std::make_unique<Cubic>(4.65, 0.215), {}});
  laws.push_back({"sawtooth", std::make_unique<Sawtooth>(4.65, 0.645, 0.1), {0.1 * 2.0 * 0.645 / 4.65}});
  laws.push_back({"sawtooth", std::make_unique<Sawtooth>(40.0, 2.0, 0.7), {0.07}});
  laws.push_back({"linear_softening", std::make_unique<LinearSoftening>(0.8, 0.405, 0.02), {0.02 * 1.0125}});
  laws.push_back({"exponential", std::make_unique<Exponential>(40.0, 2.0), {}});
  laws.push_back({"trilinear", std::make_unique<Trilinear>(bridged), {0.01, 0.094}});
  return laws;
}

/// Simpson's rule from kink to kink.
double integral(const Member& member, double to) {
  std::vector<double> ends{0.0};
  for (const double kink : member.kinks)
    if (kink < to) ends.push_back(kink);
  ends.push_back(to);
  double sum = 0.0;
  for (std::size_t part = 1; part < ends.size(); ++part) {
    constexpr int intervals = 2000;
    const double from = ends[part - 1], step = (ends[part] - from) / intervals;
    const auto traction = [&](int i) { return member.law->traction(i == intervals ? ends[part] : from + i * step); };
    double here = traction(0) + traction(intervals);
    for (int i = 1; i < intervals; ++i) here += (i % 2 ? 4.0 : 2.0) * traction(i);
    sum += here * step / 3.0;
  }
  return sum;
}

TEST(TractionLaws, EveryRegisteredLawHasAMemberHere) {
  std::set<std::string> registered, here;
  for (const TractionLawKind& kind : traction_laws()) registered.insert(kind.name);
  for (const Member& member : members()) here.insert(member.name);
  EXPECT_EQ(registered, here);
}

TEST(TractionLaws, AreaIsTheIntegralOfTraction) {
  for (const Member& member : members())
    for (const double share : {0.005, 0.1, 1.0 / 3.0, 0.5, 0.8, 0.9, 1.0}) {
      const double to = share * member.law->critical_opening();
      EXPECT_NEAR(member.law->area(to), integral(member, to), 1e-9 * member.law->toughness()) << member.name << share;
    }
}

TEST(TractionLaws, TheWholeAreaIsTheToughness) {
  for (const auto& [name, law, kinks] : members()) {
    EXPECT_DOUBLE_EQ(law->area(law->critical_opening()), law->toughness()) << name;
    EXPECT_DOUBLE_EQ(law->area(3.0 * law->critical_opening()), law->toughness()) << name;
  }
}

TEST(TractionLaws, ThePeakIsTheStrengthAndNothingIsLeftAfterTheCriticalOpening) {
  for (const auto& [name, law, kinks] : members()) {
    double peak = 0.0;
    for (int i = 0; i <= 30000; ++i) peak = std::max(peak, law->traction(i * law->critical_opening() / 30000));
    for (const double kink : kinks) peak = std::max(peak, law->traction(kink));
    EXPECT_NEAR(peak, law->strength(), 1e-7 * law->strength()) << name;
    EXPECT_EQ(law->traction(0.0), 0.0) << name;
    EXPECT_EQ(law->traction(law->critical_opening()), 0.0) << name;
    EXPECT_EQ(law->traction(10.0 * law->critical_opening()), 0.0) << name;
    EXPECT_EQ(law->slope(law->critical_opening()), 0.0) << name;
  }
}

TEST(TractionLaws, SlopeIsTheDerivativeOfTractionAwayFromKinks) {
  for (const auto& [name, law, kinks] : members()) {
    const double end = law->critical_opening(), h = 1e-6 * end;
    for (int i = 1; i < 500; ++i) {
      const double at = (i + 0.37) * end / 501;
      bool near_kink = false;
      for (const double kink : kinks) near_kink = near_kink || std::abs(at - kink) < 2.0 * h;
      if (near_kink) continue;
      EXPECT_NEAR(law->slope(at), (law->traction(at + h) - law->traction(at - h)) / (2.0 * h),
                  1e-7 * law->strength() / end)
          << name << " at " << at / end;
    }
    for (const double kink : kinks)  // the slope ahead
      EXPECT_NEAR(law->slope(kink), (law->traction(kink + h) - law->traction(kink)) / h, 1e-7 * law->strength() / end)
          << name;
    EXPECT_NEAR(law->slope(0.0), law->traction(1e-9 * end) / (1e-9 * end), 1e-7 * law->slope(0.0)) << name;
  }
}

TEST(TractionLaws, DissipationNeverFallsAndEndsAtTheToughness) {
  for (const auto& [name, law, kinks] : members()) {
    double before = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double now = law->dissipated(i * law->critical_opening() / 1000);
      EXPECT_GE(now, before - 1e-14 * law->toughness()) << name;
      EXPECT_LE(now, law->area(i * law->critical_opening() / 1000)) << name;
      before = now;
    }
    EXPECT_DOUBLE_EQ(law->dissipated(law->critical_opening()), law->toughness()) << name;
  }
}

TEST(Cubic, PeaksAtAThirdOfTheCriticalOpening) {
  const Cubic law(40.0, 2.0);
  EXPECT_NEAR(law.critical_opening(), 0.0888888889, 1e-9);
  EXPECT_NEAR(law.traction(law.critical_opening() / 3.0), 40.0, 1e-12);
}

TEST(Cubic, DissipatesTheCubeOfTheOpening) {
  const Cubic law(40.0, 2.0);
  for (const double d : {0.01, 0.2, 1.0 / 3.0, 0.6, 0.95})
    EXPECT_NEAR(law.dissipated(d * law.critical_opening()), 2.0 * d * d * d * (4.0 - 3.0 * d), 1e-14);
}

TEST(Sawtooth, IsTheTriangleOfTheDouglasFirModeTwo) {
  const Sawtooth law(4.65, 0.645, 0.1);
  EXPECT_NEAR(law.critical_opening(), 0.277419, 1e-6);  // 0.278 mm printed
  EXPECT_NEAR(law.traction(0.05 * law.critical_opening()), 4.65 / 2, 1e-12);
  EXPECT_NEAR(law.traction(0.55 * law.critical_opening()), 4.65 / 2, 1e-12);
  EXPECT_NEAR(law.dissipated(0.1 * law.critical_opening()), 0.0, 1e-16);
}

TEST(LinearSoftening, KeepsStressOpeningAndToughnessWhateverTheRise) {
  for (const double rise : {1e-3, 0.02, 0.1}) {
    const LinearSoftening law(0.8, 0.405, rise);
    EXPECT_NEAR(law.critical_opening(), 1.0125, 1e-12);
    EXPECT_NEAR(law.toughness(), 0.405, 1e-14);
    for (const double d : {0.15, 0.5, 0.9}) EXPECT_NEAR(law.traction(1.0125 * d), 0.8 * (1.0 - d), 0.8 * rise);
  }
}

TEST(Exponential, FollowsTheEndlessLawUpToItsTailAndLosesNoArea) {
  const Exponential law(40.0, 2.0);
  const double d0 = law.peak_opening();
  EXPECT_NEAR(d0, 1.0085 * 2.0 / (40.0 * std::exp(1.0)), 1e-6);
  EXPECT_NEAR(law.critical_opening(), 7.2 * d0, 1e-14);
  for (const double x : {0.3, 1.0, 2.5, 5.9}) EXPECT_NEAR(law.traction(x * d0), 40.0 * x * std::exp(1.0 - x), 1e-12);
  EXPECT_NEAR(law.traction(6.0 * d0 * (1 - 1e-9)), law.traction(6.0 * d0 * (1 + 1e-9)), 1e-6);
  EXPECT_NEAR(law.slope(6.0 * d0 * (1 - 1e-9)), law.slope(6.0 * d0 * (1 + 1e-9)), 1e-5);
}

/// Reads a law as a scene would.
std::unique_ptr<TractionLaw> read(const std::string& keys) {
  std::vector<Block> blocks;
  for (const TractionLawKind& kind : traction_laws())
    blocks.push_back({.path = "mode", .variant = kind.name, .meaning = kind.meaning, .parameters = kind.parameters});
  return make_traction_law(Document::parse("[mode]\n" + keys, "cut.toml").read(blocks).at("mode"));
}

std::string complaint(const std::string& keys) {
  try {
    read(keys);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(TractionLaws, AreMadeByTheirNamesInAFile) {
  const std::string keys = "strength = \"40 MPa\"\ntoughness = \"2000 J/m^2\"\n";
  for (const char* name : {"cubic", "sawtooth", "linear_softening", "exponential"}) {
    const auto law = read("law = \"" + std::string(name) + "\"\n" + keys);
    EXPECT_DOUBLE_EQ(law->strength(), 40.0) << name;
    EXPECT_NEAR(law->toughness(), 2.0, 1e-14) << name;
  }
  EXPECT_DOUBLE_EQ(read("law = \"sawtooth\"\n" + keys)->traction(0.005), 20.0);  // default peak of a tenth
}

const std::vector<std::pair<std::string, std::pair<double, std::string>>>& quantities_of_the_bridged_law() {
  const Trilinear law(bridged);
  static const std::vector<std::pair<std::string, std::pair<double, std::string>>> all{
      {"strength", {bridged.strength, "MPa"}},
      {"peak_opening", {bridged.peak_opening, "mm"}},
      {"bridging_stress", {bridged.bridging_stress, "MPa"}},
      {"knee_opening", {bridged.knee_opening, "mm"}},
      {"critical_opening", {bridged.critical_opening, "mm"}},
      {"initiation_toughness", {law.initiation_toughness(), "N/mm"}},
      {"bridging_toughness", {law.bridging_toughness(), "N/mm"}},
      {"toughness", {law.toughness(), "N/mm"}},
      {"peak", {bridged.peak_opening / bridged.knee_opening, ""}}};
  return all;
}

/// Rank of the given quantities as functions of the five of the shape, by elimination on their gradients.
int rank_of(unsigned chosen) {
  const auto& s = bridged;
  const double gradients[9][5] = {
      {1, 0, 0, 0, 0},
      {0, 1, 0, 0, 0},
      {0, 0, 1, 0, 0},
      {0, 0, 0, 1, 0},
      {0, 0, 0, 0, 1},
      {s.knee_opening, -s.bridging_stress, -s.peak_opening, s.strength, 0},
      {0, 0, s.critical_opening, 0, s.bridging_stress},
      {s.knee_opening, -s.bridging_stress, s.critical_opening - s.peak_opening, s.strength, s.bridging_stress},
      {0, s.knee_opening, 0, -s.peak_opening, 0}};
  std::vector<std::vector<double>> rows;
  for (unsigned i = 0; i < 9; ++i)
    if (chosen >> i & 1u) rows.emplace_back(gradients[i], gradients[i] + 5);
  int rank = 0;
  for (std::size_t column = 0; column < 5; ++column) {
    auto pivot = static_cast<std::size_t>(rank);
    for (std::size_t r = pivot; r < rows.size(); ++r)
      if (std::abs(rows[r][column]) > std::abs(rows[pivot][column])) pivot = r;
    if (pivot >= rows.size() || std::abs(rows[pivot][column]) < 1e-9) continue;
    const auto top = static_cast<std::size_t>(rank++);
    std::swap(rows[top], rows[pivot]);
    for (std::size_t r = top + 1; r < rows.size(); ++r) {
      const double factor = rows[r][column] / rows[top][column];
      for (std::size_t c = column; c < 5; ++c) rows[r][c] -= factor * rows[top][c];
    }
  }
  return rank;
}

TEST(Trilinear, AnyFiveIndependentQuantitiesMakeTheSameLawAndNothingElseDoes) {
  int accepted = 0;
  for (unsigned chosen = 0; chosen < 512; ++chosen) {
    std::string keys = "law = \"trilinear\"\n";
    int given = 0;
    for (unsigned i = 0; i < 9; ++i)
      if (chosen >> i & 1u) {
        const auto& [key, value] = quantities_of_the_bridged_law()[i];
        char text[64];
        std::snprintf(text, sizeof text, value.second.empty() ? "%.17g" : "\"%.17g %s\"", value.first,
                      value.second.c_str());
        keys += key + " = " + text + "\n";
        ++given;
      }
    if (given == 5 && rank_of(chosen) == 5) {
      const auto law = read(keys);
      const auto& shape = dynamic_cast<const Trilinear&>(*law).shape();
      EXPECT_NEAR(shape.strength, bridged.strength, 1e-12) << keys;
      EXPECT_NEAR(shape.peak_opening, bridged.peak_opening, 1e-12) << keys;
      EXPECT_NEAR(shape.bridging_stress, bridged.bridging_stress, 1e-12) << keys;
      EXPECT_NEAR(shape.knee_opening, bridged.knee_opening, 1e-12) << keys;
      EXPECT_NEAR(shape.critical_opening, bridged.critical_opening, 1e-12) << keys;
      ++accepted;
    } else {
      EXPECT_THROW(read(keys), InputError) << keys;
    }
  }
  EXPECT_EQ(accepted, 75);  // of the 126 choices of five; the others hold a relation twice
}

TEST(Trilinear, IsTheDouglasFirTangentialLawOfACalibration) {
  const auto law = read(
      "law = \"trilinear\"\ninitiation_toughness = \"215 J/m^2\"\nbridging_toughness = \"405 J/m^2\"\n"
      "bridging_stress = \"0.8 MPa\"\nstrength = \"4.65 MPa\"\npeak = 0.1\n");
  const auto& trilinear = dynamic_cast<const Trilinear&>(*law);
  EXPECT_NEAR(law->critical_opening(), 1.0125, 1e-12);
  EXPECT_NEAR(law->toughness(), 0.620, 1e-12);
  EXPECT_NEAR(trilinear.shape().knee_opening, 2.0 * 0.215 / (4.65 - 0.08), 1e-12);
  EXPECT_NEAR(trilinear.initiation_toughness(), 0.215, 1e-14);
  EXPECT_NEAR(trilinear.bridging_toughness(), 0.405, 1e-14);
}

TEST(Trilinear, SaysWhatIsGivenWhatIsMissingAndWhatContradicts) {
  const std::string start = "law = \"trilinear\"\nstrength = \"4.65 MPa\"\n";
  const std::string few = complaint(start + "bridging_toughness = \"405 J/m^2\"\nbridging_stress = \"0.8 MPa\"\n");
  EXPECT_THAT(few, HasSubstr("cut.toml:3:"));
  EXPECT_THAT(few, HasSubstr("2 are missing"));
  EXPECT_THAT(few, HasSubstr("given: strength, bridging_stress, bridging_toughness"));
  EXPECT_THAT(few, HasSubstr("missing: 2 of peak_opening, knee_opening, initiation_toughness, toughness, peak"));
  EXPECT_THAT(complaint("law = \"trilinear\"\n"), HasSubstr("nothing is given"));

  const std::string tied = complaint(start +
                                     "initiation_toughness = \"215 J/m^2\"\nbridging_toughness = \"405 J/m^2\"\n"
                                     "toughness = \"620 J/m^2\"\npeak = 0.1\n");
  EXPECT_THAT(tied, HasSubstr("toughness = initiation_toughness + bridging_toughness"));
  EXPECT_THAT(tied, HasSubstr("not independent"));

  const std::string many = complaint(start +
                                     "initiation_toughness = \"215 J/m^2\"\nbridging_toughness = \"405 J/m^2\"\n"
                                     "bridging_stress = \"0.8 MPa\"\npeak = 0.1\npeak_opening = \"0.01 mm\"\n");
  EXPECT_THAT(many, HasSubstr("6 are too many"));

  const auto five = [](const char* stress, const char* knee) {
    return complaint("law = \"trilinear\"\nstrength = \"4.65 MPa\"\npeak_opening = \"0.01 mm\"\nknee_opening = \"" +
                     std::string(knee) + "\"\nbridging_stress = \"" + stress + "\"\ncritical_opening = \"1 mm\"\n");
  };
  EXPECT_EQ(five("0.8 MPa", "0.1 mm"), "no complaint");
  EXPECT_THAT(five("4.65 MPa", "0.1 mm"), HasSubstr("bridging_stress = 4.65 MPa must be below strength = 4.65 MPa"));
  EXPECT_THAT(five("0.8 MPa", "0.005 mm"), HasSubstr("peak_opening = 0.01 mm must be below knee_opening = 0.005 mm"));
  EXPECT_THAT(five("0.8 MPa", "2 mm"), HasSubstr("knee_opening = 2 mm must be below critical_opening = 1 mm"));
  // 620 J/m^2 in all cannot hold 700 J/m^2 of initiation.
  EXPECT_THAT(complaint(start + "peak = 0.1\nknee_opening = \"0.1 mm\"\ninitiation_toughness = \"700 J/m^2\"\n"
                                "toughness = \"620 J/m^2\"\n"),
              HasSubstr("not positive"));
}

}  // namespace
}  // namespace kerf::laws
