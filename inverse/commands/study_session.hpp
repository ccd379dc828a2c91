#pragma once

#include "inverse/scene_folder.hpp"
#include "inverse/study.hpp"
#include "models/base/error.hpp"

namespace kerf::commands {

/// Runs or continues the study in `folder` and writes what it finds there: study.csv, study.json and the report with
/// its figure (study.svg). Results go to standard output, progress to standard error; Ctrl-C leaves what there is.
ExitCode run_study(inverse::SceneFolder& folder, const inverse::Study& study, const std::string& code, bool json);

/// The study that a folder's request asks for.
inverse::Study study_in(const inverse::SceneFolder& folder);

}  // namespace kerf::commands
