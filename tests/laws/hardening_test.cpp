#include "models/laws/hardening.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace kerf::laws {
namespace {

template <class Hardening>
void check_slope_and_work(const Hardening& curve) {
  for (const double eps : {1e-3, 0.05, 0.4, 2.0}) {
    const double h = 1e-6 * eps;
    EXPECT_NEAR(curve.slope(eps), (curve.flow_stress(eps + h) - curve.flow_stress(eps - h)) / (2 * h),
                1e-7 * (curve.slope(eps) + 1.0) + 1e-9 * curve.flow_stress(eps) / eps);
    EXPECT_NEAR(curve.flow_stress(eps), (curve.work(eps + h) - curve.work(eps - h)) / (2 * h),
                1e-8 * curve.flow_stress(eps));
  }
  EXPECT_EQ(curve.flow_stress(0.0), curve.yield_stress);
  EXPECT_EQ(curve.work(0.0), 0.0);
}

TEST(Hardening, SlopeAndWorkBelongToTheFlowStress) {
  check_slope_and_work(LinearHardening{.yield_stress = 25, .modulus = 50});
  for (const double n : {0.2, 0.5, 1.0, 2.0})
    check_slope_and_work(PowerHardening{.yield_stress = 25, .coefficient = 2, .exponent = n});
  check_slope_and_work(SaturatingHardening{.yield_stress = 25, .saturation_stress = 60, .saturation_strain = 0.1});
}

TEST(Hardening, HasItsClosedFormValues) {
  EXPECT_NEAR((PowerHardening{10, 3, 0.5}.flow_stress(0.25)), 25.0, 1e-13);
  EXPECT_NEAR((PowerHardening{10, 3, 0.5}.work(0.25)), 10 * (0.25 + 3 * 0.125 / 1.5), 1e-13);
  EXPECT_TRUE(std::isinf((PowerHardening{10, 3, 0.5}.slope(0.0))));
  EXPECT_EQ((PowerHardening{10, 0, 0.5}.slope(0.0)), 0.0);
  EXPECT_NEAR((SaturatingHardening{10, 30, 0.1}.flow_stress(0.1)), 30 - 20 / std::exp(1.0), 1e-13);
  EXPECT_NEAR((SaturatingHardening{10, 30, 0.1}.flow_stress(10.0)), 30, 1e-13);
}

}  // namespace
}  // namespace kerf::laws
