#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "inverse/job.hpp"

namespace kerf::inverse {

/// Versions of kerf, compiler and libraries, and the machine: the beginning of every manifest.
nlohmann::ordered_json code_and_machine(const std::string& code);

/// Processor time of this process so far, s.
double processor_seconds();

/// DIR/manifest.json: what a reader needs to repeat a calibration: versions of kerf, compiler and libraries, machine,
/// SHA-256 of every input, the job and scene as they were understood, wall and processor time.
nlohmann::ordered_json manifest(const Job& job, const std::string& code, double wall_seconds);

}  // namespace kerf::inverse
