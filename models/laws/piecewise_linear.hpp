#pragma once

#include <vector>

#include "models/laws/traction_law.hpp"

namespace kerf::laws {

/// What the laws drawn with a ruler have in common: T runs straight from the origin through the knots
/// (delta_i, T_i) to zero at the last one. Between knots
///     T = T_i + s_i (delta - delta_i),   s_i = (T_{i+1} - T_i) / (delta_{i+1} - delta_i)      (1)
///     area = A_i + T_i (delta - delta_i) + s_i (delta - delta_i)^2 / 2                        (2)
/// with A_i the trapezoids before knot i. Assumption: the openings ascend strictly and the last traction is zero;
/// whoever makes a law checks its input before.
class PiecewiseLinear : public TractionLaw {
 public:
  struct Knot {
    double opening, traction;
  };

  double traction(double opening) const override {
    if (opening >= critical_opening_) return 0.0;
    const Segment& segment = segment_at(opening);
    return segment.traction + segment.slope * (opening - segment.opening);
  }
  double slope(double opening) const override { return opening >= critical_opening_ ? 0.0 : segment_at(opening).slope; }
  double area(double opening) const override {
    if (opening >= critical_opening_) return toughness_;
    const Segment& segment = segment_at(opening);
    const double run = opening - segment.opening;
    return segment.area + run * (segment.traction + 0.5 * segment.slope * run);
  }
  double strength() const override { return strength_; }
  double critical_opening() const override { return critical_opening_; }
  double toughness() const override { return toughness_; }

 protected:
  /// `knots` without the origin.
  explicit PiecewiseLinear(const std::vector<Knot>& knots) {
    Knot from{0.0, 0.0};
    for (const Knot& to : knots) {
      segments_.push_back({.opening = from.opening,
                           .traction = from.traction,
                           .slope = (to.traction - from.traction) / (to.opening - from.opening),
                           .area = toughness_});
      toughness_ += 0.5 * (from.traction + to.traction) * (to.opening - from.opening);
      if (to.traction > strength_) strength_ = to.traction;
      from = to;
    }
    critical_opening_ = from.opening;
  }

 private:
  struct Segment {
    double opening, traction;  ///< where it begins
    double slope;
    double area;  ///< under the segments before it
  };

  const Segment& segment_at(double opening) const {
    std::size_t i = segments_.size() - 1;
    while (i > 0 && opening < segments_[i].opening) --i;
    return segments_[i];
  }

  std::vector<Segment> segments_;
  double strength_ = 0.0, critical_opening_ = 0.0, toughness_ = 0.0;
};

}  // namespace kerf::laws
