#include "inverse/local_model.hpp"

#include <algorithm>

namespace kerf::inverse {

LocalModel::LocalModel(Evaluation base) : base_(std::move(base)), has_slopes_(base_.usable.size(), true) {
  slopes_.fill(Eigen::MatrixXd::Zero(base_.simulated.rows(), base_.point.size()));
}

double LocalModel::change(Eigen::Index cut, Eigen::Index observable, double simulated) const {
  const double here = base_.simulated(cut, observable);
  return is_logarithmic(observable) ? std::log(simulated / here) : simulated - here;
}

LocalModel LocalModel::by_differences(Objective& objective, const Evaluation& base) {
  const ParameterSpace& space = objective.space();
  LocalModel model(base);
  struct Missing {
    std::size_t cut;
    Eigen::Index parameter;
  };
  std::vector<Missing> missing;
  for (Eigen::Index j = 0; j < space.dimension(); ++j)
    for (std::size_t cut = 0; cut < objective.cuts(); ++cut)
      if (base.usable[cut]) missing.push_back({cut, j});

  for (const double factor : {1.0, -1.0, 0.5, -0.5}) {
    std::vector<Objective::Probe> probes;
    std::vector<Missing> probed, still_missing;
    for (const Missing& wanted : missing) {
      const Eigen::Index j = wanted.parameter;
      const double range = space.upper()[j] - space.lower()[j];
      const double step = std::min(objective.choice().step, 0.4 * range);
      const bool room_above = base.point[j] + step <= space.upper()[j];
      Eigen::VectorXd point = base.point;
      point[j] += (room_above ? 1 : -1) * factor * step;
      if (point[j] < space.lower()[j] || point[j] > space.upper()[j]) {
        still_missing.push_back(wanted);
        continue;
      }
      probes.push_back({std::move(point), wanted.cut});
      probed.push_back(wanted);
    }
    const std::vector<RunRecord> runs = objective.simulate(probes);
    for (std::size_t p = 0; p < runs.size(); ++p) {
      const auto [cut, j] = probed[p];
      if (!objective.misfit().is_usable(cut, runs[p]) || runs[p].branch != base.runs[cut].branch) {
        still_missing.push_back(probed[p]);
        continue;
      }
      const auto row = static_cast<Eigen::Index>(cut);
      const Eigen::RowVectorXd simulated = observations(runs[p]);
      for (Eigen::Index k = 0; k < simulated.size(); ++k)
        if (objective.misfit().weights()(row, k) != 0)
          model.slopes_[static_cast<std::size_t>(k)](row, j) =
              model.change(row, k, simulated[k]) / (probes[p].point[j] - base.point[j]);
    }
    missing = std::move(still_missing);
    if (missing.empty()) break;
  }
  for (const Missing& left : missing) model.has_slopes_[left.cut] = false;
  return model;
}

Observations LocalModel::predict(const Eigen::VectorXd& point) const {
  std::vector<const double*> coordinates;
  for (Eigen::Index j = 0; j < point.size(); ++j) coordinates.push_back(&point[j]);
  Observations result = base_.simulated;
  for (Eigen::Index i = 0; i < result.rows(); ++i)
    for (Eigen::Index k = 0; k < result.cols(); ++k) result(i, k) = predict<double>(i, k, coordinates.data());
  return result;
}

void LocalModel::learn(const Evaluation& other) {
  const Eigen::VectorXd step = other.point - base_.point;
  const double length2 = step.squaredNorm();
  if (length2 == 0) return;
  for (std::size_t cut = 0; cut < base_.runs.size(); ++cut) {
    if (!base_.usable[cut] || !other.usable[cut] || base_.runs[cut].branch != other.runs[cut].branch) continue;
    const auto row = static_cast<Eigen::Index>(cut);
    for (std::size_t k = 0; k < observable_count; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const double surprise = change(row, column, other.simulated(row, column)) - slopes_[k].row(row).dot(step);
      if (std::isfinite(surprise)) slopes_[k].row(row) += surprise / length2 * step.transpose();
    }
  }
}

void LocalModel::move_to(const Evaluation& other) {
  if (other.point != base_.point) fresh_ = false;
  base_ = other;
}

bool LocalModel::branches_differ(const Evaluation& a, const Evaluation& b) {
  for (std::size_t cut = 0; cut < a.runs.size(); ++cut)
    if (a.usable[cut] && b.usable[cut] && a.runs[cut].branch != b.runs[cut].branch) return true;
  return false;
}

}  // namespace kerf::inverse
