// Where the material of a cut is laid: all of it, and one particle in a cell only where the scene says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "forward/mpm/window.hpp"
#include "tests/shipped_scene.hpp"

namespace kerf::forward {
namespace {

using kerf::testing::shipped;

double mass_of(const State& state) {
  double sum = 0;
  for (const double volume : state.particles.volume) sum += volume;
  return sum;
}

struct Layout {
  std::size_t coarse = 0, fine = 0;
  double highest_coarse = -1e9, lowest_fine = 1e9, farthest_from_midway = 0;  ///< in depths; in cells
};
/// Of the material below the crack plane.
Layout base_of(const Scene& scene, const State& state) {
  Layout found;
  const Particles& p = state.particles;
  const double shared = scene.cell() * scene.cell_length() / 4;
  for (std::size_t i = 0; i < p.begin[above]; ++i) {
    if (p.volume[i] == 0) continue;  // padding
    if (p.volume[i] < 1.5 * shared) {
      ++found.fine;
      found.lowest_fine = std::min(found.lowest_fine, p.y[i] / scene.cut.depth);
      continue;
    }
    ++found.coarse;
    found.highest_coarse = std::max(found.highest_coarse, p.y[i] / scene.cut.depth);
    if (p.volume[i] < 3.5 * shared) continue;  // the lowest half cell
    const double row = state.grid.row_of(p.y[i]), column = state.grid.column_of(p.x[i]);
    for (const double at : {row, column})
      found.farthest_from_midway = std::max(found.farthest_from_midway, std::abs(at - std::floor(at) - 0.5));
  }
  return found;
}

TEST(LayOut, OneParticleInACellFromThereOn) {
  const Scene all = shipped("verification_45");
  const State plain = lay_out(all);
  for (const double depths : {0.5, 1.0, 1.99, 3.0}) {
    const Scene scene = shipped("verification_45", {{"resolution.single_particle_below", depths}});
    const State state = lay_out(scene);
    EXPECT_NEAR(mass_of(state), mass_of(plain), 1e-12 * mass_of(plain));
    const Layout base = base_of(scene, state);
    EXPECT_LT(base.highest_coarse, -depths);
    EXPECT_GT(base.lowest_fine, -depths - 1.0 / 8);
    EXPECT_LT(base.farthest_from_midway, 1e-9) << "on a row of nodes alternating strains would not be felt";
    const double columns = scene.window.ahead * 8, rows = (scene.window.below - depths) * 8;
    EXPECT_NEAR(static_cast<double>(base.coarse), columns * rows, columns) << depths;
    EXPECT_EQ(base.fine + 4 * base.coarse, base_of(all, plain).fine + 2 * static_cast<std::size_t>(columns))
        << "four for one, two for one in the lowest row";
  }
}

TEST(LayOut, DeeperThanTheBaseChangesNothing) {
  const State plain = lay_out(shipped("verification_45"));
  const State deep = lay_out(shipped("verification_45", {{"resolution.single_particle_below", 50}}));
  EXPECT_EQ(deep.particles.x, plain.particles.x);
  EXPECT_EQ(deep.particles.volume, plain.particles.volume);
}

TEST(LayOut, ASpecimenHasNoBase) {
  const State plain = lay_out(shipped("dcb_rcurve"));
  const State other = lay_out(shipped("dcb_rcurve", {{"resolution.single_particle_below", 0.5}}));
  EXPECT_EQ(other.particles.volume, plain.particles.volume);
}

}  // namespace
}  // namespace kerf::forward
