#include "models/base/units.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace kerf {
namespace {

TEST(Units, AreConsistentWithMillimetreMegapascalNewton) {
  struct Case {
    const char* unit;
    double factor;
  };
  const Case cases[] = {
      {"mm", 1},
      {"um", 1e-3},
      {"µm", 1e-3},
      {"m", 1e3},
      {"MPa", 1},
      {"GPa", 1e3},
      {"Pa", 1e-6},
      {"N/mm", 1},
      {"N/m", 1e-3},
      {"kN/m", 1},
      {"J/m^2", 1e-3},
      {"kJ/m^2", 1},
      {"kJ/m²", 1},
      {"kg/m^3", 1e-12},
      {"g/cm^3", 1e-9},
      {"tonne/mm^3", 1},
      {"mm/s", 1},
      {"m/s", 1e3},
      {"m/min", 1e3 / 60},
      {"s", 1},
      {"us", 1e-6},
      {"N", 1},
      {"kN", 1e3},
      {"mJ", 1},
      {"1", 1},
      {"1/s", 1},
      {"1 / ms", 1e3},
      {"K", 1},
      {"rad", 1},
      {"deg", std::numbers::pi / 180},
      {"°", std::numbers::pi / 180},
      {"mm2", 1},
      {"m**2", 1e6},
      {"mm^-1", 1},
      {"N.mm", 1},
  };
  for (const Case& c : cases) EXPECT_DOUBLE_EQ(consistent_units_in(c.unit), c.factor) << c.unit;
}

TEST(Units, TellAnglesFromPureNumbersAndForcesFromForcesPerWidth) {
  EXPECT_TRUE(same_dimension("J/m^2", "N/mm"));
  EXPECT_TRUE(same_dimension("deg", "rad"));
  EXPECT_TRUE(same_dimension("Pa", "N/mm^2"));
  EXPECT_FALSE(same_dimension("deg", "1"));
  EXPECT_FALSE(same_dimension("rad/s", "1/s"));
  EXPECT_FALSE(same_dimension("N", "N/mm"));
  EXPECT_FALSE(same_dimension("J", "J/m^2"));
}

TEST(Units, RefuseWhatUdunitsWouldQuietlyMisread) {
  // UDUNITS reads "mm^0.5" as the number 5, and "1 200 mm" as 200 mm.
  for (const char* unit : {"mm^0.5",
                           "1 200 mm",
                           "200 mm",
                           "2",
                           "2 mm",
                           "N/2mm",
                           "mm 2",
                           "MPa mm^0.5",
                           "",
                           " ",
                           "Mpa",
                           "furlongs per",
                           "mm;",
                           "N\xff",
                           "degC",
                           "A",
                           "cd",
                           "lg(re mm)",
                           "mm since 2000-01-01",
                           "dB"})
    EXPECT_THROW(consistent_units_in(unit), std::invalid_argument) << unit;
}

TEST(Units, TheConsistentUnitOfADimensionHasTheFactorOne) {
  for (const char* unit :
       {"GPa", "J/m^2", "deg", "kg/m^3", "1", "m/min", "kN", "um^2", "1/ms", "K", "J", "GPa/m", "h"}) {
    EXPECT_TRUE(same_dimension(consistent_unit(unit), unit)) << unit;
    EXPECT_EQ(consistent_units_in(consistent_unit(unit)), 1.0) << unit;
  }
}

TEST(Units, SplitAQuantityAsAUserWritesIt) {
  struct Case {
    const char* text;
    double number;
    const char* unit;
  };
  for (const Case& c : {Case{"0.5 mm", 0.5, "mm"}, Case{"0.5", 0.5, ""}, Case{" -3e-2  J/m^2 ", -0.03, "J/m^2"},
                        Case{"+7mm", 7, "mm"}, Case{"5e", 5, "e"}, Case{"1. m", 1, "m"}, Case{".5 m", 0.5, "m"}}) {
    const Quantity quantity = split_quantity(c.text);
    EXPECT_EQ(quantity.number, c.number) << c.text;
    EXPECT_EQ(quantity.unit, c.unit) << c.text;
  }
  for (const char* text : {"", "mm", "inf mm", "nan", "-inf", "1e999 mm", "1,5 mm", "+-3 mm", "--3", "- 3 mm", "x1"})
    EXPECT_THROW(split_quantity(text), std::invalid_argument) << text;
}

TEST(Units, NumbersSurviveBeingWrittenAndSplit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-30, 30), mantissa(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const double value = mantissa(random) * std::pow(10.0, exponent(random));
    EXPECT_EQ(split_quantity(fmt::format("{} MPa", value)).number, value);
  }
}

TEST(Units, MayBeAskedFromManyThreads) {
  std::vector<std::thread> threads;
  std::vector<double> sums(8);
  for (std::size_t t = 0; t < sums.size(); ++t)
    threads.emplace_back([&sums, t] {
      // Units nobody asked for before, so that every thread parses.
      for (int power = 1; power <= 40; ++power) sums[t] += consistent_units_in(fmt::format("mm^{}", power + 40));
    });
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, 40.0);
}

}  // namespace
}  // namespace kerf
