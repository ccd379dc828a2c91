#pragma once

#include <Eigen/Core>
#include <vector>

#include "inverse/job.hpp"

namespace kerf::inverse {

/// Between search coordinates, where every parameter is of order one and a step means the same everywhere
/// (ln(value), or value / (upper - lower) for linear ones), and patched scenes.
class ParameterSpace {
 public:
  explicit ParameterSpace(const Job& job);

  Eigen::Index dimension() const { return static_cast<Eigen::Index>(free_.size()); }
  const std::vector<FreeParameter>& parameters() const { return free_; }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }

  /// Consistent units <-> coordinate of parameter `j`.
  double coordinate(Eigen::Index j, double value) const;
  double value(Eigen::Index j, double coordinate) const;
  /// d value / d coordinate.
  double slope(Eigen::Index j, double coordinate) const;
  Eigen::VectorXd values(const Eigen::VectorXd& point) const;

  /// `point` moved into the bounds.
  Eigen::VectorXd clamp(const Eigen::VectorXd& point) const;

  /// The base scene with the changes of its curve, the depth and rake of `cut`, the parameters at `point` and the ties,
  /// in this order. Of a specimen: its own scene, with those parameters and ties whose tables it has.
  Document scene(const Eigen::VectorXd& point, const MeasuredCut& cut) const;

  /// The coefficient of friction at `point`, and the free parameter that it is (-1: fixed by the scene).
  double friction(const Eigen::VectorXd& point) const;
  Eigen::Index friction_index() const { return friction_index_; }

 private:
  Document base_;
  std::vector<MeasuredCurve> curves_;
  std::vector<FreeParameter> free_;
  std::vector<Tie> ties_;
  Eigen::VectorXd lower_, upper_;
  Eigen::Index friction_index_ = -1;
  double fixed_friction_ = 0;
};

}  // namespace kerf::inverse
