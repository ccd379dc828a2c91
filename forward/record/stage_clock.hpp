#pragma once

#include <time.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "forward/plan.hpp"
#include "forward/run.hpp"

namespace kerf::forward {

/// Takes the steps of a run and remembers where its CPU time goes: stage by stage on every 64th step, which the run
/// does not feel, and always when a cell has been crossed. Results do not depend on it.
class StageClock {
 public:
  explicit StageClock(const std::vector<Stage>& stages, std::int64_t sample_every = 64)
      : stages_(stages), sampled_(stages.size()), sample_every_(sample_every) {}

  void step(State& state) {
    if (steps_++ % sample_every_ != 0) {
      for (const Stage& stage : stages_) stage.apply(state);
      return;
    }
    Duration last = now();
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      stages_[i].apply(state);
      const Duration then = now();
      sampled_[i] += then - last;
      last = then;
    }
  }

  /// What is done now and then rather than in every step.
  template <class Work>
  void between_steps(Work&& work) {
    const Duration begin = now();
    work();
    between_ += now() - begin;
  }

  /// Since this clock was made.
  double processor_seconds() const { return std::chrono::duration<double>(now() - begin_).count(); }
  /// The stages in their order, and last what was done between steps; seconds are scaled to all steps.
  std::vector<StageTime> times() const;

 private:
  using Duration = std::chrono::nanoseconds;
  /// Of this thread alone, so that a busy machine does not count.
  static Duration now() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + Duration(time.tv_nsec);
  }
  const std::vector<Stage>& stages_;
  std::vector<Duration> sampled_;
  std::int64_t sample_every_;
  Duration between_{};
  Duration begin_ = now();
  std::int64_t steps_ = 0;
};

}  // namespace kerf::forward
