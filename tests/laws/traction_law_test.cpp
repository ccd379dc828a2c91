#include <gtest/gtest.h>

#include <cmath>

#include "models/laws/cubic.hpp"
#include "models/laws/traction_law.hpp"

namespace kerf::laws {
namespace {

/// Members of the family to hold against the same identities. A new law joins with one line.
std::vector<std::unique_ptr<TractionLaw>> members() {
  std::vector<std::unique_ptr<TractionLaw>> laws;
  laws.push_back(std::make_unique<Cubic>(40.0, 2.0));
  laws.push_back(std::make_unique<Cubic>(4.65, 0.215));
  return laws;
}

double simpson(const TractionLaw& law, double to) {
  constexpr int intervals = 2000;
  const double step = to / intervals;
  double sum = law.traction(0.0) + law.traction(to);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 ? 4.0 : 2.0) * law.traction(i * step);
  return sum * step / 3.0;
}

TEST(TractionLaws, EveryRegisteredLawHasAMemberHere) {
  EXPECT_EQ(traction_laws().size(), 1u);
}

TEST(TractionLaws, AreaIsTheIntegralOfTraction) {
  for (const auto& law : members())
    for (const double share : {0.1, 1.0 / 3.0, 0.5, 0.8, 1.0})
      EXPECT_NEAR(law->area(share * law->critical_opening()), simpson(*law, share * law->critical_opening()),
                  1e-9 * law->toughness());
}

TEST(TractionLaws, TheWholeAreaIsTheToughness) {
  for (const auto& law : members()) {
    EXPECT_DOUBLE_EQ(law->area(law->critical_opening()), law->toughness());
    EXPECT_DOUBLE_EQ(law->area(3.0 * law->critical_opening()), law->toughness());
  }
}

TEST(TractionLaws, ThePeakIsTheStrengthAndNothingIsLeftAfterTheCriticalOpening) {
  for (const auto& law : members()) {
    double peak = 0.0;
    for (int i = 0; i <= 30000; ++i) peak = std::max(peak, law->traction(i * law->critical_opening() / 30000));
    EXPECT_NEAR(peak, law->strength(), 1e-7 * law->strength());
    EXPECT_EQ(law->traction(law->critical_opening()), 0.0);
    EXPECT_EQ(law->traction(10.0 * law->critical_opening()), 0.0);
  }
}

TEST(Cubic, PeaksAtAThirdOfTheCriticalOpening) {
  const Cubic law(40.0, 2.0);
  EXPECT_NEAR(law.critical_opening(), 0.0888888889, 1e-9);
  EXPECT_NEAR(law.traction(law.critical_opening() / 3.0), 40.0, 1e-12);
}

}  // namespace
}  // namespace kerf::laws
