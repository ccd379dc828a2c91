#pragma once

#include <vector>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {

/// A cut that could be measured next, and what one more measurement would do.
struct NextCut {
  double depth = 0, rake = 0;  ///< mm, rad
  Observable observable = Observable::F_c;
  double expected = 0;              ///< N/mm, 1, 1/mm: what would be measured, without the edge force
  double measurement_error = 0;     ///< assumed: the median relative error of such measurements in the job
  double standard_error_ratio = 1;  ///< of the chosen parameter, after over before
};

/// Depths from half the shallowest to twice the deepest of the job (seven, evenly by factors) at its rakes and 10 deg
/// to either side.
std::vector<MeasuredCut> candidate_cuts(const Job& job);

/// The job with other cuts, all observables of which count.
Job with_cuts(const Job& job, std::vector<MeasuredCut> cuts);

/// Every candidate and observable, the best first. `model` is that of the measured cuts, `candidates` one of cuts of
/// `candidate_job` about the same point; the standard errors follow from both Jacobians, with the bounds of the search
/// (as uniform knowledge) in the place of what the data do not see. Throws InputError when `name` is no parameter.
std::vector<NextCut> next_cuts(const Job& job, const LocalModel& model, const Misfit& misfit, const Job& candidate_job,
                               const LocalModel& candidates, const std::string& name);

}  // namespace kerf::inverse
