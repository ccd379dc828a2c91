#include "forward/record/statistics.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

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

namespace {

/// Level, a and b of a swing in a series, and what they leave.
struct SwingFit {
  Eigen::Vector3d coefficients;
  double squares;
};

/// Calls visit(i, phasor) for every entry: the swing's cosine and sine are the phasor's parts.
template <class Visit>
void each_entry(std::size_t n, const Swing& swing, Visit&& visit) {
  const std::complex<double> turn = std::polar(std::exp(-swing.decay), swing.wave);
  std::complex<double> phasor = 1.0;
  for (std::size_t i = 0; i < n; ++i, phasor *= turn) visit(i, phasor);
}

SwingFit fit_swing(std::span<const double> series, const Swing& swing) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();
  const double offset = series.back();  // keeps the difference of squares accurate
  double squares = 0.0;
  each_entry(series.size(), swing, [&](std::size_t i, std::complex<double> phasor) {
    const Eigen::Vector3d row(1.0, phasor.real(), phasor.imag());
    normal += row * row.transpose();
    moments += row * (series[i] - offset);
    squares += (series[i] - offset) * (series[i] - offset);
  });
  Eigen::Vector3d coefficients = normal.ldlt().solve(moments);
  squares -= coefficients.dot(moments);
  coefficients[0] += offset;
  return {coefficients, squares};
}

}  // namespace

std::vector<double> calmed(std::span<const double> series, const Swing& swing) {
  const SwingFit fit = fit_swing(series, swing);
  std::vector<double> calm(series.begin(), series.end());
  each_entry(series.size(), swing, [&](std::size_t i, std::complex<double> phasor) {
    calm[i] -= fit.coefficients[1] * phasor.real() + fit.coefficients[2] * phasor.imag();
  });
  return calm;
}

Estimate level(std::span<const double> series, const std::optional<Swing>& swing) {
  if (!swing) return batch_mean(series);
  const SwingFit fit = fit_swing(series, *swing);
  // Variance of the level among all five that were fitted, over that of a plain mean.
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  each_entry(series.size(), *swing, [&](std::size_t i, std::complex<double> phasor) {
    const double cos = phasor.real(), sin = phasor.imag(),
                 at = static_cast<double>(i) / static_cast<double>(series.size());
    Eigen::Vector<double, 5> row;
    row << 1.0, cos, sin, at * (fit.coefficients[2] * cos - fit.coefficients[1] * sin),
        at * (fit.coefficients[1] * cos + fit.coefficients[2] * sin);
    normal += row * row.transpose();
  });
  const double variance =
      normal.ldlt().solve(Eigen::Vector<double, 5>::Unit(0))[0] * static_cast<double>(series.size());
  return {fit.coefficients[0], batch_mean(calmed(series, *swing)).standard_error * std::sqrt(std::max(1.0, variance))};
}

std::optional<Swing> find_swing(std::span<const double> series) {
  constexpr double turn = 2.0 * std::numbers::pi, fastest = 6.0, slowest = 1.25, steepest = 1.5;
  constexpr int periods = 20, decays = 6, refinements = 8;
  const auto n = static_cast<double>(series.size());
  if (series.size() < 24) return std::nullopt;
  // In periods per series and in decay per period.
  const auto swing_of = [&](double count, double damping) { return Swing{turn * count / n, damping * count / n}; };
  double count = slowest, damping = 0.0, least = std::numeric_limits<double>::infinity();
  const auto attempt = [&](double at_count, double at_damping) {
    if (at_count < slowest || at_count > fastest || at_damping < 0.0 || at_damping > steepest) return;
    const double squares = fit_swing(series, swing_of(at_count, at_damping)).squares;
    if (squares < least) {
      least = squares;
      count = at_count;
      damping = at_damping;
    }
  };
  double step = (fastest - slowest) / periods, damping_step = steepest / decays;
  for (int i = 0; i <= periods; ++i)
    for (int j = 0; j <= decays; ++j) attempt(slowest + i * step, j * damping_step);
  for (int k = 0; k < refinements; ++k) {
    step *= 0.5;
    damping_step *= 0.5;
    const double at = count, with = damping;
    for (const double i : {-1.0, 0.0, 1.0})
      for (const double j : {-1.0, 0.0, 1.0}) attempt(at + i * step, with + j * damping_step);
  }
  const Swing swing = swing_of(count, damping);
  const Estimate plain = batch_mean(series);
  double scatter = 0.0;
  for (const double value : series) scatter += (value - plain.value) * (value - plain.value);
  const bool explains = count > slowest && least < 0.25 * scatter;
  return explains && level(series, swing).standard_error < 0.5 * plain.standard_error ? std::optional(swing)
                                                                                      : std::nullopt;
}

}  // namespace kerf::forward
