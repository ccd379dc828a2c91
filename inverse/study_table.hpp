#pragma once

#include <functional>
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

/// What studies of cuts and of bodies have in common: every run is a row with what was turned, what was `found`, costs.
std::vector<Column> study_frame_columns(const Study& study, const std::vector<std::optional<RunRecord>>& records,
                                        std::vector<Column> found);
/// The same for machines: knobs, runs with what `error` says of each, and costs.
nlohmann::ordered_json study_frame_json(const Study& study, const std::vector<std::optional<RunRecord>>& records,
                                        const std::function<nlohmann::ordered_json(std::size_t run)>& error,
                                        double wall_seconds, const nlohmann::ordered_json& manifest);
const char* verdict_of(const std::optional<RunRecord>& record);
/// What a run is for: the name of the knob that was turned, "reference" or "as it is".
std::string role_of(const Study& study, std::size_t run);

}  // namespace kerf::inverse
