#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kerf::chip {

/// One measured cut as the fits see it. Forces per width in N/mm, lengths in mm, angles in rad.
struct MeasuredCut {
  double depth = 0.0;
  double rake = 0.0;
  double F_c = 0.0;
  std::optional<double> F_t;
  std::optional<double> F_c_error;  ///< standard error of the mean
  std::optional<double> F_t_error;
  std::optional<double> chip_ratio;  ///< chip thickness / depth of cut
  std::optional<double> chip_ratio_error;
  std::optional<double> tool_radius;
  int repeats = 1;  ///< that each mean and standard error come from; 1: the errors count as known
  int line = 0;     ///< where it stands in its file, for messages
};

/// How far off a measured force is expected to be.
struct Noise {
  bool measured = false;  ///< false: weights are one and the scatter about the fit sets the scale
  double freedom = 0.0;   ///< degrees of freedom behind the measured errors; infinite when they count as known
};

/// Cuts of one experiment with their common properties.
class Measurements {
 public:
  explicit Measurements(std::vector<MeasuredCut> cuts);

  const std::vector<MeasuredCut>& cuts() const { return cuts_; }
  int size() const { return static_cast<int>(cuts_.size()); }
  bool has_F_t() const { return has_F_t_; }
  bool has_chip_ratio() const { return has_chip_ratio_; }
  /// Errors of every force are known (a missing or zero one makes the weights of all the rest meaningless).
  bool errors_known() const { return errors_known_; }
  /// Noise of a fit to `forces` kinds of force (1: F_c; 2: F_c and F_t).
  Noise noise(int forces) const;
  double F_c_error(const MeasuredCut& cut) const { return errors_known_ ? *cut.F_c_error : 1.0; }
  double F_t_error(const MeasuredCut& cut) const { return errors_known_ ? *cut.F_t_error : 1.0; }

  const std::vector<double>& rakes() const { return rakes_; }    ///< distinct, rising
  const std::vector<double>& depths() const { return depths_; }  ///< distinct, rising

 private:
  std::vector<MeasuredCut> cuts_;
  std::vector<double> rakes_;
  std::vector<double> depths_;
  bool has_F_t_ = true;
  bool has_chip_ratio_ = true;
  bool errors_known_ = true;
};

}  // namespace kerf::chip
