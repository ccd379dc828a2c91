#include "inverse/dakota.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/base/error.hpp"

namespace kerf {
namespace {

using inverse::read_dakota_request;
using ::testing::HasSubstr;

// As Dakota 6 writes them: counts are right-aligned, what is not needed here follows.
constexpr const char* standard = R"(                                          2 variables
                     1.650000000000000e+01 yield_stress
                     1.250000000000000e-01 friction
                                          3 functions
                                          1 ASV_1:F_c
                                          0 ASV_2:F_t
                                          1 ASV_3:chip
                                          2 derivative_variables
                                          1 DVV_1:yield_stress
                                          2 DVV_2:friction
                                          0 analysis_components
                                          7 eval_id
)";
constexpr const char* aprepro = R"(                    { DAKOTA_VARS = 2 }
                    { yield_stress = 1.650000000000000e+01 }
                    { friction = 1.250000000000000e-01 }
                    { DAKOTA_FNS = 3 }
                    { ASV_1:F_c = 1 }
                    { ASV_2:F_t = 0 }
                    { ASV_3:chip = 1 }
                    { DAKOTA_DER_VARS = 2 }
                    { DVV_1:yield_stress = 1 }
                    { DVV_2:friction = 2 }
                    { DAKOTA_AN_COMPS = 0 }
                    { DAKOTA_EVAL_ID = 7 }
)";

std::string changed(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST(Dakota, ReadsBothFormats) {
  for (const char* text : {standard, aprepro}) {
    const inverse::DakotaRequest request = read_dakota_request(text, "params.in");
    EXPECT_THAT(request.variables,
                ::testing::ElementsAre(::testing::Pair("yield_stress", 16.5), ::testing::Pair("friction", 0.125)));
    ASSERT_EQ(request.functions.size(), 3u);
    EXPECT_EQ(inverse::dakota_results(request, {0.5, 2, -0.25}),
              "5.00000000000000000e-01 F_c\n-2.50000000000000000e-01 chip\n");
  }
}

TEST(Dakota, SaysWhatIsWrongAndWhere) {
  const auto refused = [](const std::string& text, const char* why) {
    EXPECT_THAT([&] { read_dakota_request(text, "params.in"); }, ::testing::ThrowsMessage<InputError>(HasSubstr(why)))
        << text;
  };
  refused("", "params.in: ends before the number of variables");
  refused(changed(standard, "1.65", "1.6f"), "params.in:2: yield_stress = \"1.6f");
  refused(changed(standard, "2 variables", "3 variables"), "params.in:5: \"ASV_1:F_c\" stands where");
  refused(changed(standard, "1 ASV_1", "3 ASV_1"), "params.in:5: ASV_1:F_c = 3: only values");
  refused(changed(aprepro, "DAKOTA_FNS = 3", "DAKOTA_FNS = -3"), "params.in:4: \"-3\" is not a number of functions");
  refused("1 variables\nlonely\n", "params.in:2: \"lonely\" is neither");
}

}  // namespace
}  // namespace kerf
