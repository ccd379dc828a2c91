#include <nlopt.hpp>

#include <cmath>
#include <exception>
#include <optional>

#include "inverse/optimiser.hpp"

namespace kerf::inverse {
namespace {

/// chi^2 as NLopt wants it: a number at every point, infinite where a run failed. NLopt turns exceptions into a bare
/// "failure" and forgets them, so the first one is kept here and thrown again outside.
class ScalarMisfit {
 public:
  ScalarMisfit(Objective& objective, const Evaluation& start) : objective_(objective), best_(start) {
    best_chi2_ = complete(start) ? objective_.misfit().residuals(start).chi2 : HUGE_VAL;
  }

  double at(const std::vector<double>& coordinates, nlopt::opt& search) {
    if (failure_ || spent_) return HUGE_VAL;
    try {
      const Eigen::Map<const Eigen::VectorXd> point(coordinates.data(), static_cast<Eigen::Index>(coordinates.size()));
      const Evaluation evaluation = objective_.evaluate(objective_.space().clamp(point));
      if (!complete(evaluation)) {
        objective_.trace("failed", evaluation);
        return HUGE_VAL;
      }
      const double chi2 = objective_.misfit().residuals(evaluation).chi2;
      objective_.trace(chi2 < best_chi2_ ? "better" : "worse", evaluation);
      if (chi2 < best_chi2_) {
        best_ = evaluation;
        best_chi2_ = chi2;
      }
      return chi2;
    } catch (const BudgetSpent&) {
      spent_ = true;
    } catch (...) {
      failure_ = std::current_exception();
    }
    search.force_stop();
    return HUGE_VAL;
  }

  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  bool spent() const { return spent_; }
  const Evaluation& best() const { return best_; }

 private:
  static bool complete(const Evaluation& evaluation) { return count(evaluation.usable) == evaluation.usable.size(); }

  Objective& objective_;
  Evaluation best_;
  double best_chi2_ = HUGE_VAL;
  bool spent_ = false;
  std::exception_ptr failure_;
};

/// A global search that never ends by itself: it is given so many evaluations per parameter and one.
struct Inner {
  nlopt::algorithm local;
  int evaluations_each;
};

SearchResult search_with(nlopt::algorithm algorithm, Objective& objective, const Evaluation& start,
                         std::optional<Inner> inner = {}) {
  const ParameterSpace& space = objective.space();
  const auto vector = [](const Eigen::VectorXd& x) { return std::vector<double>(x.data(), x.data() + x.size()); };
  nlopt::srand(1);  // the random searches repeat themselves exactly, which is what makes replay possible
  nlopt::opt search(algorithm, static_cast<unsigned>(space.dimension()));
  ScalarMisfit misfit(objective, start);
  struct Context {
    ScalarMisfit& misfit;
    nlopt::opt& search;
  } context{misfit, search};
  search.set_min_objective(
      [](const std::vector<double>& x, std::vector<double>&, void* data) {
        auto& [scalar, opt] = *static_cast<Context*>(data);
        return scalar.at(x, opt);
      },
      &context);
  search.set_lower_bounds(vector(space.lower()));
  search.set_upper_bounds(vector(space.upper()));
  search.set_initial_step(5 * objective.choice().step);
  // Without slopes, one small step says little about what is left: these tolerances are far below the answer's error.
  search.set_ftol_abs(objective.budget().tolerance / 100);
  search.set_xtol_abs(objective.choice().step / 100);
  if (inner) {
    nlopt::opt local(inner->local, static_cast<unsigned>(space.dimension()));
    local.set_ftol_abs(objective.budget().tolerance);
    local.set_xtol_abs(objective.choice().step / 10);
    local.set_initial_step(5 * objective.choice().step);
    search.set_local_optimizer(local);
    search.set_population(4);
    search.set_maxeval(inner->evaluations_each * static_cast<int>(space.dimension() + 1));
  }
  std::vector<double> point = vector(start.point);
  double chi2 = 0;
  nlopt::result outcome = nlopt::FAILURE;
  try {
    outcome = search.optimize(point, chi2);
  } catch (const nlopt::forced_stop&) {
    outcome = nlopt::FORCED_STOP;
  } catch (const nlopt::roundoff_limited&) {
    outcome = nlopt::XTOL_REACHED;  // steps below the rounding of the coordinates: as near as numbers come
  } catch (const std::runtime_error&) {
    outcome = nlopt::FAILURE;
  }
  misfit.rethrow();
  const bool converged = !misfit.spent() && outcome > 0 && (inner || outcome != nlopt::MAXEVAL_REACHED);
  return {.best = misfit.best(),
          .converged = converged,
          .reason = misfit.spent()       ? "the budget of runs is spent"
                    : inner && converged ? "the evaluations that a search of all basins is given are used up"
                    : converged          ? "the search's steps no longer change the misfit"
                                         : "the search failed",
          .model = {}};
}

}  // namespace

SearchResult bobyqa(Objective& objective, const Evaluation& start) {
  return search_with(nlopt::LN_BOBYQA, objective, start);
}

SearchResult sbplx(Objective& objective, const Evaluation& start) {
  return search_with(nlopt::LN_SBPLX, objective, start);
}

SearchResult crs2(Objective& objective, const Evaluation& start) {
  return search_with(nlopt::GN_CRS2_LM, objective, start);
}

SearchResult mlsl(Objective& objective, const Evaluation& start) {
  return search_with(nlopt::G_MLSL_LDS, objective, start, Inner{.local = nlopt::LN_BOBYQA, .evaluations_each = 100});
}

}  // namespace kerf::inverse
