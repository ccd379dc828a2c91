#pragma once

#include <array>
#include <filesystem>

#include "inverse/local_model.hpp"
#include "tests/unit/synthetic_cut.hpp"

namespace kerf::testing {

/// Everything that a local model of a job's cuts needs.
struct ModelledCut {
  ModelledCut(const inverse::Job& of, const std::filesystem::path& file,
              const inverse::Simulator& simulator = synthetic_cut)
      : job(of),
        space(job),
        misfit(job, space),
        journal(file),
        database(journal, "test", simulator, 2),
        objective(job, space, misfit, database, 1000000) {}

  /// Yield stress, toughness and friction of the curve in curve_text, and a strength that nothing shows.
  Eigen::VectorXd truth() const {
    Eigen::VectorXd point(space.dimension());
    for (Eigen::Index j = 0; j < point.size(); ++j)
      point[j] = space.coordinate(j, std::array{60.0, 2.0, 0.3, 40.0}.at(static_cast<std::size_t>(j)));
    return point;
  }
  inverse::LocalModel about(const Eigen::VectorXd& there) {
    return inverse::LocalModel::by_differences(objective, objective.evaluate(there));
  }

  inverse::Job job;
  inverse::ParameterSpace space;
  inverse::Misfit misfit;
  inverse::Journal journal;
  inverse::RunDatabase database;
  inverse::Objective objective;
};

}  // namespace kerf::testing
