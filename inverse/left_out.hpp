#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {

/// The estimate without some of the data, from the local model: it costs no runs.
struct LeftOut {
  std::string what;            ///< "depth 0.04 mm, rake 15 deg", or a specimen
  std::vector<double> values;  ///< of the free parameters, F_b, then the derived quantities; consistent units
};

/// Spread of the estimates when whole specimens are drawn with replacement.
struct Bootstrap {
  int specimens = 0, draws = 0;
  std::vector<double> standard_deviations;  ///< in the order of LeftOut::values
};

struct Resampling {
  std::vector<LeftOut> without_cut, without_specimen;
  std::optional<Bootstrap> bootstrap;  ///< from four specimens on; fewer say nothing about their scatter
};

/// Refits the local model without each cut, without each specimen, and to `draws` seeded draws of specimens.
Resampling resample(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space, const Job& job,
                    int draws = 200);

}  // namespace kerf::inverse
