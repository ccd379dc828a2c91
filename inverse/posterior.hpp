#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {

/// Draws from the posterior density of the parameters, an answer beside the profile intervals that sees every shape.
struct Posterior {
  Eigen::MatrixXd draws;            ///< one per row; parameters (F_b last), then derived quantities; consistent units
  double acceptance = 0;            ///< share of moves taken
  double autocorrelation_time = 0;  ///< moves of a walker per independent draw, of the slowest coordinate
  std::vector<Interval> intervals;  ///< 95 %, equal tails, of the columns
  Eigen::Index independent() const {
    return static_cast<Eigen::Index>(static_cast<double>(draws.rows()) / autocorrelation_time);
  }
};

/// Samples exp(-chi^2/2) over the local model, uniform within the bounds in search coordinates and in F_b; where the
/// misfit exceeds what the errors allow, errors are known up to a common factor of density 1/s and (chi^2)^(-n/2) takes
/// its place, n being the number of residuals. Walkers move by stretches along the lines between them, which makes thin
/// valleys as easy as round ones (Goodman & Weare, Comm. App. Math. Comp. Sci. 5 (2010) 65). `moves` of each walker are
/// kept after a fifth as many more at the beginning. The same seed draws the same numbers.
Posterior sample_posterior(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                           const std::vector<DerivedQuantity>& derived, const Identifiability& known, int moves,
                           std::uint64_t seed = 1);

}  // namespace kerf::inverse
