#include "inverse/calibration.hpp"

#include <algorithm>

#include "inverse/seen_slopes.hpp"
#include "inverse/start.hpp"
#include "inverse/statement.hpp"

namespace kerf::inverse {
namespace {

std::string assumption(const Misfit& misfit) {
  if (!misfit.edge_force()) return "no force on the tool's edge";
  return misfit.edge_force()->cutting_share == CuttingShare::friction ? "edge force with Coulomb friction in F_c"
                                                                      : "edge force without a part in F_c";
}

CuttingShare other(CuttingShare share) {
  return share == CuttingShare::friction ? CuttingShare::none : CuttingShare::friction;
}

/// What a search found, with errors if its slopes are known or the budget still covers them.
Fit conclude(const Job& job, const Objective& objective, SearchResult found) {
  Fit fit{.assumption = assumption(objective.misfit()),
          .share = {},
          .at = std::move(found.best),
          .residuals = {},
          .residual_errors = objective.misfit().residual_errors(),
          .identifiability = {},
          .error_budget = {},
          .fitted_errors = {},
          .at_jump = {},
          .resampling = {},
          .posterior = {},
          .model = {},
          .converged = found.converged,
          .reason = std::move(found.reason)};
  if (objective.misfit().edge_force()) fit.share = objective.misfit().edge_force()->cutting_share;
  fit.residuals = objective.misfit().residuals(fit.at);
  if (!found.model) return fit;
  const Misfit& misfit = objective.misfit();
  fit.model = seen_slopes(*found.model, misfit);
  const LocalModel& model = *fit.model;
  fit.identifiability = identify(model, misfit, objective.space(), job.derived);
  const double allowed = fit.identifiability.chi2 + fit.identifiability.allowed_rise();
  fit.at_jump = model.at_jump([&](const Eigen::VectorXd& point) {
    return misfit.residuals(model.predict(point), point, model.known()).chi2 <= allowed;
  });
  add_profiles(fit.identifiability, model, misfit, objective.space(), job.derived);
  fit.error_budget = error_budget(fit.identifiability, misfit, model.known());
  fit.fitted_errors = fitted_errors(fit.identifiability, model, misfit, objective.space());
  fit.resampling = resample(model, misfit, objective.space(), job);
  if (job.posterior_moves > 0)
    fit.posterior =
        sample_posterior(model, misfit, objective.space(), job.derived, fit.identifiability, job.posterior_moves);
  return fit;
}

class Calibrator {
 public:
  Calibrator(const Job& job, RunDatabase& database, const std::function<void(const TraceEntry&)>& on_trace)
      : job_(job), space_(job), misfit_(job, space_), objective_(job, space_, misfit_, database, job.budget.max_runs) {
    objective_.on_trace = on_trace;
  }

  Calibration run() {
    try {
      return complete();
    } catch (const Interrupted&) {
      if (!objective_.best()) throw;
      return stop();
    }
  }

 private:
  Calibration complete() {
    const Start start = find_start(job_, space_);
    result_.start = start.point;
    result_.start_origin = start.origin;
    Evaluation first = evaluate_start(start.point);
    if (objective_.failing_share(first) > job_.budget.failing_share) return give_up(std::move(first));
    misfit_.include_simulation_errors(first);
    if (job_.optimiser.audit) audit(first);
    result_.choice = objective_.choice();

    // Differences at the end, which errors may want, and the checks are paid for in advance.
    const std::size_t reserve = job_.cuts.size() * (job_.free.size() + job_.numerics.size());
    const std::size_t all = job_.budget.max_runs;
    objective_.limit(all > 3 * reserve ? all - reserve : all);
    SearchResult found = find_optimiser(job_.optimiser.method).search(objective_, first);
    objective_.limit(all);
    complete_slopes(found);
    result_.fit = conclude(job_, objective_, found);
    if (found.model && job_.verify) {
      learn_ends(*found.model);
      result_.fit = conclude(job_, objective_, found);
    }
    const std::optional<LocalModel> model = std::move(found.model);
    if (model && job_.edge_force && job_.edge_force->compare) compare(*model);
    if (result_.fit.model) result_.numerics = check_numerics(job_, objective_, *result_.fit.model);
    if (model && job_.verify) verify(*model);

    result_.trace = objective_.trace();
    result_.failing_share = objective_.failing_share(result_.fit.at);
    result_.exit_code = judge_all();
    result_.statement = state(job_, result_);
    return std::move(result_);
  }

  /// Whatever was known when the user stopped the search: the fit itself, if only its alternatives are missing.
  Calibration stop() {
    if (result_.fit.at.point.size() == 0)
      result_.fit =
          conclude(job_, objective_,
                   {.best = *objective_.best(), .converged = false, .reason = "stopped before the end", .model = {}});
    result_.partial = true;
    result_.trace = objective_.trace();
    result_.failing_share = objective_.failing_share(result_.fit.at);
    result_.exit_code = ExitCode::interrupted;
    result_.statement = state(job_, result_);
    return std::move(result_);
  }

  /// Measures what the simulation resolves, if that takes no more than a quarter of the budget.
  void audit(const Evaluation& first) {
    const std::size_t all = job_.budget.max_runs;
    objective_.limit(first.runs.size() + all / 4);
    try {
      result_.audit = audit_noise(objective_, first);
      OptimiserChoice choice = job_.optimiser;
      if (!choice.step_given) choice.step = result_.audit->step;
      if (!choice.noise_given) {
        choice.noise = result_.audit->noise;
        choice.roughness = result_.audit->roughness.value_or(choice.noise);
        choice.noise_measured = result_.audit->measured;
      }
      objective_.choose(choice);
      objective_.trace("noise audit", first);
    } catch (const BudgetSpent&) {
      result_.audit.reset();
    }
    objective_.limit(all);
  }

  /// The start, or the middle of the ranges when too many cuts fail there.
  Evaluation evaluate_start(const Eigen::VectorXd& point) {
    Evaluation first = objective_.evaluate(point);
    objective_.trace("start", first);
    if (objective_.failing_share(first) <= job_.budget.failing_share) return first;
    const Eigen::VectorXd middle = 0.5 * (space_.lower() + space_.upper());
    if (middle == point) return first;
    Evaluation second = objective_.evaluate(middle);
    objective_.trace("start in the middle of the ranges", second);
    if (count(second.usable) <= count(first.usable)) return first;
    result_.start = middle;
    result_.start_origin += "; then the middle of all ranges, because simulations failed there";
    return second;
  }

  Calibration give_up(Evaluation at) {
    result_.failing_share = objective_.failing_share(at);
    result_.fit = conclude(job_, objective_,
                           {.best = std::move(at),
                            .converged = false,
                            .reason = "too many simulated cuts fail at the start",
                            .model = {}});
    result_.trace = objective_.trace();
    result_.exit_code = ExitCode::too_many_failed_runs;
    result_.statement = state(job_, result_);
    return std::move(result_);
  }

  void complete_slopes(SearchResult& found) {
    try {
      if (!found.model || found.model->base().point != found.best.point)
        found.model = LocalModel(found.best, objective_.choice());
      if (found.model->is_sure(objective_)) return;
      found.model->difference(objective_);
      objective_.trace("differences", found.best);
    } catch (const BudgetSpent&) {
      if (count(found.model->known()) == 0) found.model.reset();
    }
  }

  /// The simulations do not know what the edge does: the other assumption starts from the same slopes.
  void compare(const LocalModel& model) {
    Misfit misfit = misfit_.with_share(other(job_.edge_force->cutting_share));
    std::swap(misfit, misfit_);
    try {
      objective_.trace("other edge assumption", model.base());
      SearchResult found = gauss_newton(objective_, model);
      complete_slopes(found);
      result_.alternatives.push_back(conclude(job_, objective_, std::move(found)));
    } catch (...) {
      std::swap(misfit, misfit_);
      throw;
    }
    std::swap(misfit, misfit_);
    widen_verdicts();
  }

  /// A parameter that depends on the assumption is known no better than over all of them.
  void widen_verdicts() {
    Identifiability& known = result_.fit.identifiability;
    for (std::vector<ParameterEstimate>* all : {&known.parameters, &known.derived})
      for (ParameterEstimate& p : *all)
        p.verdict = judge(p.value, p.standard_error, over_all_assumptions(result_, p.name), p.bounds);
  }

  /// Simulates the ends of the intervals once, no farther away than the model reaches, and lets the model know: over
  /// steps as long as the data leave a parameter uncertain, a slope stands out of the roughness that blurs it over a
  /// difference step. Where the data set no end, the parameter alone takes the longest step.
  void learn_ends(LocalModel& model) {
    constexpr double longest = 0.9 * LocalModel::reach;
    const Eigen::VectorXd& base = model.base().point;
    const std::vector<ParameterEstimate>& parameters = result_.fit.identifiability.parameters;
    std::vector<std::pair<std::string, Eigen::VectorXd>> ends;
    for (std::size_t k = 0; k < parameters.size(); ++k)
      for (const bool upper : {false, true}) {
        const std::optional<ProfileEnd>& end = upper ? parameters[k].upper_end : parameters[k].lower_end;
        const auto j = static_cast<Eigen::Index>(k);
        if (!end && j >= base.size()) continue;  // the edge force needs no slope
        Eigen::VectorXd step =
            end ? Eigen::VectorXd(end->point - base)
                : Eigen::VectorXd(Eigen::VectorXd::Unit(base.size(), j) * (upper ? 1 : -1) * longest);
        if (step.norm() > longest) step *= longest / step.norm();
        ends.emplace_back(parameters[k].name, (base + step).cwiseMax(space_.lower()).cwiseMin(space_.upper()));
      }
    try {
      for (const auto& [name, point] : ends) {
        const Evaluation there = objective_.evaluate(point);
        objective_.trace("towards the end of the interval of " + name, there);
        model.learn(there);
      }
    } catch (const BudgetSpent&) {
      // What was learnt counts; verify() says which ends it did not get to.
    }
  }

  /// Simulates every end of an interval that the budget still covers, over the cuts that the model knows.
  void verify(const LocalModel& model) {
    Identifiability& known = result_.fit.identifiability;
    try {
      for (std::vector<ParameterEstimate>* all : {&known.parameters, &known.derived})
        for (ParameterEstimate& p : *all)
          for (std::optional<ProfileEnd>* end : {&p.lower_end, &p.upper_end}) {
            if (!*end) continue;
            const Evaluation there = objective_.evaluate((*end)->point);
            objective_.trace("end of the interval of " + p.name, there);
            for (std::size_t cut = 0; cut < there.usable.size(); ++cut)
              if (there.usable[cut] && there.runs[cut].branch != model.base().runs[cut].branch)
                result_.fit.at_jump[cut] = true;
            // A cut that fails there would lower chi^2 by being absent.
            if (both(there.usable, model.known()) == model.known())
              (*end)->simulated = misfit_.chi2(there, model.known());
          }
    } catch (const BudgetSpent&) {
      // The ends without a simulation say so.
    }
  }

  ExitCode judge_all() const {
    if (result_.failing_share > job_.budget.failing_share) return ExitCode::too_many_failed_runs;
    if (!result_.fit.converged) return ExitCode::not_converged;
    for (const ParameterEstimate& parameter : result_.fit.identifiability.parameters)
      if (parameter.key && parameter.verdict != Verdict::measured) return ExitCode::not_identifiable;
    return ExitCode::success;
  }

  const Job& job_;
  ParameterSpace space_;
  Misfit misfit_;
  Objective objective_;
  Calibration result_;
};

}  // namespace

Interval over_all_assumptions(const Calibration& calibration, const std::string& name) {
  Interval all = calibration.fit.identifiability.find(name)->interval;
  for (const Fit& fit : calibration.alternatives) {
    const ParameterEstimate* other = fit.identifiability.find(name);
    if (!other) continue;
    all = {std::min(all.lower, other->interval.lower), std::max(all.upper, other->interval.upper)};
  }
  return all;
}

Calibration calibrate(const Job& job, RunDatabase& database, const std::function<void(const TraceEntry&)>& on_trace) {
  return Calibrator(job, database, on_trace).run();
}

}  // namespace kerf::inverse
