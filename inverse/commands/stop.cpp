#include "inverse/commands/stop.hpp"

#include <system_error>

#include "inverse/commands/interrupt.hpp"

namespace kerf::commands {

std::map<std::string, double> time_units() {
  return {{"s", 1}, {"min", 60}, {"h", 3600}, {"d", 86400}};
}

Stop::Stop(const std::filesystem::path& folder, double max_seconds) : file_(folder / "stop") {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  if (max_seconds > 0)
    end_ = std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(max_seconds));
}

const char* Stop::reason() const {
  if (StopOnInterrupt::asked()) return "interrupted";
  if (end_ && std::chrono::steady_clock::now() >= *end_) return "stopped by --max-time";
  std::error_code ignored;
  return std::filesystem::exists(file_, ignored) ? "stopped by the file \"stop\"" : nullptr;
}

}  // namespace kerf::commands
