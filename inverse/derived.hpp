#pragma once

#include "inverse/job.hpp"

namespace kerf::inverse {

/// Reads a [[derived]] of a job whose scene, free parameters and ties are known. Every path becomes a constant of the
/// scene or a free parameter times the factors of its ties. Throws InputError when a name is unknown, the expression is
/// no sum of products of powers, or its dimension is not that of the unit.
DerivedQuantity read_derived(const Values& values, const Job& job);

}  // namespace kerf::inverse
