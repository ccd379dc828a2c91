#include "forward/record/stage_clock.hpp"

namespace kerf::forward {

std::vector<StageTime> StageClock::times() const {
  const auto seconds = [](Duration duration) { return std::chrono::duration<double>(duration).count(); };
  const std::int64_t sampled_steps = (steps_ + sample_every_ - 1) / sample_every_;
  const double scale = sampled_steps > 0 ? static_cast<double>(steps_) / static_cast<double>(sampled_steps) : 0.0;
  std::vector<StageTime> times;
  for (std::size_t i = 0; i < stages_.size(); ++i) times.push_back({stages_[i].name, scale * seconds(sampled_[i])});
  times.push_back({between_steps_name, seconds(between_)});
  return times;
}

}  // namespace kerf::forward
