#pragma once

#include <Eigen/Core>
#include <string>

#include "inverse/job.hpp"
#include "inverse/parameter_space.hpp"

namespace kerf::inverse {

/// Where a search begins.
struct Start {
  Eigen::VectorXd point;
  std::string origin;  ///< for the report, in words
};

/// Values given by the job; for the others a closed form fitted to the same cuts (Williams' minimised shear plane with
/// a linear edge term); for those it does not know, the middle of their range.
Start find_start(const Job& job, const ParameterSpace& space);

}  // namespace kerf::inverse
