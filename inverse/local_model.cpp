#include "inverse/local_model.hpp"

#include <algorithm>

namespace kerf::inverse {
namespace {

// Of ln(force), per square of a search coordinate: by how much slopes may have changed between two points.
constexpr double usual_curvature = 0.5;

}  // namespace

LocalModel::LocalModel(Evaluation base)
    : base_(std::move(base)), has_slopes_(base_.usable.size(), true), at_jump_(base_.usable.size(), false) {
  slopes_.fill(Eigen::MatrixXd::Zero(base_.simulated.rows(), base_.point.size()));
  slope_errors_ = slopes_;
}

double LocalModel::change(Eigen::Index cut, Eigen::Index observable, double simulated) const {
  const double here = base_.simulated(cut, observable);
  return is_logarithmic(observable) ? std::log(simulated / here) : simulated - here;
}

LocalModel LocalModel::by_differences(Objective& objective, const Evaluation& base) {
  const ParameterSpace& space = objective.space();
  LocalModel model(base);
  model.roughness_ = objective.choice().roughness;
  struct Wanted {
    std::size_t cut;
    Eigen::Index parameter;
    int sides = 0;                           ///< differences taken so far
    double inverse = 0, inverse_square = 0;  ///< sums over their steps
    bool crossed = false;                    ///< the branch changed: shorter steps may stay on it
  };
  std::vector<Wanted> wanted;
  for (Eigen::Index j = 0; j < space.dimension(); ++j)
    for (std::size_t cut = 0; cut < objective.cuts(); ++cut)
      if (base.usable[cut]) wanted.push_back({.cut = cut, .parameter = j});

  for (const double factor : {1.0, -1.0, 0.5, -0.5, 0.25, -0.25, 0.125, -0.125}) {
    const bool whole = std::abs(factor) == 1, shrunk = std::abs(factor) < 0.5;
    const int sides = whole && objective.choice().central ? 2 : 1;
    std::vector<Objective::Probe> probes;
    std::vector<Wanted*> probed;
    for (Wanted& slope : wanted) {
      if (slope.sides >= sides || (shrunk && !slope.crossed)) continue;
      const Eigen::Index j = slope.parameter;
      const double range = space.upper()[j] - space.lower()[j];
      const double step = std::min(objective.choice().step, 0.4 * range);
      const bool room_above = base.point[j] + step <= space.upper()[j];
      Eigen::VectorXd point = base.point;
      point[j] += (room_above ? 1 : -1) * factor * step;
      if (point[j] < space.lower()[j] || point[j] > space.upper()[j]) continue;
      probes.push_back({std::move(point), slope.cut});
      probed.push_back(&slope);
    }
    if (probes.empty()) continue;
    const std::vector<RunRecord> runs = objective.simulate(probes);
    for (std::size_t p = 0; p < runs.size(); ++p) {
      Wanted& slope = *probed[p];
      if (!objective.misfit().is_usable(slope.cut, runs[p])) continue;
      if (runs[p].branch != base.runs[slope.cut].branch) {
        slope.crossed = model.at_jump_[slope.cut] = true;
        continue;
      }
      const auto row = static_cast<Eigen::Index>(slope.cut);
      const Eigen::Index j = slope.parameter;
      const Eigen::RowVectorXd simulated = objective.misfit().observations(slope.cut, runs[p]);
      for (Eigen::Index k = 0; k < simulated.size(); ++k) {
        if (objective.misfit().weights()(row, k) == 0) continue;
        double& mean = model.slopes_[static_cast<std::size_t>(k)](row, j);
        mean += (model.change(row, k, simulated[k]) / (probes[p].point[j] - base.point[j]) - mean) / (slope.sides + 1);
      }
      const double step = probes[p].point[j] - base.point[j];
      slope.inverse += 1 / step;
      slope.inverse_square += 1 / (step * step);
      ++slope.sides;
    }
  }
  for (const Wanted& slope : wanted) {
    if (slope.sides == 0) {
      model.has_slopes_[slope.cut] = false;
      continue;
    }
    // Every difference has a roughness of its own at its far end, and that of the base in common with the others.
    const double rough = std::sqrt(slope.inverse_square + slope.inverse * slope.inverse) / slope.sides;
    const auto row = static_cast<Eigen::Index>(slope.cut);
    for (Eigen::Index k = 0; k < base.simulated.cols(); ++k)
      model.slope_errors_[static_cast<std::size_t>(k)](row, slope.parameter) =
          rough * objective.choice().roughness * (is_logarithmic(k) ? 1 : typical_size(base.simulated, row, k));
  }
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
  const double told = 1 / (1 + 2 * std::pow(roughness_ / (0.5 * usual_curvature * length2), 2));
  for (std::size_t cut = 0; cut < base_.runs.size(); ++cut) {
    if (!base_.usable[cut] || !other.usable[cut] || base_.runs[cut].branch != other.runs[cut].branch) continue;
    const auto row = static_cast<Eigen::Index>(cut);
    for (std::size_t k = 0; k < observable_count; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const double surprise = change(row, column, other.simulated(row, column)) - slopes_[k].row(row).dot(step);
      if (std::isfinite(surprise)) slopes_[k].row(row) += told * surprise / length2 * step.transpose();
    }
  }
}

LocalModel LocalModel::scaled(const Eigen::MatrixXd& share) const {
  LocalModel result = *this;
  for (Eigen::MatrixXd& slopes : result.slopes_) slopes *= share;
  return result;
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
