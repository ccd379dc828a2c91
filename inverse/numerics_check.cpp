#include "inverse/numerics_check.hpp"

namespace kerf::inverse {
namespace {

/// Values of all parameters (F_b last where the job has one), then of the derived quantities.
std::vector<double> estimates(const Job& job, const ParameterSpace& space, const ModelMinimum& at) {
  const Eigen::VectorXd values = space.values(at.point);
  std::vector<double> all(values.begin(), values.end());
  const std::vector<double> free = all;
  if (job.edge_force) all.push_back(at.edge_force);
  for (const DerivedQuantity& quantity : job.derived) all.push_back(quantity.of(free));
  return all;
}

}  // namespace

std::vector<NumericsShift> check_numerics(const Job& job, Objective& objective, const LocalModel& model) {
  const Misfit& misfit = objective.misfit();
  const auto minimum = [&](const LocalModel& about, const CutMask& compared) {
    std::vector<double> once;
    for (const bool cut : compared) once.push_back(cut ? 1 : 0);
    const ParameterSpace& space = objective.space();
    return minimise(about, misfit, space, about.base().point, space.lower(), space.upper(), {.multiplicity = once});
  };

  std::vector<NumericsShift> all;
  for (const NumericsChoice& choice : job.numerics) {
    Job other = job;
    other.scene = choice.scene;
    const ParameterSpace space(other);
    Misfit own = misfit;
    Objective simulated(other, space, own, objective.database(), objective.limit());
    simulated.fidelity = choice.name + ", ";
    const std::size_t before = objective.database().runs();
    try {
      const Evaluation there = simulated.evaluate(model.base().point);
      objective.trace("numerics: " + choice.name, model.base());
      CutMask compared = both(model.known(), there.usable);
      for (std::size_t cut = 0; cut < compared.size(); ++cut)
        compared[cut] = compared[cut] && there.runs[cut].branch == model.base().runs[cut].branch;
      NumericsShift shift{
          .name = choice.name, .cuts = count(compared), .runs = objective.database().runs() - before, .shifts = {}};
      if (shift.cuts > 0) {
        LocalModel moved = model;
        moved.borrow_for(there);
        const ModelMinimum here = minimum(model, compared), found = minimum(moved, compared);
        shift.chi2 = found.chi2;
        shift.shifts = estimates(job, objective.space(), found);
        const std::vector<double> without = estimates(job, objective.space(), here);
        for (std::size_t i = 0; i < without.size(); ++i) shift.shifts[i] -= without[i];
      }
      all.push_back(std::move(shift));
    } catch (const BudgetSpent&) {
      continue;
    }
  }
  return all;
}

}  // namespace kerf::inverse
