#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "inverse/job.hpp"
#include "inverse/parameter_space.hpp"
#include "inverse/run_record.hpp"

namespace kerf::inverse {

/// Observables of every cut: one row per cut, one column per Observable. Rows of unusable cuts hold anything.
using Observations = Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(observable_count)>;

/// What makes a measured value and a simulated one differ, as chi^2 weighs it. What a specimen shares is one error of
/// all its cuts; every other value has its own.
enum class ErrorSource : std::size_t { measurement, specimen, simulation, discrepancy, prior };
inline constexpr std::size_t error_source_count = 5;
inline constexpr std::array<const char*, error_source_count> error_source_names{"measurement", "specimen", "simulation",
                                                                                "discrepancy", "prior"};

/// Which cuts take part in a comparison.
using CutMask = std::vector<bool>;
CutMask both(const CutMask& a, const CutMask& b);
std::size_t count(const CutMask& mask);

/// All cuts simulated at one point of the parameter space.
struct Evaluation {
  Eigen::VectorXd point;
  std::vector<RunRecord> runs;  ///< one per cut
  CutMask usable;               ///< see Misfit::is_usable
  Observations simulated;
};

/// Standard errors of the observables that a run itself states.
std::array<double, observable_count> simulation_errors(const RunRecord& run);

/// What a relative roughness of an observable is a share of: its value, or F_c/10 where F_t is smaller.
double typical_size(const Observations& simulated, Eigen::Index cut, Eigen::Index observable);

/// What is left between measurement and simulation once the edge force is chosen best.
struct Residuals {
  Eigen::VectorXd weighted;  ///< cut by cut, observable by observable, 0 where nothing is compared; then the priors.
                             ///< Uncorrelated: their squares add up to chi2
  Eigen::VectorXd standardised;  ///< over their own standard deviations, correlated within a specimen; without priors
  double chi2 = 0;
  double edge_force = 0;  ///< N/mm
  int compared = 0;       ///< number of residuals, priors included
};

/// Weighted least squares between the measured cuts and simulated ones,
///     r_ik = [y_ik(theta) + c_k(theta) F_b - m_ik] / s_ik,   c = (0 or mu, 1, 0, 0) for (F_c, F_t, chip ratio,
///     curvature), s^2 = measured^2 + simulated^2 + (discrepancy m)^2  (standard errors),
/// whitened for the error that all measurements of one specimen share (its forces in common, its chip ratios, its
/// curvatures), with one residual (theta_j - prior_j) / error_j for every prior,
/// where F_b within its bounds minimises chi^2 = sum r^2 at every theta (variable projection: it costs no runs).
class Misfit {
 public:
  /// Throws InputError when a measured value has no error to weigh it by.
  Misfit(const Job& job, const ParameterSpace& space);

  /// What a run shows of a cut: one number per Observable; of a specimen the resistance at the point's extension.
  Eigen::RowVectorXd observations(std::size_t cut, const RunRecord& run) const;

  /// A run that can be compared: accepted, with finite observables where some were measured, chip ratio and
  /// F_c positive.
  bool is_usable(std::size_t cut, const RunRecord& run) const;

  /// Adds the simulation's own standard errors to the weights, as they are at `reference`, and keeps them from then on
  /// so that one and the same sum of squares is minimised.
  void include_simulation_errors(const Evaluation& reference);

  /// The same misfit under the other assumption on the edge force.
  Misfit with_share(CuttingShare share) const;

  Residuals residuals(const Observations& simulated, const Eigen::VectorXd& point, const CutMask& mask) const;
  Residuals residuals(const Evaluation& evaluation) const;
  double chi2(const Evaluation& evaluation, const CutMask& mask) const;
  /// Standard deviation of a difference of two chi^2 when every simulated number is rough by the share `noise`, and
  /// unless that was `measured` by its own standard error: a scatter within a window that two runs may well share.
  double chi2_noise(const Evaluation& evaluation, double noise, bool measured) const;

  /// The residuals with F_b given instead of chosen.
  Eigen::VectorXd residuals_with(double edge_force, const Observations& simulated, const Eigen::VectorXd& point,
                                 const CutMask& mask) const;
  /// Length of all residual vectors: cuts x observables, then priors.
  Eigen::Index residual_count() const;

  /// Turns residuals over their independent errors into uncorrelated ones: with C = D + u u^T and v = D^-1/2 u the
  /// symmetric root of C^-1 is [1 - (1 - 1/sqrt(1 + v^2)) v v^T / v^2] D^-1/2. T is double or an automatic derivative.
  template <class T>
  void whiten(const CutMask& mask, T* residuals) const {
    for (const Common& common : commons_) {
      T along(0.0);
      double v2 = 0;
      const auto each = [&](auto&& use) {
        for (const auto& [row, column] : common.values)
          if (mask[static_cast<std::size_t>(row)])
            use(row * weights_.cols() + column, error(ErrorSource::specimen)(row, column) * weights_(row, column));
      };
      each([&](Eigen::Index i, double v) {
        along += v * residuals[i];
        v2 += v * v;
      });
      if (v2 == 0) continue;
      along *= (1 - 1 / std::sqrt(1 + v2)) / v2;
      each([&](Eigen::Index i, double v) { residuals[i] -= v * along; });
    }
  }

  /// The residual of each prior from the values of the free parameters, in consistent units.
  template <class T>
  void add_priors(const std::vector<T>& values, T* residuals) const {
    const std::vector<FreeParameter>& free = space_->parameters();
    for (std::size_t j = 0; j < free.size(); ++j)
      if (free[j].prior) *residuals++ = (values[j] - free[j].prior->value) / free[j].prior->standard_error;
  }

  /// What is compared with the measurement: the simulation and what the edge force adds to it.
  Observations fitted(const Observations& simulated, const Eigen::VectorXd& point, double edge_force) const;

  /// The errors of one source as whitened residuals: a column for every independent error of one standard deviation.
  /// With L_s these columns, sum_s L_s L_s^T is 1 on all that is compared.
  Eigen::MatrixXd whitened_errors(ErrorSource source, const CutMask& mask) const;
  /// Standard deviations of measured - simulated from all sources; 0 where nothing was measured.
  Observations residual_errors() const;

  /// 1/s, without what a specimen shares; 0 where nothing was measured.
  const Observations& weights() const { return weights_; }
  const Observations& measured() const { return measured_; }
  const std::optional<EdgeForce>& edge_force() const { return edge_force_; }
  /// c of Eq. above, for a coefficient of friction.
  double edge_share(Observable observable, double friction) const;

 private:
  void append_priors(const Eigen::VectorXd& point, Eigen::VectorXd& residuals) const;
  Observations& error(ErrorSource source) { return errors_[static_cast<std::size_t>(source)]; }
  const Observations& error(ErrorSource source) const { return errors_[static_cast<std::size_t>(source)]; }
  void weigh(Eigen::Index cut, Eigen::Index observable);

  const ParameterSpace* space_;
  std::optional<EdgeForce> edge_force_;
  Observations measured_, weights_;
  std::vector<std::optional<double>> extensions_;        ///< of the cuts that are points of an R-curve
  std::array<Observations, error_source_count> errors_;  ///< standard deviations by source; those of priors stay 0
  /// What shares one error: places (cut, observable).
  struct Common {
    std::vector<std::pair<Eigen::Index, Eigen::Index>> values;
  };
  std::vector<Common> commons_;
};

}  // namespace kerf::inverse
