#pragma once

#include <vector>

namespace kerf::inverse {

/// What a difference table says about the roughness of a computed function.
struct DifferenceTable {
  enum class Outcome {
    found,
    too_close,  ///< half of the values are equal: the spacing is below what the function resolves
    too_far,    ///< differences do not settle: the spacing sees the function, not its noise
  };
  Outcome outcome = Outcome::too_far;
  double noise = 0;  ///< standard deviation of one value, in its unit; 0 unless found
  int order = 0;     ///< of the differences that gave it
};

/// Noise of values at equally spaced points of a line (ECNoise; More & Wild, SIAM J. Sci. Comput. 33 (2011) 1292). The
/// k-th differences of a smooth function vanish, those of noise keep its variance times (2k)!/(k!)^2: the first k from
/// which three estimates agree within a factor of four, with differences of both signs, gives the noise. Wants at least
/// six values.
DifferenceTable ecnoise(std::vector<double> values);

}  // namespace kerf::inverse
