#pragma once

#include <filesystem>

#include "inverse/folder.hpp"
#include "models/base/document.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// Runs a calibration at every preset, each in a folder of its own (DIR/draft, ...; see inverse::Folder), and writes
/// what accuracy changes in its answer: study.csv, study.json, the report with its figure (study.svg). The estimates at
/// the preset `reference` count as exact. Exit code: the worst of all calibrations, or interrupted.
ExitCode begin_job_study(const std::filesystem::path& job, const std::filesystem::path& folder,
                         const inverse::JobOverride& changes, const std::string& code, bool json);

/// Goes on with one.
ExitCode resume_job_study(const std::filesystem::path& folder, const inverse::JobOverride& changes,
                          const std::string& code, bool json);
bool holds_job_study(const std::filesystem::path& folder);

/// Only a job names the scene whose parameters it looks for, or says which are free.
bool is_job(const Document& document);

}  // namespace kerf::commands
