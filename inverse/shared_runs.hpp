#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "inverse/run_record.hpp"

namespace kerf::inverse {

/// A folder of runs that several jobs draw on: DIR/KEY.json for every run, written in one step, so that any number of
/// processes may use it at the same time. The key names the scene and the code (see RunDatabase).
class SharedRuns {
 public:
  /// Throws InputError when the folder is not there and cannot be created.
  explicit SharedRuns(std::filesystem::path folder);

  /// Nothing when the run is not there or its file is damaged.
  std::optional<RunRecord> find(const std::string& key) const;

  /// A run that crashed or hung at first is not kept: elsewhere it may not. Throws InputError when the file cannot be
  /// written.
  void keep(const std::string& key, const RunRecord& record) const;

 private:
  std::filesystem::path file(const std::string& key) const;
  std::filesystem::path folder_;
};

}  // namespace kerf::inverse
