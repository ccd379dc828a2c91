#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/ecnoise.hpp"
#include "inverse/objective.hpp"

namespace kerf::inverse {

/// How rough one simulated observable of one cut is. Shares of F_c, F_t (where it is small: of F_c/10) or chip ratio.
struct ObservableNoise {
  std::size_t cut = 0;
  Observable observable = Observable::F_c;
  std::optional<DifferenceTable> table;  ///< along a line of parameters; none when a run of it failed or changed branch
  std::optional<double> jitter;          ///< standard deviation over replicates begun a fraction of a cell apart
  std::optional<double> curvature;       ///< |f''| along the line, per square of a search coordinate
  double noise = 0;                      ///< the larger of the two estimates; 0 when both are missing
  std::optional<double> step;            ///< 1.68 sqrt(noise/|f''|)
};

/// What the simulation resolves, measured before a search trusts its differences.
struct NoiseAudit {
  std::vector<ObservableNoise> observables;
  double noise = 0;                 ///< of a force: smaller gains are not believed
  std::optional<double> roughness;  ///< of a force between neighbouring points, by the tables alone
  bool measured = false;            ///< false: no replicate could be compared, and the job's values stand
  double step = 0;                  ///< difference step in search coordinates
  std::size_t runs = 0;
  std::string note;  ///< in words
};

/// Audits the middle cut of every dozen by depth, as one batch: values at equal spacing along a line of the parameter
/// space (ecnoise), two cuts whose crack starts a third and two thirds of a cell of a four-cell chip farther on, so
/// that particles, grid and averaging window meet differently, and one wide second difference. From them the step h
/// = 1.68 sqrt(noise/|f''|) of a one-sided difference (More & Wild, ACM Trans. Math. Softw. 38 (2012) 19), kept within
/// 0.02 and 0.15, since below the slopes' own drift hides and above curvature takes over; and the noise that a gain
/// has to exceed. Throws BudgetSpent.
NoiseAudit audit_noise(Objective& objective, const Evaluation& base);

}  // namespace kerf::inverse
