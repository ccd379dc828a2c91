#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "inverse/convergence.hpp"
#include "inverse/study.hpp"
#include "inverse/table.hpp"
#include "inverse/work_precision.hpp"

namespace kerf::inverse {

/// What the runs of a study tell.
struct StudyFindings {
  std::vector<std::optional<RunRecord>> records;        ///< one per run; none: not run yet
  std::vector<std::optional<WorkPrecision>> precision;  ///< against the reference; none for what cannot be judged
  Convergence F_c, F_t;                                 ///< in the cell size, N/mm
  std::vector<std::size_t> resolutions;                 ///< accepted runs that the convergence rests on
};

StudyFindings study_findings(const Study& study, std::vector<std::optional<RunRecord>> records);

/// study.csv: every run is a row: what was turned, forces, errors against the reference, costs.
std::vector<Column> study_columns(const Study& study, const StudyFindings& findings);

nlohmann::ordered_json study_json(const Study& study, const StudyFindings& findings, double wall_seconds,
                                  const nlohmann::ordered_json& manifest);

}  // namespace kerf::inverse
