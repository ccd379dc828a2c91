#include "inverse/optimiser.hpp"

#include <algorithm>
#include <stdexcept>

namespace kerf::inverse {

const std::vector<Optimiser>& optimisers() {
  static const std::vector<Optimiser> all{
      // bounded Gauss-Newton in a trust region; differences and trials in parallel, few runs
      {"gauss_newton", gauss_newton},
      // Gauss-Newton on coarse runs ([coarse]) corrected to fine ones; last steps on fine runs only
      {"multi_fidelity", multi_fidelity},
      // multistart on quadratics fitted over the whole box; its best minima simulated, then gauss_newton
      {"surrogate", surrogate},
      // Ceres' bounded Levenberg-Marquardt with parallel differences at every step
      {"levenberg_marquardt", levenberg_marquardt},
      {"bobyqa", bobyqa},  // NLopt: quadratic models of chi^2, no differences
      {"sbplx", sbplx},    // NLopt: simplex search on subspaces, patient with noise
      {"crs2", crs2},      // NLopt's controlled random search: global, and dear
      {"mlsl", mlsl},      // NLopt's multi-level single linkage with BOBYQA: every basin once; global, and dear
  };
  return all;
}

std::vector<std::string> optimiser_names() {
  std::vector<std::string> names;
  for (const Optimiser& optimiser : optimisers()) names.push_back(optimiser.name);
  return names;
}

const Optimiser& find_optimiser(const std::string& name) {
  const auto found = std::find_if(optimisers().begin(), optimisers().end(),
                                  [&](const Optimiser& optimiser) { return optimiser.name == name; });
  if (found == optimisers().end()) throw std::invalid_argument("there is no optimiser \"" + name + "\"");
  return *found;
}

}  // namespace kerf::inverse
