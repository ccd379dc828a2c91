#pragma once

#include <csignal>

namespace kerf::commands {

/// While it lives, the first Ctrl-C asks for a clean end at the next occasion; a second one ends the
/// process, which a journal survives as well.
class StopOnInterrupt {
 public:
  StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  ~StopOnInterrupt();

  static bool asked();

 private:
  struct sigaction before_ {};
};

}  // namespace kerf::commands
