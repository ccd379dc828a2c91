#include "models/chip/measured_cut.hpp"

#include <algorithm>
#include <limits>

namespace kerf::chip {

namespace {

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

bool positive(const std::optional<double>& value) {
  return value && *value > 0.0;
}

}  // namespace

Measurements::Measurements(std::vector<MeasuredCut> cuts) : cuts_(std::move(cuts)) {
  for (const auto& cut : cuts_) {
    rakes_.push_back(cut.rake);
    depths_.push_back(cut.depth);
    has_F_t_ = has_F_t_ && cut.F_t.has_value();
    has_chip_ratio_ = has_chip_ratio_ && cut.chip_ratio.has_value();
    errors_known_ = errors_known_ && positive(cut.F_c_error) && (!cut.F_t || positive(cut.F_t_error));
  }
  rakes_ = distinct(std::move(rakes_));
  depths_ = distinct(std::move(depths_));
}

Noise Measurements::noise(int forces) const {
  double freedom = 0.0;
  for (const auto& cut : cuts_) {
    if (cut.repeats <= 1) return {errors_known_, std::numeric_limits<double>::infinity()};
    freedom += forces * (cut.repeats - 1);
  }
  return {errors_known_, freedom};
}

}  // namespace kerf::chip
