#pragma once

#include <vector>

#include "inverse/job.hpp"

namespace kerf::inverse {

/// The job's [[free]] tables: paths of numbers that the scene holds, with their bounds. Throws InputError with the
/// key's place.
std::vector<FreeParameter> read_free_parameters(const Contents& contents, const Document& scene);

/// The job's [[tie]] tables: what follows a free parameter or another number of the scene. Throws InputError with the
/// key's place.
std::vector<Tie> read_ties(const Contents& contents, const Document& scene, const std::vector<FreeParameter>& free);

}  // namespace kerf::inverse
