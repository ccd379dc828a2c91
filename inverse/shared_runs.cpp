#include "inverse/shared_runs.hpp"

#include <fmt/format.h>

#include <system_error>

#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"

namespace kerf::inverse {

SharedRuns::SharedRuns(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw InputError(fmt::format("{}: cannot create this folder: {}", folder_.string(), error.message()));
}

std::filesystem::path SharedRuns::file(const std::string& key) const {
  return folder_ / (key + ".json");
}

std::optional<RunRecord> SharedRuns::find(const std::string& key) const {
  if (!std::filesystem::exists(file(key))) return std::nullopt;
  try {
    return record_from_json(nlohmann::ordered_json::parse(read_file(file(key))));
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

void SharedRuns::keep(const std::string& key, const RunRecord& record) const {
  if (!record.lost && record.retried.empty()) write_atomically(file(key), to_json(record).dump() + "\n");
}

}  // namespace kerf::inverse
