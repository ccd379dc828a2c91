#include "inverse/fidelity_correction.hpp"

#include <cmath>

namespace kerf::inverse {
namespace {

/// Null for what is not in the record itself: a specimen is the same at both fidelities.
Estimate* estimate(RunRecord& run, Eigen::Index observable) {
  switch (static_cast<Observable>(observable)) {
    case Observable::F_c:
      return &run.F_c;
    case Observable::F_t:
      return &run.F_t;
    case Observable::chip_ratio:
      return &run.chip_ratio;
    case Observable::chip_curvature:
      return &run.chip_curvature;
    case Observable::resistance:
      break;
  }
  return nullptr;
}

}  // namespace

double FidelityCorrection::difference(Eigen::Index observable, double fine, double coarse) {
  const double change = LocalModel::is_logarithmic(observable) ? std::log(fine / coarse) : fine - coarse;
  return std::isfinite(change) ? change : 0;
}

FidelityCorrection::FidelityCorrection(const Evaluation& fine, const Evaluation& coarse)
    : point_(fine.point),
      known_(both(fine.usable, coarse.usable)),
      offset_(Observations::Zero(fine.simulated.rows(), fine.simulated.cols())) {
  slopes_.fill(Eigen::MatrixXd::Zero(fine.simulated.rows(), fine.point.size()));
  for (std::size_t cut = 0; cut < fine.runs.size(); ++cut) {
    branches_.push_back(fine.runs[cut].branch);
    if (fine.runs[cut].branch != coarse.runs[cut].branch) known_[cut] = false;
    const auto row = static_cast<Eigen::Index>(cut);
    for (Eigen::Index k = 0; k < offset_.cols() && known_[cut]; ++k)
      offset_(row, k) = difference(k, fine.simulated(row, k), coarse.simulated(row, k));
  }
}

void FidelityCorrection::apply(const Eigen::VectorXd& point, std::size_t cut, RunRecord& coarse) const {
  if (!coarse.accepted) return;
  if (!known_[cut] || coarse.branch != branches_[cut]) {
    coarse.accepted = false;
    coarse.refusals.emplace_back("the coarse run is on another branch than the fine one");
    return;
  }
  const auto row = static_cast<Eigen::Index>(cut);
  for (Eigen::Index k = 0; k < offset_.cols(); ++k) {
    const double change = offset_(row, k) + slopes_[static_cast<std::size_t>(k)].row(row).dot(point - point_);
    if (Estimate* observable = estimate(coarse, k))
      observable->value =
          LocalModel::is_logarithmic(k) ? observable->value * std::exp(change) : observable->value + change;
  }
}

void FidelityCorrection::learn(const Evaluation& fine, const Evaluation& coarse, bool move) {
  const Eigen::VectorXd step = fine.point - point_;
  const double length2 = step.squaredNorm();
  for (std::size_t cut = 0; cut < fine.runs.size(); ++cut) {
    const bool same = fine.usable[cut] && coarse.usable[cut] && fine.runs[cut].branch == coarse.runs[cut].branch;
    const bool same_as_before = same && known_[cut] && fine.runs[cut].branch == branches_[cut];
    const auto row = static_cast<Eigen::Index>(cut);
    for (Eigen::Index k = 0; k < offset_.cols() && same; ++k) {
      const double here = difference(k, fine.simulated(row, k), coarse.simulated(row, k));
      auto slopes = slopes_[static_cast<std::size_t>(k)].row(row);
      if (same_as_before && length2 > 0)
        slopes += (here - offset_(row, k) - slopes.dot(step)) / length2 * step.transpose();
      if (move) offset_(row, k) = here;
    }
    if (move) {
      known_[cut] = same;
      branches_[cut] = fine.runs[cut].branch;
    }
  }
  if (move) point_ = fine.point;
}

}  // namespace kerf::inverse
