#pragma once

#include "models/laws/lanes.hpp"

namespace kerf::laws {

/// Largest relative distance from the yield surface that a return map leaves.
constexpr double return_tolerance = 1e-12;

/// Roots of eight increasing functions of x, each negative at x = 0 and positive at its `upper`; a lane whose upper end
/// is zero has nothing to solve. `evaluate(x, value, slope)` fills in all lanes.
///
/// Newton from x = 0 inside a shrinking bracket. All our functions are concave unless the hardening is progressive, and
/// then Newton climbs to the root without ever passing it. A step that leaves the bracket is replaced by the geometric
/// mean of the ends: roots lie anywhere between 1e-100 and 1 of the upper end when the hardening starts vertically
/// (eps^n, n < 1), where Newton from zero does not move at all. False when a lane does not converge, which takes NaN.
template <class Evaluate>
bool find_roots(const Evaluate& evaluate, Lanes upper, Lanes& x) {
  constexpr int most_iterations = 100, unhindered = 30;
  // A root at the very end must stay inside when it is rounded.
  Lanes low{}, high = upper * (1.0 + 1e-9), value{}, slope{}, before{};
  x = Lanes{};
  double towards_zero = 1e-2;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    evaluate(x, value, slope);
    const LaneMask open = !((abs(value) <= return_tolerance) | (upper == 0.0));
    if (!any(open)) return true;
    low = value < 0.0 ? x : low;
    high = value < 0.0 ? high : x;
    Lanes next = x - value / slope;
    LaneMask leaves = !((next > low) & (next < high));
    if (iteration >= unhindered && iteration % 2 != 0) leaves = open;
    if (any(leaves & open)) {
      const Lanes between = low > 0.0 ? sqrt(low) * sqrt(high) : towards_zero * high;
      next = leaves ? between : next;
    }
    x = open ? next : x;
    // Newton squares the error: a step whose error will have shrunk far below the tolerance needs no other look.
    const Lanes after = value * value * value;
    const LaneMask settled = ~open | (~leaves & (abs(after) <= 0.01 * return_tolerance * before * before));
    if (!any(~settled)) return true;
    before = leaves ? Lanes{} : value;
    towards_zero *= towards_zero;
  }
  return false;
}

}  // namespace kerf::laws
