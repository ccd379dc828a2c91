#pragma once

#include <Eigen/Core>
#include <vector>

#include "inverse/job.hpp"
#include "inverse/parameter_space.hpp"
#include "inverse/run_record.hpp"

namespace kerf::inverse {

/// Observables of every cut: one row per cut, one column per Observable. Rows of unusable cuts hold anything.
using Observations = Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(observable_count)>;

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

Eigen::RowVectorXd observations(const RunRecord& run);

/// What is left between measurement and simulation once the edge force is chosen best.
struct Residuals {
  Eigen::VectorXd weighted;  ///< cut by cut, observable by observable; 0 where nothing is compared
  double chi2 = 0;
  double edge_force = 0;  ///< N/mm
  int compared = 0;       ///< number of residuals
};

/// Weighted least squares between the measured cuts and simulated ones,
///     r_ik = [y_ik(theta) + c_k(theta) F_b - m_ik] / s_ik,   c = (0 or mu, 1, 0) for (F_c, F_t, chip ratio),
///     s^2 = measured^2 + simulated^2 + (discrepancy m)^2  (standard errors),
/// where F_b within its bounds minimises chi^2 = sum r^2 at every theta (variable projection: it costs no runs).
class Misfit {
 public:
  /// Throws InputError when a measured value has no error to weigh it by.
  Misfit(const Job& job, const ParameterSpace& space);

  /// A run that can be compared: accepted, with finite observables where some were measured, F_c and chip ratio
  /// positive.
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

  /// 1/s, and 0 where nothing was measured.
  const Observations& weights() const { return weights_; }
  const Observations& measured() const { return measured_; }
  const std::optional<EdgeForce>& edge_force() const { return edge_force_; }
  /// c of Eq. above, for a coefficient of friction.
  double edge_share(Observable observable, double friction) const;

 private:
  const ParameterSpace* space_;
  std::optional<EdgeForce> edge_force_;
  Observations measured_, weights_, errors_;
};

}  // namespace kerf::inverse
