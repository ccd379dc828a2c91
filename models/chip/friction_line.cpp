#include "models/chip/friction_line.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "models/chip/rake_face.hpp"

namespace kerf::chip {

namespace {

/// Outliers by the largest externally studentized residual (Bonferroni over the points).
std::vector<FrictionLine::Outlier> find_outliers(const std::vector<MeasuredCut>& cuts, const Eigen::VectorXd& residual,
                                                 const Eigen::VectorXd& leverage) {
  const auto n = residual.size();
  const double freedom = static_cast<double>(n) - 3.0;
  if (freedom < 1.0) return {};
  const double limit = boost::math::quantile(boost::math::students_t(freedom), 1.0 - 0.025 / static_cast<double>(n));
  const double sum = residual.squaredNorm();
  std::vector<FrictionLine::Outlier> outliers;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double free = 1.0 - leverage[i];
    if (free < 1e-9) continue;
    const double others = (sum - residual[i] * residual[i] / free) / freedom;
    if (others <= 1e-24 * sum) continue;
    const double studentized = residual[i] / std::sqrt(others * free);
    if (std::abs(studentized) <= limit) continue;
    const auto& cut = cuts[static_cast<std::size_t>(i)];
    outliers.push_back({cut.line, cut.depth, studentized});
  }
  return outliers;
}

std::optional<FrictionLine> fit_line(const Measurements& all, double rake) {
  std::vector<MeasuredCut> cuts;
  for (const auto& cut : all.cuts()) {
    if (cut.rake == rake) cuts.push_back(cut);
  }
  const auto n = static_cast<Eigen::Index>(cuts.size());
  if (n < 3) return {};

  FrictionLine line;
  line.rake = rake;
  line.points = static_cast<int>(n);
  Eigen::MatrixX2d design(n, 2);
  Eigen::VectorXd measured(n);
  Eigen::Vector2d solution = Eigen::Vector2d::Zero();
  Eigen::Matrix2d inverse;
  constexpr int passes = 50;  // the weights hold the slope
  for (int pass = 0; pass < passes; ++pass) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& cut = cuts[static_cast<std::size_t>(i)];
      const double error = std::hypot(all.F_t_error(cut), solution[0] * all.F_c_error(cut));
      design.row(i) << cut.F_c / error, 1.0 / error;
      measured[i] = *cut.F_t / error;
    }
    const Eigen::Matrix2d information = design.transpose() * design;
    if (information.determinant() <= 1e-12 * information(0, 0) * information(1, 1)) return {};
    inverse = information.inverse();
    const Eigen::Vector2d next = inverse * design.transpose() * measured;
    const bool settled = (next - solution).norm() <= 1e-13 * next.norm();
    solution = next;
    line.information_root = information.llt().matrixU();
    if (settled) break;
  }

  const Eigen::VectorXd residual = measured - design * solution;
  const double freedom = static_cast<double>(n) - 2.0;
  const double chi2 = residual.squaredNorm();
  if (all.errors_known()) line.chi2 = chi2;
  // The scatter about the line counts when it exceeds the measured errors: a bend in the line is no noise to ignore.
  const double scale = all.errors_known() ? std::max(1.0, chi2 / freedom) : chi2 / freedom;
  line.slope = {solution[0], std::sqrt(inverse(0, 0) * scale)};
  line.intercept = {solution[1], std::sqrt(inverse(1, 1) * scale)};
  const double tan_rake = std::tan(rake);
  const double derivative = (1.0 + tan_rake * tan_rake) / std::pow(1.0 - solution[0] * tan_rake, 2);
  line.friction = {friction_from_slope(solution[0], rake), line.slope.standard_error * derivative};

  double squares = 0.0;
  for (const auto& cut : cuts) squares += std::pow(*cut.F_t - solution[0] * cut.F_c - solution[1], 2);
  line.scatter = std::sqrt(squares / freedom);
  const Eigen::VectorXd leverage = (design * inverse).cwiseProduct(design).rowwise().sum();
  line.outliers = find_outliers(cuts, residual, leverage);
  return line;
}

}  // namespace

std::vector<FrictionLine> friction_lines(const Measurements& measurements) {
  std::vector<FrictionLine> lines;
  if (!measurements.has_F_t()) return lines;
  for (const double rake : measurements.rakes()) {
    if (const auto line = fit_line(measurements, rake)) lines.push_back(*line);
  }
  return lines;
}

}  // namespace kerf::chip
