#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace kerf::laws {

/// Return maps without a closed form work on this many material points at a time.
constexpr std::size_t batch_size = 8;
using Batch = std::array<double, batch_size>;

/// Largest relative distance from the yield surface that a return map leaves.
constexpr double return_tolerance = 1e-12;

/// Roots of `batch_size` increasing functions of x, each negative at x = 0 and positive at upper[i]; a lane whose upper
/// end is zero has nothing to solve. `evaluate(x, value, slope)` fills in all lanes, as plain loops that run in SIMD.
///
/// Newton from x = 0 inside a shrinking bracket. All our functions are concave unless the hardening is progressive, and
/// then Newton climbs to the root without ever passing it. A step that leaves the bracket is replaced by the geometric
/// mean of the ends: roots lie anywhere between 1e-100 and 1 of the upper end when the hardening starts vertically
/// (eps^n, n < 1), where Newton from zero does not move at all. False when a lane does not converge, which takes NaN.
template <class Evaluate>
bool find_roots(const Evaluate& evaluate, const Batch& upper, Batch& x) {
  constexpr int most_iterations = 100, unhindered = 30;
  Batch low{}, high{}, value{}, slope{};
  // A root at the very end must stay inside when it is rounded.
  for (std::size_t i = 0; i < batch_size; ++i) high[i] = upper[i] * (1.0 + 1e-9);
  x = {};
  double towards_zero = 1e-2;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    evaluate(x, value, slope);
    const bool newton_allowed = iteration < unhindered || iteration % 2 == 0;
    double open = 0.0, outside = 0.0;
    Batch next{};
    for (std::size_t i = 0; i < batch_size; ++i) {
      const bool done = (std::abs(value[i]) <= return_tolerance) | (upper[i] == 0.0);
      low[i] = value[i] < 0.0 ? x[i] : low[i];
      high[i] = value[i] < 0.0 ? high[i] : x[i];
      const double newton = x[i] - value[i] / slope[i];
      const bool inside = (newton > low[i]) & (newton < high[i]) & newton_allowed;
      next[i] = done ? x[i] : newton;
      open = done ? open : 1.0;
      outside = done | inside ? outside : 1.0;
    }
    if (outside > 0.0)
      for (std::size_t i = 0; i < batch_size; ++i) {
        const bool done = (std::abs(value[i]) <= return_tolerance) | (upper[i] == 0.0);
        const bool inside = (next[i] > low[i]) & (next[i] < high[i]) & newton_allowed;
        const double between = low[i] > 0.0 ? std::sqrt(low[i]) * std::sqrt(high[i]) : towards_zero * high[i];
        next[i] = done | inside ? next[i] : between;
      }
    x = next;
    if (open == 0.0) return true;
    towards_zero *= towards_zero;
  }
  return false;
}

}  // namespace kerf::laws
