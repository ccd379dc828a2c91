#include "inverse/local_model.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "inverse/quadratic_response.hpp"

namespace kerf::inverse {
namespace {

constexpr auto F_c = static_cast<Eigen::Index>(Observable::F_c);
constexpr auto F_t = static_cast<Eigen::Index>(Observable::F_t);
constexpr double harmless = 0.1;          // share by which errors of slopes may add to the information on a parameter
constexpr double worse_than_fresh = 1.2;  // another difference must be worth its run

/// Observables on the scale where they answer the parameters most nearly linearly: logarithms of what is positive, the
/// chip's curvature, and F_t/F_c, which on a sliding rake face is the tangent of friction angle less rake angle
/// (Merchant 1945) and hardly hangs on anything but friction.
Eigen::RowVectorXd model_scale(const Eigen::RowVectorXd& simulated) {
  Eigen::RowVectorXd scaled = simulated;
  for (Eigen::Index k = 0; k < simulated.size(); ++k)
    if (LocalModel::is_logarithmic(k)) scaled[k] = std::log(simulated[k]);
  scaled[F_t] = simulated[F_t] / simulated[F_c];
  return scaled;
}

/// What one on the model's scale is in the observable's own terms: d ln(observable) where it is positive.
double unit(const Evaluation& base, Eigen::Index cut, Eigen::Index observable) {
  if (LocalModel::is_logarithmic(observable)) return 1;
  return observable == F_t ? base.simulated(cut, F_c) : 1;
}

/// What a relative roughness is a share of, on the model's scale.
double model_size(const Evaluation& base, Eigen::Index cut, Eigen::Index observable) {
  if (LocalModel::is_logarithmic(observable)) return 1;
  return typical_size(base.simulated, cut, observable) / unit(base, cut, observable);
}

}  // namespace

LocalModel::LocalModel(Evaluation base, const OptimiserChoice& choice)
    : base_(std::move(base)), choice_(choice), runs_(base_.usable.size()), has_slopes_(base_.usable.size(), false) {
  const Eigen::Index n = base_.point.size();
  told_ = Eigen::MatrixXd::Zero(base_.simulated.rows(), n);
  fresh_errors_ = Eigen::MatrixXd::Zero(base_.simulated.rows(), base_.simulated.cols());
  slopes_.fill(told_);
  errors_.fill(told_);
  silent_.fill(SlopeMask::Constant(told_.rows(), n, false));
  curvatures_.fill(std::vector<Eigen::MatrixXd>(base_.usable.size(), Eigen::MatrixXd::Zero(n, n)));
  rough_covariances_ = curvatures_;
  learn(base_);
}

LocalModel LocalModel::by_differences(Objective& objective, const Evaluation& base) {
  LocalModel model(base, objective.choice());
  model.difference(objective);
  return model;
}

void LocalModel::add(std::size_t cut, const Eigen::VectorXd& point, const RunRecord& run,
                     const Eigen::RowVectorXd& simulated) {
  std::vector<Run>& runs = runs_[cut];
  Run taken{.point = point, .scaled = model_scale(simulated), .branch = run.branch};
  const auto known = std::find_if(runs.begin(), runs.end(), [&](const Run& other) { return other.point == point; });
  if (known == runs.end())
    runs.push_back(std::move(taken));
  else
    *known = std::move(taken);
}

void LocalModel::refit() {
  std::vector<Eigen::MatrixXd> steps(runs_.size()), changes(runs_.size());
  for (std::size_t cut = 0; cut < runs_.size(); ++cut) {
    if (!base_.usable[cut]) continue;
    std::vector<const Run*> used;
    for (const Run& run : runs_[cut])
      if (run.branch == base_.runs[cut].branch && run.point != base_.point) used.push_back(&run);
    const auto row = static_cast<Eigen::Index>(cut);
    // What lies beyond the reach of a parabola is not heard where the runs within tell slopes as differences would.
    const auto far = std::stable_partition(used.begin(), used.end(),
                                           [&](const Run* run) { return (run->point - base_.point).norm() <= reach; });
    const Eigen::MatrixXd near = steps_of({used.begin(), far});
    const double enough = 2 * fresh_error({.roughness = choice_.roughness});
    steps[cut] = errors_if_usual(near).maxCoeff() <= enough ? near : steps_of(used);
    told_.row(row) = errors_if_usual(steps[cut]).transpose();
    has_slopes_[cut] = told_.row(row).maxCoeff() <= unknown_error();
    changes[cut].resize(steps[cut].rows(), base_.simulated.cols());
    const Eigen::RowVectorXd here = model_scale(base_.simulated.row(row));
    for (Eigen::Index i = 0; i < steps[cut].rows(); ++i)
      changes[cut].row(i) = used[static_cast<std::size_t>(i)]->scaled - here;
  }
  for (Eigen::Index k = 0; k < base_.simulated.cols(); ++k) refit(k, steps, changes);
  for (std::size_t cut = 0; cut < runs_.size(); ++cut)
    if (base_.usable[cut]) silence(cut, steps[cut], changes[cut]);
}

void LocalModel::refit(Eigen::Index observable, const std::vector<Eigen::MatrixXd>& steps,
                       const std::vector<Eigen::MatrixXd>& changes) {
  const auto k = static_cast<std::size_t>(observable);
  std::vector<std::size_t> cuts;
  std::vector<ResponseSample> samples;
  for (std::size_t cut = 0; cut < runs_.size(); ++cut) {
    if (!base_.usable[cut] || !std::isfinite(base_.simulated(static_cast<Eigen::Index>(cut), observable)) ||
        !changes[cut].col(observable).allFinite())
      continue;  // it was not simulated
    cuts.push_back(cut);
    samples.push_back({steps[cut], changes[cut].col(observable), said_texture(cut, observable)});
  }
  const std::vector<Texture> textures = likeliest_textures(samples);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(cuts[i]);
    const QuadraticResponse response(samples[i].steps, textures[i]);
    slopes_[k].row(row) = response.slopes(samples[i].changes).transpose();
    curvatures_[k][cuts[i]] = response.curvatures(samples[i].changes);
    errors_[k].row(row) = response.slope_errors().transpose();
    rough_covariances_[k][cuts[i]] = response.rough_covariance();
    fresh_errors_(row, observable) = fresh_error(textures[i]);
  }
}

Eigen::MatrixXd LocalModel::steps_of(const std::vector<const Run*>& runs) const {
  Eigen::MatrixXd steps(static_cast<Eigen::Index>(runs.size()), base_.point.size());
  for (Eigen::Index i = 0; i < steps.rows(); ++i)
    steps.row(i) = (runs[static_cast<std::size_t>(i)]->point - base_.point).transpose();
  return steps;
}

Eigen::VectorXd LocalModel::errors_if_usual(const Eigen::MatrixXd& steps) const {
  return QuadraticResponse(steps, {.roughness = choice_.roughness}).slope_errors();
}

Texture LocalModel::said_texture(std::size_t cut, Eigen::Index observable) const {
  const auto row = static_cast<Eigen::Index>(cut);
  // A mean force is known to the standard error of its window. Neighbours swing alike and share it; F_t/F_c has none,
  // since both swing together.
  const double own = simulation_errors(base_.runs[cut])[static_cast<std::size_t>(observable)];
  const double value = is_logarithmic(observable) ? base_.simulated(row, observable) : 1;
  const double size = model_size(base_, row, observable);
  return {.roughness = choice_.roughness * size,
          .ripple = observable == F_t || !std::isfinite(own) ? 0 : own / value,
          .bend = is_logarithmic(observable) || observable == F_t ? 1 : std::max(size, 1e-6)};
}

void LocalModel::silence(std::size_t cut, const Eigen::MatrixXd& steps, const Eigen::MatrixXd& changes) {
  const auto row = static_cast<Eigen::Index>(cut);
  for (SlopeMask& silent : silent_) silent.row(row).setConstant(false);
  for (Eigen::Index i = 0; i < steps.rows(); ++i) {
    Eigen::Index j = 0;
    steps.row(i).cwiseAbs().maxCoeff(&j);
    if ((steps.row(i).array() != 0).count() != 1) continue;
    for (std::size_t k = 0; k < observable_count; ++k) {
      if (changes(i, static_cast<Eigen::Index>(k)) != 0) continue;
      silent_[k](row, j) = true;
      slopes_[k](row, j) = 0;
      curvatures_[k][cut].row(j).setZero();
      curvatures_[k][cut].col(j).setZero();
    }
  }
}

double LocalModel::fresh_error(const Texture& texture) const {
  Eigen::MatrixXd steps(choice_.central ? 2 : 1, 1);
  steps(0, 0) = choice_.step;
  if (choice_.central) steps(1, 0) = -choice_.step;
  return QuadraticResponse(steps, texture).slope_errors()[0];
}

LocalModel::SlopeMask LocalModel::unsure(const Objective& objective) const {
  const Misfit& misfit = objective.misfit();
  const ParameterSpace& space = objective.space();
  const Eigen::Index n = base_.point.size();
  const double edge_force = misfit.residuals(predict(base_.point), base_.point, known()).edge_force;
  const Eigen::MatrixXd jacobian = residual_slopes(*this, misfit, base_.point, edge_force);
  Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  for (Eigen::Index j = 0; j < n; ++j) information(j, j) += 12 / std::pow(space.upper()[j] - space.lower()[j], 2);
  if (information.rows() > n) information(n, n) += 1e-12 * (1 + information(n, n));
  const Eigen::VectorXd variances = information.inverse().diagonal();

  SlopeMask result(told_.rows(), n);
  for (Eigen::Index i = 0; i < told_.rows(); ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      double feigned = 0;  // by what another difference would tell better
      for (Eigen::Index k = 0; k < base_.simulated.cols(); ++k) {
        const double weight = misfit.weights()(i, k);
        if (weight == 0) continue;
        const auto add = [&](Eigen::Index of, double value) {
          const auto observable = static_cast<std::size_t>(of);
          const double error = errors_[observable](i, j);
          if (!silent_[observable](i, j) && error > worse_than_fresh * fresh_errors_(i, of))
            feigned += std::pow(weight * value * error, 2);
        };
        add(k, is_logarithmic(k) ? base_.simulated(i, k) : unit(base_, i, k));
        if (k == F_t) add(F_c, base_.simulated(i, F_t));
      }
      const auto cut = static_cast<std::size_t>(i);
      const bool matters = feigned * variances[j] * static_cast<double>(count(base_.usable)) > harmless;
      result(i, j) = base_.usable[cut] && (told_(i, j) > unknown_error() || matters);
    }
  return result;
}

bool LocalModel::is_sure(const Objective& objective) const {
  if (fresh_) return true;
  for (const std::vector<Run>& runs : runs_)
    for (const Run& run : runs)
      if (run.borrowed) return false;
  return !unsure(objective).any();
}

void LocalModel::difference(Objective& objective) {
  for (std::vector<Run>& runs : runs_) std::erase_if(runs, [](const Run& run) { return run.borrowed; });
  refit();
  improve(objective, unsure(objective));
  fresh_ = true;
}

void LocalModel::difference_unknown(Objective& objective) {
  SlopeMask unknown = told_.array() > unknown_error();
  for (std::size_t cut = 0; cut < base_.usable.size(); ++cut)
    if (!base_.usable[cut]) unknown.row(static_cast<Eigen::Index>(cut)).setConstant(false);
  improve(objective, unknown);
}

void LocalModel::improve(Objective& objective, const SlopeMask& chosen) {
  const ParameterSpace& space = objective.space();
  struct Wanted {
    std::size_t cut;
    Eigen::Index parameter;
    double side;           ///< away from the runs that are known
    int differences = 0;   ///< taken so far
    bool crossed = false;  ///< the branch changed: shorter steps may stay on it
  };
  std::vector<Wanted> wanted;
  for (Eigen::Index j = 0; j < space.dimension(); ++j)
    for (std::size_t cut = 0; cut < objective.cuts(); ++cut) {
      if (!chosen(static_cast<Eigen::Index>(cut), j)) continue;
      double known = 0;
      for (const Run& run : runs_[cut]) known += run.point[j] - base_.point[j];
      wanted.push_back({.cut = cut, .parameter = j, .side = known > 1e-9 ? -1.0 : 1.0});
    }

  for (const double factor : {1.0, -1.0, 0.5, -0.5, 0.25, -0.25, 0.125, -0.125}) {
    const bool whole = std::abs(factor) == 1, shrunk = std::abs(factor) < 0.5;
    const int sides = whole && objective.choice().central ? 2 : 1;
    std::vector<Objective::Probe> probes;
    std::vector<Wanted*> probed;
    for (Wanted& slope : wanted) {
      if (slope.differences >= sides || (shrunk && !slope.crossed)) continue;
      const Eigen::Index j = slope.parameter;
      const double range = space.upper()[j] - space.lower()[j];
      const double step = slope.side * std::min(objective.choice().step, 0.4 * range);
      const double there = base_.point[j] + step;
      const bool room = there >= space.lower()[j] && there <= space.upper()[j];
      Eigen::VectorXd point = base_.point;
      point[j] += (room ? 1 : -1) * factor * step;
      if (point[j] < space.lower()[j] || point[j] > space.upper()[j]) continue;
      probes.push_back({std::move(point), slope.cut});
      probed.push_back(&slope);
    }
    if (probes.empty()) continue;
    std::vector<RunRecord> records;
    try {
      records = objective.simulate(probes);
    } catch (const BudgetSpent&) {
      refit();  // what was paid for counts
      throw;
    }
    for (std::size_t p = 0; p < records.size(); ++p) {
      Wanted& slope = *probed[p];
      if (!objective.misfit().is_usable(slope.cut, records[p])) continue;
      add(slope.cut, probes[p].point, records[p], objective.misfit().observations(slope.cut, records[p]));
      if (records[p].branch == base_.runs[slope.cut].branch)
        ++slope.differences;
      else
        slope.crossed = true;
    }
  }
  refit();
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
  for (std::size_t cut = 0; cut < runs_.size(); ++cut)
    if (other.usable[cut]) add(cut, other.point, other.runs[cut], other.simulated.row(static_cast<Eigen::Index>(cut)));
  refit();
}

void LocalModel::borrow_for(const Evaluation& other) {
  const Observations predicted = predict(other.point);
  Eigen::VectorXd step = other.point - base_.point;
  if (step.norm() > reach) step *= reach / step.norm();
  for (std::size_t cut = 0; cut < runs_.size(); ++cut) {
    const auto row = static_cast<Eigen::Index>(cut);
    for (std::size_t k = 0; k < observable_count; ++k) slopes_[k].row(row) += (curvatures_[k][cut] * step).transpose();
    std::vector<Run>& runs = runs_[cut];
    const bool same = base_.usable[cut] && other.usable[cut] && base_.runs[cut].branch == other.runs[cut].branch;
    if (!same) {
      runs.clear();
      has_slopes_[cut] = false;
      told_.row(row).setConstant(QuadraticResponse::any_slope);
    } else {
      const Eigen::RowVectorXd shift = model_scale(other.simulated.row(row)) - model_scale(predicted.row(row));
      for (Run& run : runs) {
        run.scaled += shift;
        run.borrowed = true;
      }
    }
    if (other.usable[cut]) add(cut, other.point, other.runs[cut], other.simulated.row(row));
  }
  base_ = other;
  fresh_ = false;
}

CutMask LocalModel::at_jump(const std::function<bool(const Eigen::VectorXd&)>& allowed) const {
  const auto is_near = [&](const Run& run) {
    return (run.point - base_.point).lpNorm<Eigen::Infinity>() <= 1.001 * choice_.step || allowed(run.point);
  };
  CutMask found(runs_.size(), false);
  for (std::size_t cut = 0; cut < runs_.size(); ++cut)
    if (base_.usable[cut])
      found[cut] = std::any_of(runs_[cut].begin(), runs_[cut].end(),
                               [&](const Run& run) { return run.branch != base_.runs[cut].branch && is_near(run); });
  return found;
}

LocalModel LocalModel::scaled(const Eigen::MatrixXd& share) const {
  LocalModel result = *this;
  for (Eigen::MatrixXd& slopes : result.slopes_) slopes *= share;
  for (std::vector<Eigen::MatrixXd>& curvatures : result.curvatures_)
    for (Eigen::MatrixXd& bend : curvatures) bend = share.transpose() * bend * share;
  return result;
}

void LocalModel::move_to(const Evaluation& other) {
  if (other.point != base_.point) fresh_ = false;
  base_ = other;
  learn(other);
}

Eigen::MatrixXd LocalModel::slope_covariance(Eigen::Index cut, Eigen::Index observable) const {
  const auto of = [&](Eigen::Index one_of, double value) -> Eigen::MatrixXd {
    const auto k = static_cast<std::size_t>(one_of);
    const auto heard = (!silent_[k].row(cut).array()).cast<double>().matrix();
    return value * value * heard.asDiagonal() * rough_covariances_[k][static_cast<std::size_t>(cut)] *
           heard.asDiagonal();
  };
  const Eigen::MatrixXd own = of(observable, unit(base_, cut, observable));
  // What is modelled as a ratio to F_c has the errors of both.
  return observable == F_t ? own + of(F_c, base_.simulated(cut, F_t)) : own;
}

bool LocalModel::branches_differ(const Evaluation& a, const Evaluation& b) {
  for (std::size_t cut = 0; cut < a.runs.size(); ++cut)
    if (a.usable[cut] && b.usable[cut] && a.runs[cut].branch != b.runs[cut].branch) return true;
  return false;
}

Eigen::MatrixXd residual_slopes(const LocalModel& model, const Misfit& misfit, const Eigen::VectorXd& point,
                                double edge_force) {
  const double tiny = 1e-5;
  const Eigen::Index n = point.size();
  const CutMask known = model.known();
  Eigen::MatrixXd columns(misfit.residual_count(), n + (misfit.edge_force() ? 1 : 0));
  const auto residuals = [&](const Eigen::VectorXd& at, double edge) {  // projecting F_b out would hide its column
    return misfit.residuals_with(edge, model.predict(at), at, known);
  };
  for (Eigen::Index j = 0; j < n; ++j) {
    Eigen::VectorXd above = point, below = point;
    above[j] += tiny;
    below[j] -= tiny;
    columns.col(j) = (residuals(above, edge_force) - residuals(below, edge_force)) / (2 * tiny);
  }
  if (misfit.edge_force()) columns.col(n) = residuals(point, edge_force + 1) - residuals(point, edge_force);
  return columns;
}

}  // namespace kerf::inverse
