#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "forward/bodies/run.hpp"
#include "forward/run.hpp"

namespace kerf::inverse {

/// What is remembered of one simulated cut: everything but its history and its picture. Of an experiment on bodies
/// there are the verdict, `result` with what it is for and what it took, and nothing of a cut. A run that failed is a
/// value too (`accepted` false, `refusals` in words).
// NOLINTNEXTLINE(bugprone-exception-escape): that of the json, which its library declares not to throw
struct RunRecord {
  Estimate F_c, F_t;        ///< N/mm
  Estimate chip_ratio;      ///< chip thickness / depth of cut
  Estimate chip_curvature;  ///< 1/mm
  Estimate crack_lead;      ///< mm
  forward::Branch branch = forward::Branch::touching;
  double mode_I_fraction = 0;
  double fracture_energy_ratio = 0;
  double deepest_penetration = 0;  ///< cells
  bool steady = false;
  bool accepted = false;
  std::vector<std::string> refusals;
  forward::Ledger ledger;
  double wall_seconds = 0;
  nlohmann::ordered_json result;  ///< forward::result_json, for tables: all there is to show; null if it never ran
  std::string retried;            ///< what became of a first attempt, and what the second did otherwise; else empty
  bool lost = false;              ///< no attempt ended with a result: it crashed or hung

  /// Processor time, s; 0 of a run that left no result.
  double core_seconds() const;
};

RunRecord summarise(const forward::CutResult& result);
RunRecord summarise(const forward::bodies::BodiesResult& result);

/// What an experiment on bodies found under this name; NaN where it found no such thing.
double found_in(const RunRecord& record, const std::string& name);

/// G_R of a specimen's run where its crack has grown by `extension`, N/mm: what it took to grow on, linear between the
/// cells that the crack passed. NaN where it did not grow that far, and of a run without an R-curve.
double resistance(const RunRecord& record, double extension);

/// A run that never started because the patched scene was refused by its reader.
RunRecord refused(std::string cause);

/// JSON in which every double survives the round trip bitwise; what is not finite is written as text.
nlohmann::ordered_json to_json(const RunRecord& record);
/// Throws nlohmann::json::exception when `json` does not hold a record.
RunRecord record_from_json(const nlohmann::ordered_json& json);

}  // namespace kerf::inverse
