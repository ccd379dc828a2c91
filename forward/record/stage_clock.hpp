#pragma once

#include <time.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "forward/run.hpp"

namespace kerf::forward {

/// Takes the steps of a run and remembers where its CPU time goes: stage by stage on every 64th step, which the run
/// does not feel, and always when a cell has been crossed. Results do not depend on it.
template <class Stage>
class StageClock {
 public:
  explicit StageClock(const std::vector<Stage>& stages, std::int64_t sample_every = 64)
      : stages_(stages), sampled_(stages.size()), sample_every_(sample_every) {}

  /// `what` is what the stages are applied to.
  template <class... What>
  void step(What&... what) {
    if (steps_++ % sample_every_ != 0) {
      for (const Stage& stage : stages_) stage.apply(what...);
      return;
    }
    Duration last = now();
    for (std::size_t i = 0; i < stages_.size(); ++i) {
      stages_[i].apply(what...);
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
  std::vector<StageTime> times() const {
    const auto seconds = [](Duration duration) { return std::chrono::duration<double>(duration).count(); };
    const std::int64_t sampled_steps = (steps_ + sample_every_ - 1) / sample_every_;
    const double scale = sampled_steps > 0 ? static_cast<double>(steps_) / static_cast<double>(sampled_steps) : 0.0;
    std::vector<StageTime> times;
    for (std::size_t i = 0; i < stages_.size(); ++i) times.push_back({stages_[i].name, scale * seconds(sampled_[i])});
    times.push_back({between_steps_name, seconds(between_)});
    return times;
  }

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
