#include "inverse/misfit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "models/base/error.hpp"

namespace kerf::inverse {
namespace {

constexpr Eigen::Index F_c = static_cast<Eigen::Index>(Observable::F_c);
constexpr Eigen::Index F_t = static_cast<Eigen::Index>(Observable::F_t);
constexpr Eigen::Index chip_ratio = static_cast<Eigen::Index>(Observable::chip_ratio);
constexpr Eigen::Index chip_curvature = static_cast<Eigen::Index>(Observable::chip_curvature);
constexpr Eigen::Index G_R = static_cast<Eigen::Index>(Observable::resistance);

/// Column of a curve that holds the scatter of an observable.
constexpr std::array<const char*, observable_count> error_columns{"Fc_sd", "Ft_sd", "chip_ratio_sd", "curl_radius_sd",
                                                                  "G_sd"};

Eigen::Index rows(const std::vector<MeasuredCut>& cuts) {
  return static_cast<Eigen::Index>(cuts.size());
}

}  // namespace

CutMask both(const CutMask& a, const CutMask& b) {
  CutMask result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] && b[i];
  return result;
}

std::size_t count(const CutMask& mask) {
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), true));
}

Eigen::RowVectorXd Misfit::observations(std::size_t cut, const RunRecord& run) const {
  Eigen::RowVectorXd row(static_cast<Eigen::Index>(observable_count));
  row[F_c] = run.F_c.value;
  row[F_t] = run.F_t.value;
  row[chip_ratio] = run.chip_ratio.value;
  row[chip_curvature] = run.chip_curvature.value;
  const std::optional<double>& extension = extensions_[cut];
  row[G_R] = extension ? resistance(run, *extension) : std::numeric_limits<double>::quiet_NaN();
  return row;
}

std::array<double, observable_count> simulation_errors(const RunRecord& run) {
  return {run.F_c.standard_error, run.F_t.standard_error, run.chip_ratio.standard_error,
          run.chip_curvature.standard_error, 0.0};
}

double typical_size(const Observations& simulated, Eigen::Index cut, Eigen::Index observable) {
  const double size = std::abs(simulated(cut, observable));
  return observable == F_t ? std::max(size, 0.1 * simulated(cut, F_c)) : size;
}

Misfit::Misfit(const Job& job, const ParameterSpace& space) : space_(&space), edge_force_(job.edge_force) {
  const auto columns = static_cast<Eigen::Index>(observable_count);
  measured_ = weights_ = Observations::Zero(rows(job.cuts), columns);
  errors_.fill(measured_);
  std::map<std::pair<std::string, Eigen::Index>, Common> commons;  // by specimen and kind of measurement
  for (Eigen::Index i = 0; i < rows(job.cuts); ++i) {
    const MeasuredCut& cut = job.cuts[static_cast<std::size_t>(i)];
    extensions_.push_back(cut.extension);
    for (Eigen::Index k = 0; k < columns; ++k) {
      const std::optional<Estimate>& measured = cut.measured[static_cast<std::size_t>(k)];
      if (!measured) continue;
      measured_(i, k) = measured->value;
      error(ErrorSource::measurement)(i, k) = measured->standard_error;
      error(ErrorSource::discrepancy)(i, k) = std::abs(job.discrepancy * measured->value);
      weigh(i, k);
      if (!std::isfinite(weights_(i, k)))
        throw InputError(
            fmt::format("{}:{}: {} has no standard error to weigh it by; add a column {}, or give [discrepancy] "
                        "relative in the job",
                        job.curves[cut.curve].file.name, cut.row, observable_names[static_cast<std::size_t>(k)],
                        error_columns[static_cast<std::size_t>(k)]));
      if (cut.specimen_error == 0) continue;
      error(ErrorSource::specimen)(i, k) = cut.specimen_error * measured->value;
      commons[{cut.specimen, std::max(k, F_t)}].values.emplace_back(i, k);  // one dynamometer, one width: both forces
    }
  }
  for (auto& [specimen, common] : commons) commons_.push_back(std::move(common));
}

bool Misfit::is_usable(std::size_t cut, const RunRecord& run) const {
  if (!run.accepted) return false;
  const Eigen::RowVectorXd simulated = observations(cut, run);
  for (Eigen::Index k = 0; k < simulated.size(); ++k) {
    if (weights_(static_cast<Eigen::Index>(cut), k) == 0) continue;
    if (!std::isfinite(simulated[k]) || (is_positive(static_cast<std::size_t>(k)) && simulated[k] <= 0)) return false;
    if (k == F_t && !(simulated[F_c] > 0)) return false;
  }
  return true;
}

void Misfit::include_simulation_errors(const Evaluation& reference) {
  for (Eigen::Index i = 0; i < weights_.rows(); ++i) {
    if (!reference.usable[static_cast<std::size_t>(i)]) continue;
    const auto simulated = simulation_errors(reference.runs[static_cast<std::size_t>(i)]);
    for (Eigen::Index k = 0; k < weights_.cols(); ++k) {
      if (weights_(i, k) == 0) continue;
      if (const double own = simulated[static_cast<std::size_t>(k)]; std::isfinite(own)) {
        error(ErrorSource::simulation)(i, k) = own;
        weigh(i, k);
      }
      // An error in common that followed the scatter of the measured values would pull the fit towards the low ones
      // (Peelle's puzzle): it is a share of what is simulated.
      const double value = reference.simulated(i, k);
      if (double& common = error(ErrorSource::specimen)(i, k); common != 0 && std::isfinite(value))
        common *= value / measured_(i, k);
    }
  }
}

void Misfit::weigh(Eigen::Index i, Eigen::Index k) {
  const double known_before = std::hypot(error(ErrorSource::measurement)(i, k), error(ErrorSource::discrepancy)(i, k));
  weights_(i, k) = 1.0 / std::hypot(known_before, error(ErrorSource::simulation)(i, k));
}

Misfit Misfit::with_share(CuttingShare share) const {
  Misfit other = *this;
  if (other.edge_force_) other.edge_force_->cutting_share = share;
  return other;
}

double Misfit::edge_share(Observable observable, double friction) const {
  if (!edge_force_ || observable >= Observable::chip_ratio) return 0;  // an edge shapes no chip
  if (observable == Observable::F_t) return 1;
  return edge_force_->cutting_share == CuttingShare::friction ? friction : 0;
}

Residuals Misfit::residuals(const Observations& simulated, const Eigen::VectorXd& point, const CutMask& mask) const {
  const double friction = space_->friction(point);
  const Eigen::Index n = weights_.rows(), m = weights_.cols();
  Eigen::VectorXd sharp = Eigen::VectorXd::Zero(residual_count()), edge = sharp;
  Residuals result;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!mask[static_cast<std::size_t>(i)]) continue;
    for (Eigen::Index k = 0; k < m; ++k) {
      if (weights_(i, k) == 0) continue;
      sharp[i * m + k] = (simulated(i, k) - measured_(i, k)) * weights_(i, k);
      edge[i * m + k] = edge_share(static_cast<Observable>(k), friction) * weights_(i, k);
      ++result.compared;
    }
  }
  result.standardised = sharp.head(n * m);
  const Eigen::VectorXd raw_edge = edge.head(n * m);
  whiten(mask, sharp.data());
  whiten(mask, edge.data());
  if (edge_force_) {
    const double best = edge.squaredNorm() > 0 ? -edge.dot(sharp) / edge.squaredNorm() : 0;
    result.edge_force = std::clamp(best, edge_force_->lower, edge_force_->upper);
  }
  result.weighted = sharp + result.edge_force * edge;
  result.standardised += result.edge_force * raw_edge;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < m; ++k)
      result.standardised[i * m + k] /= std::hypot(1.0, error(ErrorSource::specimen)(i, k) * weights_(i, k));
  append_priors(point, result.weighted);
  result.compared += static_cast<int>(residual_count() - n * m);
  result.chi2 = result.weighted.squaredNorm();
  return result;
}

void Misfit::append_priors(const Eigen::VectorXd& point, Eigen::VectorXd& residuals) const {
  const Eigen::VectorXd values = space_->values(point);
  add_priors(std::vector<double>(values.begin(), values.end()), residuals.data() + weights_.size());
}

Eigen::Index Misfit::residual_count() const {
  const std::vector<FreeParameter>& free = space_->parameters();
  return weights_.size() +
         std::count_if(free.begin(), free.end(), [](const FreeParameter& p) { return p.prior.has_value(); });
}

Eigen::VectorXd Misfit::residuals_with(double edge_force, const Observations& simulated, const Eigen::VectorXd& point,
                                       const CutMask& mask) const {
  const double friction = space_->friction(point);
  Eigen::VectorXd residuals = Eigen::VectorXd::Zero(residual_count());
  for (Eigen::Index i = 0; i < weights_.rows(); ++i)
    for (Eigen::Index k = 0; k < weights_.cols() && mask[static_cast<std::size_t>(i)]; ++k)
      if (weights_(i, k) != 0)
        residuals[i * weights_.cols() + k] =
            weights_(i, k) *
            (simulated(i, k) - measured_(i, k) + edge_force * edge_share(static_cast<Observable>(k), friction));
  whiten(mask, residuals.data());
  append_priors(point, residuals);
  return residuals;
}

Observations Misfit::fitted(const Observations& simulated, const Eigen::VectorXd& point, double edge_force) const {
  const double friction = space_->friction(point);
  Observations result = simulated;
  for (Eigen::Index k = 0; k < result.cols(); ++k)
    result.col(k).array() += edge_force * edge_share(static_cast<Observable>(k), friction);
  return result;
}

Observations Misfit::residual_errors() const {
  Observations errors = Observations::Zero(weights_.rows(), weights_.cols());
  for (Eigen::Index i = 0; i < errors.rows(); ++i)
    for (Eigen::Index k = 0; k < errors.cols(); ++k)
      if (weights_(i, k) != 0) errors(i, k) = std::hypot(1.0 / weights_(i, k), error(ErrorSource::specimen)(i, k));
  return errors;
}

Eigen::MatrixXd Misfit::whitened_errors(ErrorSource source, const CutMask& mask) const {
  const Eigen::Index n = residual_count(), priors = n - weights_.size();
  if (source == ErrorSource::prior) {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, priors);
    columns.bottomRows(priors).setIdentity();
    return columns;
  }
  std::vector<Common> errors;  // the values that one of them moves
  if (source == ErrorSource::specimen)
    errors = commons_;
  else
    for (Eigen::Index i = 0; i < weights_.rows(); ++i)
      for (Eigen::Index k = 0; k < weights_.cols(); ++k) errors.push_back({{{i, k}}});
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(errors.size()));
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    for (const auto& [i, k] : errors[static_cast<std::size_t>(c)].values)
      if (mask[static_cast<std::size_t>(i)]) columns(i * weights_.cols() + k, c) = error(source)(i, k) * weights_(i, k);
    whiten(mask, columns.col(c).data());
  }
  return columns;
}

Residuals Misfit::residuals(const Evaluation& evaluation) const {
  return residuals(evaluation.simulated, evaluation.point, evaluation.usable);
}

double Misfit::chi2(const Evaluation& evaluation, const CutMask& mask) const {
  return residuals(evaluation.simulated, evaluation.point, mask).chi2;
}

double Misfit::chi2_noise(const Evaluation& evaluation, double noise, bool measured) const {
  const Residuals here = residuals(evaluation);
  Eigen::VectorXd slope = here.weighted;  // of chi^2 / 2 in each residual: the whitening is symmetric
  whiten(evaluation.usable, slope.data());
  double variance = 0;
  for (Eigen::Index i = 0; i < weights_.rows(); ++i)
    for (Eigen::Index k = 0; k < weights_.cols(); ++k) {
      if (!evaluation.usable[static_cast<std::size_t>(i)]) continue;
      const double own = simulation_errors(evaluation.runs[static_cast<std::size_t>(i)])[static_cast<std::size_t>(k)];
      const double rough = std::hypot(noise * evaluation.simulated(i, k), !measured && std::isfinite(own) ? own : 0);
      const double error = rough * weights_(i, k);
      const double r = slope[i * weights_.cols() + k];
      variance += 2 * (4 * r * r * error * error + 2 * error * error * error * error);
    }
  return std::sqrt(variance);
}

}  // namespace kerf::inverse
