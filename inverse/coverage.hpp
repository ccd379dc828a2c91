#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {

/// How often the 95 % intervals of one parameter held the truth.
struct CoverageRow {
  std::string name, unit;
  double truth = 0;  ///< consistent units
  int trials = 0, held = 0;
  Interval share;  ///< 95 % of the share that infinitely many trials would show (Clopper and Pearson)
};

/// A job whose measurements are what `model` says at its base plus a draw of the job's own errors: of every point, and
/// of every specimen as a whole.
Job synthetic_experiment(const Job& job, const LocalModel& model, double edge_force, std::uint64_t seed);

/// Seeded synthetic experiments about the base of `model`, each fitted over that model; the edge force is part of the
/// truth. Deterministic for one seed on one standard library.
std::vector<CoverageRow> coverage(const Job& job, const LocalModel& model, double edge_force, int trials,
                                  std::uint64_t seed);

Interval binomial_interval(int held, int trials);

}  // namespace kerf::inverse
