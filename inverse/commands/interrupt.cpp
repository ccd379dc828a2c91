#include "inverse/commands/interrupt.hpp"

namespace kerf::commands {
namespace {

volatile std::sig_atomic_t interrupted = 0;

}  // namespace

StopOnInterrupt::StopOnInterrupt() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  ::sigaction(SIGINT, &action, &before_);
}

StopOnInterrupt::~StopOnInterrupt() {
  ::sigaction(SIGINT, &before_, nullptr);
}

bool StopOnInterrupt::asked() {
  return interrupted != 0;
}

}  // namespace kerf::commands
