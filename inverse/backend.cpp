#include "inverse/backend.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace kerf::inverse {
namespace {

class Local : public Backend {
 public:
  std::vector<std::string> command(const RunProcess& run) const override { return run.words; }
  std::optional<double> patience(const RunProcess& run) const override { return run.time_out; }
  void cancel(const RunProcess&) const override {}
};

}  // namespace

std::unique_ptr<Backend> local_backend() {
  return std::make_unique<Local>();
}

std::unique_ptr<Backend> find_backend(const std::string& name) {
  if (name == "local") return local_backend();
  if (name == "slurm") return slurm_backend();
  throw std::invalid_argument(fmt::format("there is no backend \"{}\"", name));
}

std::vector<std::string> backend_names() {
  return {"local", "slurm"};
}

}  // namespace kerf::inverse
