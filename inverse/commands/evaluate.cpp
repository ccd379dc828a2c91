#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "inverse/child_runs.hpp"
#include "inverse/commands/commands.hpp"
#include "inverse/commands/interrupt.hpp"
#include "inverse/commands/stop.hpp"
#include "inverse/dakota.hpp"
#include "inverse/folder.hpp"
#include "inverse/objective.hpp"
#include "models/base/atomic_file.hpp"
#include "models/base/error.hpp"
#include "models/base/parameter.hpp"
#include "models/base/units.hpp"

namespace kerf::commands {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string parameters, results, job, shared_runs;
  int parallel = 0;
};

/// The point of the parameter space that the driver asks about, in the units in which the job's results are given.
Eigen::VectorXd point_of(const inverse::DakotaRequest& request, const inverse::ParameterSpace& space,
                         const Options& options) {
  std::vector<std::string> names;
  for (const inverse::FreeParameter& p : space.parameters()) names.push_back(p.name);
  for (const auto& [name, value] : request.variables)
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      const auto near = nearest(name, names);
      throw InputError(fmt::format("{}: \"{}\" is no free parameter of {}{}", options.parameters, name, options.job,
                                   near ? fmt::format("; did you mean \"{}\"?", *near) : ""));
    }
  Eigen::VectorXd point(space.dimension());
  for (Eigen::Index j = 0; j < space.dimension(); ++j) {
    const inverse::FreeParameter& p = space.parameters()[static_cast<std::size_t>(j)];
    const auto given = std::find_if(request.variables.begin(), request.variables.end(),
                                    [&](const auto& variable) { return variable.first == p.name; });
    if (given == request.variables.end())
      throw InputError(
          fmt::format("{}: has no value for \"{}\", a free parameter of {}", options.parameters, p.name, options.job));
    const double one = consistent_units_in(p.unit), value = given->second * one;
    constexpr double rounding = 1e-9;
    if (value < p.lower * (1 - rounding) || value > p.upper * (1 + rounding))
      throw InputError(fmt::format("{}: {} = {:g} {} is outside {:g} ... {:g}", options.parameters, p.name,
                                   given->second, p.unit, p.lower / one, p.upper / one));
    point[j] = space.coordinate(j, value);
  }
  return space.clamp(point);
}

/// The weighted residuals of all measured values, or chi^2 if the driver wants a single number.
std::vector<double> answer(const inverse::DakotaRequest& request, const inverse::Misfit& misfit,
                           const inverse::Evaluation& at, const Options& options) {
  const inverse::Residuals residuals = misfit.residuals(at);
  std::vector<double> values;
  for (Eigen::Index i = 0; i < misfit.weights().rows(); ++i)
    for (Eigen::Index k = 0; k < misfit.weights().cols(); ++k)
      if (misfit.weights()(i, k) != 0) values.push_back(residuals.weighted[i * misfit.weights().cols() + k]);
  if (request.functions.size() == values.size()) return values;
  if (request.functions.size() == 1) return {residuals.chi2};
  throw InputError(
      fmt::format("{}: asks for {} functions; {} has {} measured values (calibration terms), or 1 for chi2",
                  options.parameters, request.functions.size(), options.job, values.size()));
}

ExitCode evaluate(const Options& options) {
  inverse::Job job = inverse::read_job(options.job);
  if (options.parallel > 0) job.budget.parallel = options.parallel;
  const inverse::ParameterSpace space(job);
  inverse::Misfit misfit(job, space);
  const inverse::DakotaRequest request =
      inverse::read_dakota_request(read_file(options.parameters), options.parameters);
  const Eigen::VectorXd point = point_of(request, space, options);

  const StopOnInterrupt guard;
  const fs::path folder = options.results + ".runs";
  const Stop stop(folder, 0);
  inverse::ChildRuns runs(inverse::run_command(), folder, job.budget, [&] { return stop.reason() != nullptr; });
  inverse::Journal journal(folder / "journal.jsonl");
  inverse::RunDatabase database(journal, inverse::code_identity(), std::ref(runs), job.budget.parallel);
  if (!options.shared_runs.empty()) database.share(options.shared_runs);
  inverse::Objective objective(job, space, misfit, database, job.cuts.size());
  try {
    const inverse::Evaluation at = objective.evaluate(point);
    std::string text = "FAIL\n";
    const bool complete = inverse::count(at.usable) == job.cuts.size();
    if (complete) text = inverse::dakota_results(request, answer(request, misfit, at, options));
    for (std::size_t cut = 0; cut < job.cuts.size(); ++cut)
      if (!at.usable[cut])
        fmt::print(stderr, "the cut at depth {:.4g} mm failed: {}\n", job.cuts[cut].depth,
                   at.runs[cut].refusals.empty() ? "no reason given" : at.runs[cut].refusals.front());
    write_atomically(options.results, text);
    fs::remove_all(folder);
    return complete ? ExitCode::success : ExitCode::too_many_failed_runs;
  } catch (const inverse::Interrupted&) {
    fmt::print(stderr, "interrupted; {} keeps what was finished for another `kerf evaluate`\n", folder.string());
    return ExitCode::interrupted;
  }
}

}  // namespace

void add_evaluate(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("evaluate", "Residuals of a job at given parameters, for an external driver");
  command->add_option("parameters", options->parameters, "parameters file (Dakota: standard or aprepro)")->required();
  command->add_option("results", options->results, "results file (Dakota)")->required();
  command->add_option("--job", options->job, "job file (TOML)")->required();
  command->add_option("--runs", options->shared_runs, "folder of runs shared by jobs: none is made twice");
  command->add_option("-j,--jobs,--parallel", options->parallel, "simulations at a time")->check(CLI::PositiveNumber);
  command->footer(
      "Variables are the job's free parameters by name, in the units of its results. Functions are the weighted\n"
      "residuals of all measured values, cut by cut (Dakota's calibration terms), or chi2 if one is asked for.\n"
      "Exit code 5: a cut failed; the results file then says FAIL.");
  command->callback([options, &exit_code] { exit_code = static_cast<int>(evaluate(*options)); });
}

}  // namespace kerf::commands
