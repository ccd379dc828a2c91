#pragma once

#include <optional>
#include <string>
#include <vector>

#include "inverse/local_model.hpp"
#include "inverse/objective.hpp"

namespace kerf::inverse {

/// Where a search ended.
struct SearchResult {
  Evaluation best;
  bool converged = false;
  std::string reason;               ///< why it stopped, in words
  std::optional<LocalModel> model;  ///< slopes about `best`, when the search has them
};

/// A search for the smallest misfit. It sees simulations only through the objective, keeps no state elsewhere and asks
/// no clock, so that replaying it on a journal gives the same answer. A failed run never becomes a residual.
struct Optimiser {
  std::string name;
  SearchResult (*search)(Objective& objective, const Evaluation& start);
};

SearchResult gauss_newton(Objective& objective, const Evaluation& start);
/// Continues from slopes that are known already, such as those of another misfit of the same cuts.
SearchResult gauss_newton(Objective& objective, const LocalModel& model);
/// Coarse runs corrected to the fine ones do the search; fine runs check it, take the last steps and give the slopes.
SearchResult multi_fidelity(Objective& objective, const Evaluation& start);
/// Quadratics over the whole box, many starts on them, the best minima simulated, then gauss_newton.
SearchResult surrogate(Objective& objective, const Evaluation& start);
SearchResult levenberg_marquardt(Objective& objective, const Evaluation& start);
SearchResult bobyqa(Objective& objective, const Evaluation& start);
SearchResult sbplx(Objective& objective, const Evaluation& start);
SearchResult crs2(Objective& objective, const Evaluation& start);
SearchResult mlsl(Objective& objective, const Evaluation& start);

/// All of them; adding one is adding a file and a line.
const std::vector<Optimiser>& optimisers();
std::vector<std::string> optimiser_names();
const Optimiser& find_optimiser(const std::string& name);

}  // namespace kerf::inverse
