#pragma once

#include <Eigen/Core>
#include <array>

#include "inverse/local_model.hpp"

namespace kerf::inverse {

/// What turns a coarse observable of a cut into the fine one near a point x_0 that both have seen,
///     ln(fine/coarse) = r + R (x - x_0)       (F_t, which may vanish: fine - coarse),                      (1)
/// the log-linear manifold mapping of Echeverria & Hemker (2005). r is exact at x_0; every further pair changes R as
/// little as it can (Broyden).
class FidelityCorrection {
 public:
  /// `coarse` is uncorrected and simulated at the same point.
  FidelityCorrection(const Evaluation& fine, const Evaluation& coarse);

  /// Corrects a coarse answer. One on another branch than the fine run at x_0 is refused: between branches a ratio
  /// means nothing.
  void apply(const Eigen::VectorXd& point, std::size_t cut, RunRecord& coarse) const;

  /// Takes another pair into account; with `move`, it becomes the new x_0.
  void learn(const Evaluation& fine, const Evaluation& coarse, bool move);

 private:
  static double difference(Eigen::Index observable, double fine, double coarse);

  Eigen::VectorXd point_;
  CutMask known_;
  std::vector<forward::Branch> branches_;
  Observations offset_;                                   ///< r
  std::array<Eigen::MatrixXd, observable_count> slopes_;  ///< R, cuts x parameters
};

}  // namespace kerf::inverse
