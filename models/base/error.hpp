#pragma once

#include <stdexcept>
#include <string>

namespace kerf {

/// What the process returns; one meaning per number, also printed by `kerf --help`.
enum class ExitCode {
  success = 0,
  internal_error = 1,
  usage = 2,
  bad_data = 3,
  not_converged = 4,
  too_many_failed_runs = 5,
  not_identifiable = 6,
  interrupted = 130,
};

/// The user's input is wrong. `what()` is the whole message, starting with where it stands
/// ("cut.toml:14:12: ..."), what was found and what is allowed. Thrown anywhere, caught once in `main`.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message, ExitCode code = ExitCode::bad_data)
      : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

}  // namespace kerf
