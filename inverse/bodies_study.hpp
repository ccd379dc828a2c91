#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "inverse/study.hpp"
#include "inverse/table.hpp"
#include "inverse/work_precision.hpp"

namespace kerf::inverse {

/// How an error falls as cells shrink, e = C h^p, between neighbouring cell sizes and over all of them.
struct ObservedOrder {
  struct Point {
    std::size_t run;
    double cell, error;  ///< mm; share
  };
  std::vector<Point> points;    ///< from the coarsest on
  std::vector<double> between;  ///< p from each point to the next
  std::optional<double> all;    ///< slope of the line through all points in logarithms
};

/// Points need positive errors and cells; others are left out.
ObservedOrder observed_order(std::vector<ObservedOrder::Point> points);

/// What the runs of a study of bodies tell: of one thing that the scene is for, `result`, how far it is from its closed
/// form, or from what the reference finds.
struct BodiesFindings {
  std::string result;
  bool closed_form;
  std::vector<std::optional<RunRecord>> records;        ///< one per run; none: not run yet
  std::vector<std::optional<WorkPrecision>> precision;  ///< none for what cannot be judged
  ObservedOrder order;                                  ///< over runs that differ in the cell alone
};

/// A study that names no result takes the first error against a closed form, or else the first number, that the scene
/// as it is has found. Throws InputError (usage) when the scene has no such result, with what it has.
BodiesFindings bodies_findings(const Study& study, std::vector<std::optional<RunRecord>> records);

/// study.csv: every run is a row: what was turned, what it found, how far that is off, costs.
std::vector<Column> bodies_study_columns(const Study& study, const BodiesFindings& findings);

nlohmann::ordered_json bodies_study_json(const Study& study, const BodiesFindings& findings, double wall_seconds,
                                         const nlohmann::ordered_json& manifest);

}  // namespace kerf::inverse
