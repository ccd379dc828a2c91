#include <fmt/format.h>

#include <cmath>

#include "inverse/backend.hpp"
#include "inverse/child_process.hpp"

namespace kerf::inverse {
namespace {

std::string quoted(const std::string& word) {
  std::string text;
  for (const char c : word)
    if (c == '\'')
      text += "'\\''";
    else
      text += c;
  return fmt::format("'{}'", text);
}

std::string script(const RunProcess& run) {
  std::string text = fmt::format("exec timeout -s KILL {:.0f}", std::ceil(run.time_out));
  for (const std::string& word : run.words) text += fmt::format(" {}", quoted(word));
  return text;
}

/// The time-out counts on the node, not in the queue. A job that outlived a killed calibration holds back its successor
/// of the same name (singleton), which then finds the work done.
class Slurm : public Backend {
 public:
  std::vector<std::string> command(const RunProcess& run) const override {
    return {"sbatch",
            "--wait",
            "--quiet",
            "--requeue",
            "--ntasks=1",
            "--cpus-per-task=1",
            "--dependency=singleton",
            fmt::format("--job-name={}", run.name),
            "--output=/dev/null",
            fmt::format("--error={}", run.errors.string()),
            fmt::format("--wrap={}", script(run))};
  }
  std::optional<double> patience(const RunProcess&) const override { return std::nullopt; }
  void cancel(const RunProcess& run) const override {
    const std::vector<std::string> words{"scancel", "--quiet", fmt::format("--name={}", run.name)};
    ChildProcess(words, "/dev/null").wait({}, {});
  }
};

}  // namespace

std::unique_ptr<Backend> slurm_backend() {
  return std::make_unique<Slurm>();
}

}  // namespace kerf::inverse
