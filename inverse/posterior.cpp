#include "inverse/posterior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace kerf::inverse {
namespace {

constexpr double stretch = 2;  // a of Goodman & Weare
constexpr double in_window = 5;

/// Search coordinates, then F_b.
class Density {
 public:
  Density(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space, const Identifiability& known)
      : model_(model), misfit_(misfit), mask_(model.known()), known_(known), coordinates_(space.dimension()) {
    const Eigen::Index all = coordinates_ + (misfit.edge_force() ? 1 : 0);
    lower_.resize(all);
    upper_.resize(all);
    lower_.head(coordinates_) = space.lower();
    upper_.head(coordinates_) = space.upper();
    if (misfit.edge_force()) {
      lower_[coordinates_] = misfit.edge_force()->lower;
      upper_[coordinates_] = misfit.edge_force()->upper;
    }
  }

  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }

  double logarithm(const Eigen::VectorXd& at) const {
    if ((at.array() < lower_.array()).any() || (at.array() > upper_.array()).any())
      return -std::numeric_limits<double>::infinity();
    const Eigen::VectorXd point = at.head(coordinates_);
    const double edge = at.size() > coordinates_ ? at[coordinates_] : 0;
    const double chi2 = misfit_.residuals_with(edge, model_.predict(point), point, mask_).squaredNorm();
    if (known_.error_scale <= 1) return -0.5 * chi2;
    return -0.5 * static_cast<double>(known_.degrees_of_freedom + at.size()) * std::log(chi2);
  }

 private:
  const LocalModel& model_;
  const Misfit& misfit_;
  CutMask mask_;
  const Identifiability& known_;
  Eigen::Index coordinates_;
  Eigen::VectorXd lower_, upper_;
};

/// 1 + 2 sum of autocorrelations, over a window of five times the result (Sokal); `chains` are time x walkers.
double autocorrelation_time(const Eigen::MatrixXd& chains) {
  const Eigen::MatrixXd centred = chains.array() - chains.mean();
  const double variance = centred.squaredNorm() / static_cast<double>(centred.size());
  if (!(variance > 0)) return 1;
  double time = 1;
  for (Eigen::Index lag = 1; lag < chains.rows() / 2; ++lag) {
    const Eigen::Index pairs = chains.rows() - lag;
    const double covariance = centred.topRows(pairs).cwiseProduct(centred.bottomRows(pairs)).sum() /
                              static_cast<double>(pairs * chains.cols());
    time += 2 * covariance / variance;
    if (static_cast<double>(lag) > in_window * time) break;
  }
  return std::max(1.0, time);
}

/// Walkers about the estimate, a tenth of a standard error (or of the range) apart.
std::vector<Eigen::VectorXd> begin(const Density& density, const ParameterSpace& space, const Identifiability& known,
                                   const Eigen::VectorXd& centre, std::size_t walkers, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd width = 0.1 * (density.upper() - density.lower());
  for (Eigen::Index j = 0; j < centre.size(); ++j) {
    const ParameterEstimate& p = known.parameters[static_cast<std::size_t>(j)];
    const double in_coordinate = j < space.dimension() ? space.slope(j, centre[j]) : 1;
    const double error = 0.1 * p.standard_error / std::abs(in_coordinate);
    if (!(width[j] <= error)) width[j] = error;  // also where the range has no end
  }
  std::vector<Eigen::VectorXd> all;
  while (all.size() < walkers) {
    Eigen::VectorXd at = centre;
    for (Eigen::Index j = 0; j < at.size(); ++j)
      at[j] = std::clamp(at[j] + width[j] * normal(random), density.lower()[j], density.upper()[j]);
    all.push_back(std::move(at));
  }
  return all;
}

}  // namespace

Posterior sample_posterior(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space,
                           const std::vector<DerivedQuantity>& derived, const Identifiability& known, int moves,
                           std::uint64_t seed) {
  const Density density(model, misfit, space, known);
  const Eigen::Index n = space.dimension(), all = density.lower().size();
  Eigen::VectorXd centre(all);
  centre.head(n) = model.base().point;
  if (all > n) centre[n] = known.parameters.back().value;

  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  const std::size_t walkers = static_cast<std::size_t>(std::max<Eigen::Index>(32, 6 * all));
  std::vector<Eigen::VectorXd> at = begin(density, space, known, centre, walkers, random);
  std::vector<double> height;
  height.reserve(walkers);
  for (const Eigen::VectorXd& walker : at) height.push_back(density.logarithm(walker));

  const int before = std::max(1, moves / 5);
  std::vector<Eigen::MatrixXd> chains(static_cast<std::size_t>(all), Eigen::MatrixXd(moves, walkers));
  std::size_t taken = 0;
  for (int move = -before; move < moves; ++move)
    for (std::size_t w = 0; w < walkers; ++w) {
      // Partners come from the other half, whose places do not change meanwhile.
      const std::size_t half = walkers / 2, first = w < half ? half : 0;
      const std::size_t others = w < half ? walkers - half : half;
      const auto drawn = static_cast<std::size_t>(uniform(random) * static_cast<double>(others));
      const Eigen::VectorXd& partner = at[first + std::min(drawn, others - 1)];
      const double z = std::pow(1 + (stretch - 1) * uniform(random), 2) / stretch;
      Eigen::VectorXd proposed = partner + z * (at[w] - partner);
      const double reached = density.logarithm(proposed);
      const double gain = static_cast<double>(all - 1) * std::log(z) + reached - height[w];
      if (std::log(uniform(random)) < gain) {
        at[w] = std::move(proposed);
        height[w] = reached;
        if (move >= 0) ++taken;
      }
      if (move >= 0)
        for (Eigen::Index j = 0; j < all; ++j)
          chains[static_cast<std::size_t>(j)](move, static_cast<Eigen::Index>(w)) = at[w][j];
    }

  Posterior posterior;
  posterior.acceptance = static_cast<double>(taken) / (static_cast<double>(moves) * static_cast<double>(walkers));
  for (const Eigen::MatrixXd& chain : chains)
    posterior.autocorrelation_time = std::max(posterior.autocorrelation_time, autocorrelation_time(chain));

  const auto columns = all + static_cast<Eigen::Index>(derived.size());
  posterior.draws.resize(static_cast<Eigen::Index>(moves) * static_cast<Eigen::Index>(walkers), columns);
  for (Eigen::Index row = 0; row < posterior.draws.rows(); ++row) {
    Eigen::VectorXd coordinates(all);
    for (Eigen::Index j = 0; j < all; ++j) coordinates[j] = chains[static_cast<std::size_t>(j)].data()[row];
    const Eigen::VectorXd values = space.values(coordinates.head(n));
    posterior.draws.row(row).head(n) = values.transpose();
    if (all > n) posterior.draws(row, n) = coordinates[n];
    for (std::size_t q = 0; q < derived.size(); ++q)
      posterior.draws(row, all + static_cast<Eigen::Index>(q)) =
          derived[q].of(std::vector<double>(values.begin(), values.end()));
  }
  for (Eigen::Index c = 0; c < columns; ++c) {
    Eigen::VectorXd sorted = posterior.draws.col(c);
    std::sort(sorted.begin(), sorted.end());
    const auto quantile = [&](double share) {
      return sorted[static_cast<Eigen::Index>(share * static_cast<double>(sorted.size() - 1))];
    };
    posterior.intervals.push_back({quantile(0.025), quantile(0.975)});
  }
  return posterior;
}

}  // namespace kerf::inverse
