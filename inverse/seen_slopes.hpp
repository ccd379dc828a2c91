#pragma once

#include "inverse/local_model.hpp"

namespace kerf::inverse {

/// The slopes without the information that their own errors feign. A weighted slope known to +-t adds t^2 to the mean
/// of J^T J, so that differences of rough simulations make every parameter look seen. With D the sum of their
/// weighted covariances and J^T J u = lambda D u, F_b projected out and priors not counted, the slopes along u keep the
/// share sqrt(1 - 1/lambda), so that J^T J becomes J^T J - D; none where lambda stays below the 99.9 % quantile of
/// chi^2_n / n, which the errors of n slopes reach alone. (The correction of a regression for errors in its variables:
/// Fuller, Measurement Error Models, 1987, sec. 2.2.)
LocalModel seen_slopes(const LocalModel& model, const Misfit& misfit);

}  // namespace kerf::inverse
