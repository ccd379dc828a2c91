#include "inverse/seen_slopes.hpp"

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "inverse/identifiability.hpp"

namespace kerf::inverse {
namespace {

constexpr double by_chance = 0.999;  // share of the parameters which act on nothing that are called unseen

}  // namespace

LocalModel seen_slopes(const LocalModel& model, const Misfit& misfit) {
  const Eigen::Index n = model.base().point.size(), data = misfit.weights().size();
  const Residuals here = misfit.residuals(model.base().simulated, model.base().point, model.known());
  const Eigen::MatrixXd all = residual_slopes(model, misfit, model.base().point, here.edge_force).topRows(data);
  Eigen::MatrixXd jacobian = all.leftCols(n);
  if (misfit.edge_force()) {
    const Eigen::VectorXd edge = all.col(n);
    if (edge.squaredNorm() > 0) jacobian -= edge * (edge.transpose() * jacobian) / edge.squaredNorm();
  }

  Eigen::MatrixXd feigned = Eigen::MatrixXd::Zero(n, n);
  int compared = 0;
  for (Eigen::Index i = 0; i < misfit.weights().rows(); ++i)
    for (Eigen::Index k = 0; k < misfit.weights().cols(); ++k) {
      const double weight = misfit.weights()(i, k);
      if (weight == 0 || !model.known()[static_cast<std::size_t>(i)]) continue;
      ++compared;
      const double unit = weight * (LocalModel::is_logarithmic(k) ? model.base().simulated(i, k) : 1);
      feigned += unit * unit * model.slope_covariance(i, k);
    }
  const double largest = compared == 0 ? 0 : feigned.diagonal().maxCoeff();
  if (largest == 0) return model;                // slopes that are exact
  feigned.diagonal().array() += 1e-9 * largest;  // a parameter that acts on nothing

  const boost::math::chi_squared errors_alone(compared);
  const double reached = boost::math::quantile(errors_alone, by_chance) / compared;
  const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(information, feigned);
  Eigen::VectorXd share(n);
  for (Eigen::Index c = 0; c < n; ++c) {
    const double lambda = solver.eigenvalues()[c];
    share[c] = lambda > reached ? std::sqrt(1 - 1 / lambda) : 0;
  }
  const Eigen::MatrixXd& u = solver.eigenvectors();  // u^T D u = 1
  return model.scaled(u * share.asDiagonal() * u.transpose() * feigned);
}

}  // namespace kerf::inverse
