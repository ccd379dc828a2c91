#include "inverse/commands/interruptible_run.hpp"

#include "inverse/commands/interrupt.hpp"
#include "inverse/run_database.hpp"

namespace kerf::commands {

forward::CutResult run_unless_interrupted(const forward::Scene& scene) {
  if (StopOnInterrupt::asked()) throw inverse::Interrupted{};
  bool stopped = false;
  forward::CutResult result = forward::run(scene, [&](const forward::Progress&) {
    stopped = StopOnInterrupt::asked();
    return !stopped;
  });
  if (stopped) throw inverse::Interrupted{};
  return result;
}

}  // namespace kerf::commands
