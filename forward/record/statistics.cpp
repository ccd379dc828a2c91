#include "forward/record/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::forward {

Estimate batch_mean(std::span<const double> series) {
  const std::size_t n = series.size();
  if (n == 0) return {std::nan(""), std::numeric_limits<double>::infinity()};
  double mean = 0.0;
  for (const double value : series) mean += value / static_cast<double>(n);
  if (n < 4) return {mean, std::numeric_limits<double>::infinity()};
  const std::size_t batches =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(n))), 4, 20);
  const std::size_t length = n / batches, skipped = n - batches * length;
  double squares = 0.0;
  for (std::size_t b = 0; b < batches; ++b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < length; ++i) sum += series[skipped + b * length + i];
    const double deviation = sum / static_cast<double>(length) - mean;
    squares += deviation * deviation;
  }
  const double count = static_cast<double>(batches);
  return {mean, std::sqrt(squares / (count * (count - 1.0)))};
}

std::size_t truncation_point(std::span<const double> series, std::size_t first) {
  const std::size_t n = series.size();
  if (first + 4 > n) return n;
  const std::size_t last = first + (n - first) / 2;
  double sum = 0.0, squares = 0.0, best = std::numeric_limits<double>::infinity();
  std::size_t at = first;
  const double offset = series[n - 1];  // keeps the difference of squares accurate
  for (std::size_t k = n; k-- > first;) {
    const double value = series[k] - offset;
    sum += value;
    squares += value * value;
    if (k > last) continue;
    const double count = static_cast<double>(n - k);
    const double marginal = (squares - sum * sum / count) / (count * count);
    if (marginal <= best) {
      best = marginal;
      at = k;
    }
  }
  return at;
}

}  // namespace kerf::forward
