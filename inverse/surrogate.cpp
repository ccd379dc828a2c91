#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <numeric>
#include <vector>

#include "inverse/optimiser.hpp"

namespace kerf::inverse {
namespace {

constexpr int starts = 64;           // of searches on the surrogate, which cost nothing
constexpr std::size_t verified = 3;  // of its minima, by simulation
constexpr double distinct = 0.1;     // search coordinates between two minima that count as two
constexpr double points_per_term = 1.5;

/// The i-th point of Halton's sequence (1960), spread evenly whatever the number of points; at most eight coordinates.
Eigen::VectorXd halton(int i, Eigen::Index dimension) {
  constexpr std::array primes{2, 3, 5, 7, 11, 13, 17, 19};
  Eigen::VectorXd point(dimension);
  for (Eigen::Index j = 0; j < dimension; ++j) {
    const int base = primes[static_cast<std::size_t>(j) % primes.size()];
    double share = 1, value = 0;
    for (int rest = i; rest > 0; rest /= base) value += (share /= base) * (rest % base);
    point[j] = value;
  }
  return point;
}

/// ln F_c, F_t and ln(chip ratio) of every cut as quadratics of the search coordinates, by least squares over the
/// simulated points; a cut that failed or changed branch at a point is left out there, and with too few points left is
/// left out altogether.
class Quadratic {
 public:
  Quadratic(const ParameterSpace& space, const std::vector<Evaluation>& points)
      : space_(space), known_(points.front().usable.size(), true) {
    coefficients_.resize(known_.size() * observable_count);
    for (std::size_t cut = 0; cut < known_.size(); ++cut) fit(cut, points);
  }

  static Eigen::Index terms(Eigen::Index n) { return (n + 1) * (n + 2) / 2; }
  const CutMask& known() const { return known_; }

  Observations predict(const Eigen::VectorXd& point) const {
    const Eigen::VectorXd row = monomials(point);
    Observations result = Observations::Zero(static_cast<Eigen::Index>(known_.size()), observable_count);
    for (Eigen::Index i = 0; i < result.rows(); ++i)
      for (Eigen::Index k = 0; k < result.cols(); ++k) {
        const Eigen::VectorXd& c = coefficients_[static_cast<std::size_t>(i * result.cols() + k)];
        if (c.size() == 0) continue;
        result(i, k) = LocalModel::is_logarithmic(k) ? std::exp(c.dot(row)) : c.dot(row);
      }
    return result;
  }

 private:
  Eigen::VectorXd monomials(const Eigen::VectorXd& point) const {
    const Eigen::VectorXd x =
        (2 * point - space_.lower() - space_.upper()).cwiseQuotient(space_.upper() - space_.lower());
    Eigen::VectorXd row(terms(x.size()));
    Eigen::Index at = 0;
    row[at++] = 1;
    for (Eigen::Index a = 0; a < x.size(); ++a) {
      row[at++] = x[a];
      for (Eigen::Index b = 0; b <= a; ++b) row[at++] = x[a] * x[b];
    }
    return row;
  }

  void fit(std::size_t cut, const std::vector<Evaluation>& points) {
    std::vector<const Evaluation*> used;
    for (const auto branch : {forward::Branch::touching, forward::Branch::bending}) {
      std::vector<const Evaluation*> on_branch;
      for (const Evaluation& point : points)
        if (point.usable[cut] && point.runs[cut].branch == branch) on_branch.push_back(&point);
      if (on_branch.size() > used.size()) used = std::move(on_branch);
    }
    const Eigen::Index n = terms(space_.dimension()), rows = static_cast<Eigen::Index>(used.size());
    if (rows < n) {
      known_[cut] = false;
      return;
    }
    Eigen::MatrixXd design(rows, n);
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(rows, observable_count);
    for (Eigen::Index p = 0; p < rows; ++p) {
      const Evaluation& point = *used[static_cast<std::size_t>(p)];
      design.row(p) = monomials(point.point).transpose();
      for (Eigen::Index k = 0; k < values.cols(); ++k) {
        const double value = point.simulated(static_cast<Eigen::Index>(cut), k);
        values(p, k) = !LocalModel::is_logarithmic(k) ? value : value > 0 ? std::log(value) : 0;
      }
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(design);
    for (Eigen::Index k = 0; k < values.cols(); ++k)
      coefficients_[cut * observable_count + static_cast<std::size_t>(k)] = solver.solve(values.col(k));
  }

  const ParameterSpace& space_;
  CutMask known_;
  std::vector<Eigen::VectorXd> coefficients_;  ///< cut by cut, observable by observable
};

struct Candidate {
  Eigen::VectorXd point;
  double chi2;
};

/// Minima of the surrogate's misfit from many starts, best first, those too near to a better one left out.
std::vector<Candidate> minima(const Quadratic& surrogate, const Objective& objective) {
  const ParameterSpace& space = objective.space();
  struct Context {
    const Quadratic& surrogate;
    const Misfit& misfit;
  } context{surrogate, objective.misfit()};
  const auto vector = [](const Eigen::VectorXd& x) { return std::vector<double>(x.data(), x.data() + x.size()); };
  nlopt::opt search(nlopt::LN_BOBYQA, static_cast<unsigned>(space.dimension()));
  search.set_min_objective(
      [](const std::vector<double>& x, std::vector<double>&, void* data) {
        const auto& [model, misfit] = *static_cast<Context*>(data);
        const Eigen::VectorXd point = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
        const double chi2 = misfit.residuals(model.predict(point), point, model.known()).chi2;
        return std::isfinite(chi2) ? chi2 : 1e30;
      },
      &context);
  search.set_lower_bounds(vector(space.lower()));
  search.set_upper_bounds(vector(space.upper()));
  search.set_initial_step(0.1);
  search.set_xtol_abs(1e-4);
  search.set_maxeval(2000);
  std::vector<Candidate> all;
  for (int i = 1; i <= starts; ++i) {
    const Eigen::VectorXd share = halton(i, space.dimension());
    std::vector<double> x = vector(space.lower() + share.cwiseProduct(space.upper() - space.lower()));
    double chi2 = 0;
    try {
      search.optimize(x, chi2);
    } catch (const nlopt::roundoff_limited&) {  // as near as numbers come
    } catch (const std::runtime_error&) {
      continue;
    }
    all.push_back({Eigen::Map<const Eigen::VectorXd>(x.data(), space.dimension()), chi2});
  }
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.chi2 < b.chi2; });
  std::vector<Candidate> kept;
  for (const Candidate& candidate : all) {
    const auto near = [&](const Candidate& other) {
      return (other.point - candidate.point).lpNorm<Eigen::Infinity>() < distinct;
    };
    if (std::none_of(kept.begin(), kept.end(), near)) kept.push_back(candidate);
    if (kept.size() == verified) break;
  }
  return kept;
}

}  // namespace

SearchResult surrogate(Objective& objective, const Evaluation& start) {
  const ParameterSpace& space = objective.space();
  Evaluation best = start;
  try {
    std::vector<Eigen::VectorXd> design;
    const int count =
        static_cast<int>(std::ceil(points_per_term * static_cast<double>(Quadratic::terms(space.dimension()))));
    for (int i = 1; i <= count; ++i)
      design.push_back(space.lower() + halton(i, space.dimension()).cwiseProduct(space.upper() - space.lower()));
    std::vector<Evaluation> points = objective.evaluate(design);
    objective.trace("design for the surrogate", points.front());
    points.push_back(start);
    const Quadratic model(space, points);
    std::vector<Eigen::VectorXd> trials;
    for (const Candidate& candidate : minima(model, objective)) trials.push_back(candidate.point);
    for (const Evaluation& trial : objective.evaluate(trials)) points.push_back(trial);
    for (const Evaluation& point : points) {
      const CutMask common = both(best.usable, point.usable);
      if (inverse::count(common) < inverse::count(best.usable)) continue;
      if (objective.misfit().chi2(point, common) < objective.misfit().chi2(best, common)) best = point;
    }
    objective.trace("best of the surrogate's minima", best);
  } catch (const BudgetSpent&) {
    return {.best = best, .converged = false, .reason = "the budget of runs is spent", .model = {}};
  }
  return gauss_newton(objective, best);
}

}  // namespace kerf::inverse
