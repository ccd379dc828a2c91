#pragma once

#include <cstddef>
#include <span>

#include "models/base/estimate.hpp"

namespace kerf::forward {

/// Mean of a correlated series with its standard error by non-overlapping batch means (batches of about sqrt(n), at
/// least four batches). Needs four values; with fewer the standard error is infinite.
Estimate batch_mean(std::span<const double> series);

/// Where a series stops drifting: the start k in [first, half of the rest] that minimises the marginal standard error
/// var(series[k..]) / (n - k)^2 (White 1997).
std::size_t truncation_point(std::span<const double> series, std::size_t first);

}  // namespace kerf::forward
