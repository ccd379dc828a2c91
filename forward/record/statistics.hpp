#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "models/base/estimate.hpp"

namespace kerf::forward {

/// Mean of a correlated series with its standard error by non-overlapping batch means (batches of about sqrt(n), at
/// least four batches). Needs four values; with fewer the standard error is infinite.
Estimate batch_mean(std::span<const double> series);

/// Where a series stops drifting: the start k in [first, half of the rest] that minimises the marginal standard error
/// var(series[k..]) / (n - k)^2 (White 1997).
std::size_t truncation_point(std::span<const double> series, std::size_t first);

/// A damped oscillation about a level, exp(-decay i) (a cos(wave i) + b sin(wave i)), i counting the entries of a
/// series.
struct Swing {
  double wave, decay;
};

/// The swing that explains a series best, by least squares over level, a, b, wave and decay: at least five quarters of
/// a period in the series, damped by exp(-1.5) per period at most (what dies faster is a run-in, whose end nobody
/// knows). None unless it halves the standard error of the level.
std::optional<Swing> find_swing(std::span<const double> series);

/// Level about which the series swings; its standard error is that of the mean of `calmed`, times what fitting the
/// swing adds to it. Without a swing: `batch_mean`.
Estimate level(std::span<const double> series, const std::optional<Swing>& swing);

/// The series less its swing.
std::vector<double> calmed(std::span<const double> series, const Swing& swing);

}  // namespace kerf::forward
