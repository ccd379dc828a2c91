#include "inverse/ecnoise.hpp"

#include <algorithm>
#include <cmath>

namespace kerf::inverse {

DifferenceTable ecnoise(std::vector<double> values) {
  using Outcome = DifferenceTable::Outcome;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*high - *low > 0.1 * std::max(std::abs(*high), std::abs(*low))) return {.outcome = Outcome::too_far};

  struct Level {
    double noise;
    bool both_signs;
  };
  std::vector<Level> levels;
  double share = 1;  // (k!)^2 / (2k)!
  for (int k = 1; values.size() > 1; ++k) {
    for (std::size_t i = 0; i + 1 < values.size(); ++i) values[i] = values[i + 1] - values[i];
    values.pop_back();
    if (k == 1 && 2 * std::count(values.begin(), values.end(), 0.0) >= static_cast<std::ptrdiff_t>(values.size()))
      return {.outcome = Outcome::too_close};
    share *= 0.5 * k / (2 * k - 1);
    double squares = 0;
    for (const double difference : values) squares += difference * difference;
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    levels.push_back({.noise = std::sqrt(share * squares / static_cast<double>(values.size())),
                      .both_signs = *least * *largest < 0});
  }
  for (std::size_t k = 0; k + 2 < levels.size(); ++k) {
    const double least = std::min({levels[k].noise, levels[k + 1].noise, levels[k + 2].noise});
    const double largest = std::max({levels[k].noise, levels[k + 1].noise, levels[k + 2].noise});
    if (largest <= 4 * least && levels[k].both_signs)
      return {.outcome = Outcome::found, .noise = levels[k].noise, .order = static_cast<int>(k) + 1};
  }
  return {.outcome = Outcome::too_far};
}

}  // namespace kerf::inverse
