#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/block.hpp"
#include "tests/bench/scalar.hpp"

namespace kerf::bench {
namespace {

/// Largest difference over the largest value.
double difference(const forward::Array& fast, const std::vector<ScalarKernel<double>::Particle>& scalar,
                  double ScalarKernel<double>::Particle::*member) {
  double most = 0, scale = 0;
  for (std::size_t i = 0; i < fast.size(); ++i) {
    most = std::max(most, std::abs(fast[i] - scalar[i].*member));
    scale = std::max(scale, std::abs(scalar[i].*member));
  }
  return most / scale;
}

TEST(Kernel, AgreesWithTheScalarReference) {
  const laws::Material material = polymer();
  const forward::State start = block(material, 4096, Flow::plastic);
  forward::State state = start;
  ScalarKernel<double> scalar(start, std::get<laws::J2<laws::LinearHardening>>(material), pic_share());
  for (int i = 0; i < 40; ++i) {
    kernel_step(state, material);
    scalar.step();
  }
  ASSERT_EQ(state.breakdown, "");
  ASSERT_EQ(yielding_share(start, state), 1.0);
  using P = ScalarKernel<double>::Particle;
  const forward::Particles& p = state.particles;
  const auto& reference = scalar.particles();
  EXPECT_LT(difference(p.x, reference, &P::x), 1e-10);
  EXPECT_LT(difference(p.y, reference, &P::y), 1e-10);
  EXPECT_LT(difference(p.velocity_x, reference, &P::velocity_x), 1e-10);
  EXPECT_LT(difference(p.velocity_y, reference, &P::velocity_y), 1e-10);
  EXPECT_LT(difference(p.stress_xx, reference, &P::xx), 1e-10);
  EXPECT_LT(difference(p.stress_yy, reference, &P::yy), 1e-10);
  EXPECT_LT(difference(p.stress_zz, reference, &P::zz), 1e-10);
  EXPECT_LT(difference(p.stress_xy, reference, &P::xy), 1e-10);
  EXPECT_LT(difference(p.plastic_strain, reference, &P::plastic_strain), 1e-10);
  EXPECT_NEAR(state.work.damping, scalar.damping(), 1e-10 * std::abs(scalar.damping()));
}

TEST(Kernel, YieldsInTheBlockOnlyWhereItIsMeantTo) {
  for (const laws::Material& material : {polymer(), wood()})
    for (const Flow flow : {Flow::elastic, Flow::plastic}) {
      forward::State state = block(material, 4096, flow), before;
      for (int i = 0; i < 40; ++i) {
        before = state;
        kernel_step(state, material);
      }
      EXPECT_EQ(yielding_share(before, state), flow == Flow::plastic ? 1.0 : 0.0);
    }
}

}  // namespace
}  // namespace kerf::bench
