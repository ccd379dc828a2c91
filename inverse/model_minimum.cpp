#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "inverse/local_model.hpp"

namespace kerf::inverse {
namespace {

constexpr double stiffness = 1e5;  // of a held quantity: chi^2 follows it to a share of about 1e-4

/// Weighted residuals of the model; the parameter blocks are the coordinates, one by one, and F_b last.
struct ModelResiduals {
  const LocalModel& model;
  const Misfit& misfit;
  const ParameterSpace& space;
  const Restriction& restriction;
  CutMask known;

  template <class T>
  T value(const T* const* point, std::size_t j) const {
    using std::exp;
    const FreeParameter& parameter = space.parameters()[j];
    return parameter.logarithmic ? exp(point[j][0]) : point[j][0] * (parameter.upper - parameter.lower);
  }

  template <class T>
  T friction(const T* const* point) const {
    const Eigen::Index j = space.friction_index();
    return j < 0 ? T(space.friction(model.base().point)) : value(point, static_cast<std::size_t>(j));
  }

  template <class T>
  T share(Eigen::Index observable, const T& friction) const {
    if (!misfit.edge_force() || observable >= static_cast<Eigen::Index>(Observable::chip_ratio)) return T(0.0);
    if (observable == static_cast<Eigen::Index>(Observable::F_t)) return T(1.0);
    return misfit.edge_force()->cutting_share == CuttingShare::friction ? friction : T(0.0);
  }

  Eigen::Index count() const { return misfit.residual_count() + (restriction.held ? 1 : 0); }

  template <class T>
  bool operator()(T const* const* blocks, T* residuals) const {
    const Observations& weights = misfit.weights();
    const T mu = friction(blocks);
    const T edge_force = blocks[space.dimension()][0];
    for (Eigen::Index i = 0; i < weights.rows(); ++i)
      for (Eigen::Index k = 0; k < weights.cols(); ++k) {
        T& residual = residuals[i * weights.cols() + k];
        if (weights(i, k) == 0 || !known[static_cast<std::size_t>(i)])
          residual = T(0.0);
        else
          residual =
              (model.predict(i, k, blocks) + share(k, mu) * edge_force - misfit.measured()(i, k)) * weights(i, k);
      }
    misfit.whiten(known, residuals);
    if (!restriction.multiplicity.empty())
      for (Eigen::Index i = 0; i < weights.size(); ++i)
        residuals[i] *= std::sqrt(restriction.multiplicity[static_cast<std::size_t>(i / weights.cols())]);

    std::vector<T> values;
    for (std::size_t j = 0; j < space.parameters().size(); ++j) values.push_back(value(blocks, j));
    misfit.add_priors(values, residuals + weights.size());
    if (restriction.held)
      residuals[misfit.residual_count()] = stiffness * (restriction.held->of(values) / restriction.held_value - 1.0);
    return true;
  }
};

}  // namespace

ModelMinimum minimise(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                      const Eigen::VectorXd& start, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                      const Restriction& restriction) {
  CutMask known = model.known();
  for (std::size_t cut = 0; cut < restriction.multiplicity.size(); ++cut)
    known[cut] = known[cut] && restriction.multiplicity[cut] > 0;
  const std::optional<double> fixed_edge = restriction.fixed_edge;
  ModelMinimum minimum{.point = start.cwiseMax(lower).cwiseMin(upper), .edge_force = 0, .chi2 = 0};
  minimum.edge_force =
      fixed_edge ? *fixed_edge : misfit.residuals(model.predict(minimum.point), minimum.point, known).edge_force;

  auto* functor = new ModelResiduals{model, misfit, space, restriction, known};  // owned by the cost, and this
  auto* cost = new ceres::DynamicAutoDiffCostFunction<ModelResiduals>(functor);  // by the problem
  std::vector<double*> blocks;
  for (Eigen::Index j = 0; j < space.dimension(); ++j) blocks.push_back(&minimum.point[j]);
  blocks.push_back(&minimum.edge_force);
  for (std::size_t b = 0; b < blocks.size(); ++b) cost->AddParameterBlock(1);
  cost->SetNumResiduals(static_cast<int>(functor->count()));

  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, blocks);
  for (Eigen::Index j = 0; j < space.dimension(); ++j) {
    double* block = blocks[static_cast<std::size_t>(j)];
    if (j == restriction.fixed || lower[j] >= upper[j]) {
      problem.SetParameterBlockConstant(block);
    } else {
      problem.SetParameterLowerBound(block, 0, lower[j]);
      problem.SetParameterUpperBound(block, 0, upper[j]);
    }
  }
  if (!misfit.edge_force() || fixed_edge) {
    problem.SetParameterBlockConstant(&minimum.edge_force);
  } else {
    problem.SetParameterLowerBound(&minimum.edge_force, 0, misfit.edge_force()->lower);
    problem.SetParameterUpperBound(&minimum.edge_force, 0, misfit.edge_force()->upper);
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  minimum.point = minimum.point.cwiseMax(lower).cwiseMin(upper);
  minimum.chi2 = 2 * summary.final_cost;
  return minimum;
}

}  // namespace kerf::inverse
