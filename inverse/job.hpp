#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "models/base/document.hpp"
#include "models/base/estimate.hpp"

namespace kerf::inverse {

/// What a measured cut and a simulated cut are compared by.
enum class Observable : std::size_t { F_c, F_t, chip_ratio, chip_curvature, resistance };
inline constexpr std::size_t observable_count = 5;
inline constexpr std::array<const char*, observable_count> observable_names{"F_c", "F_t", "chip_ratio",
                                                                            "chip_curvature", "G_R"};
/// Unit in which each is shown.
inline constexpr std::array<const char*, observable_count> observable_units{"N/m", "N/m", "1", "1/mm", "J/m^2"};
/// Forces, thickness and resistance keep their sign and are compared to simulations on a logarithmic scale of the
/// model; the transverse force and the curvature may pass through zero.
constexpr bool is_positive(std::size_t observable) {
  return observable == static_cast<std::size_t>(Observable::F_c) ||
         observable == static_cast<std::size_t>(Observable::chip_ratio) ||
         observable == static_cast<std::size_t>(Observable::resistance);
}

/// One measured point of a curve: a cut, or what the pull on a specimen shows at one extension of its crack, of which
/// one simulation gives all points. An observable that was not measured, or that the job does not use, is absent.
struct MeasuredCut {
  std::size_t curve = 0;                 ///< index into Job::curves
  std::size_t row = 0;                   ///< line of the point in its file
  double depth = 0;                      ///< mm
  double rake = 0;                       ///< rad
  std::optional<double> extension = {};  ///< of a specimen's crack, mm
  std::string specimen;                  ///< that was cut; its curve's name when none is named
  double specimen_error = 0;             ///< share by which everything measured on this specimen is off together
  std::array<std::optional<Estimate>, observable_count> measured;  ///< N/mm, N/mm, 1, 1/mm, N/mm
};

/// A number of the scene that the calibration is to find.
struct FreeParameter {
  std::string path;               ///< dotted path into the scene
  std::string name;               ///< short name in results
  std::string unit;               ///< unit in which it is shown, as the scene declares it
  double lower = 0, upper = 0;    ///< consistent units
  bool logarithmic = true;        ///< searched in ln(value); otherwise in value / (upper - lower)
  std::optional<double> start;    ///< consistent units; without it a closed form is asked
  std::optional<Estimate> prior;  ///< what is known of it beforehand, a normal distribution; consistent units
  bool key = false;               ///< the job has failed (exit code 6) when this one cannot be identified
};

/// path = factor * of, for every cut: strengths that follow the yield stress.
struct Tie {
  std::string path;
  double factor = 1;
  std::string of;
};

/// A quantity that follows from the parameters: a sum of products of their powers, in consistent units.
struct DerivedQuantity {
  struct Term {
    double factor = 1;
    std::vector<double> powers;  ///< of the free parameters, in their order
  };
  std::string name, unit, expression;
  std::vector<Term> terms;

  /// `values` of the free parameters; T is double or an automatic derivative.
  template <class T>
  T of(const std::vector<T>& values) const {
    using std::pow;
    T sum(0.0);
    for (const Term& term : terms) {
      T product(term.factor);
      for (std::size_t j = 0; j < values.size(); ++j)
        if (term.powers[j] != 0) product *= pow(values[j], term.powers[j]);
      sum += product;
    }
    return sum;
  }
};

/// How much of the edge force F_b appears in F_c: nothing, or its Coulomb friction mu F_b (theory, Eq. (1)).
enum class CuttingShare { none, friction };
const char* name(CuttingShare share);

/// A force F_b per unit width on the edge of the real tool that the simulated, sharp tool does not feel:
/// F_t = F_t(simulated) + F_b, F_c = F_c(simulated) + share F_b. It enters linearly and costs no runs.
struct EdgeForce {
  CuttingShare cutting_share = CuttingShare::none;
  double lower = 0, upper = std::numeric_limits<double>::infinity();  ///< N/mm
  bool compare = false;                                               ///< also fit and report the other share
};

struct Budget {
  std::size_t max_runs = 100;
  int parallel = 2;
  double tolerance = 0.02;      ///< decrease of chi^2 that is not worth another run
  double failing_share = 0.34;  ///< of the cuts at the estimate; above it the calibration has failed (exit code 5)
  double time_out = 10;         ///< of a run, in medians of the finished runs of its cut, but ...
  double shortest_time_out = 60, first_time_out = 3600;  ///< s; ... at least this, and that while none has finished
  std::string backend = "local";                         ///< see find_backend
  std::string shared_runs;                               ///< a folder (see SharedRuns), given by the caller; or empty
};

struct OptimiserChoice {
  std::string method = "gauss_newton";
  double step = 0.04;        ///< of a difference, in search coordinates (ln(value), or the share of a linear range)
  double noise = 0.001;      ///< relative roughness of a simulated force; smaller decreases are not believed
  double roughness = 0.001;  ///< the part of it that two neighbouring points do not share: of a difference
  bool central = false;      ///< two-sided differences
  bool confirm = true;       ///< a search ends on sure slopes only; a coarse one, checked by fine runs, need not
  bool audit = false;        ///< measure both before the search; what the job gives itself stays
  bool step_given = false, noise_given = false;
  bool noise_measured = false;  ///< by the audit, so that a run's own standard error says nothing more
};

/// What a search of several fidelities looks at first: the scene with cheaper numbers, or a closed form.
struct Coarse {
  bool closed_form = false;
  Document scene;
};

/// Another numerical choice (mesh, speed, damping) under which the estimates are asked for once they are found.
struct NumericsChoice {
  std::string name;
  Document scene;
};

/// A file the job depends on: its name as the job writes it, and its bytes.
struct InputFile {
  std::string name;
  std::string content;
  std::string hash() const;
};

/// One [[curve]] of a job.
struct MeasuredCurve {
  InputFile file;
  std::vector<std::string> changes;        ///< of the scene for its cuts, PATH=VALUE
  std::optional<InputFile> specimen_file;  ///< an R-curve's own scene ...
  std::optional<Document> specimen;        ///< ... which coarse runs and other numerics leave as it is
};

/// A calibration, fully read: nothing in it depends on the file system any more.
struct Job {
  std::string title;
  InputFile source, scene_file;
  std::vector<MeasuredCurve> curves;
  std::vector<MeasuredCut> cuts;
  Document scene;  ///< the base scene
  std::vector<FreeParameter> free;
  std::vector<Tie> ties;
  std::vector<DerivedQuantity> derived;
  std::vector<Observable> observables;
  std::optional<EdgeForce> edge_force;
  Budget budget;
  OptimiserChoice optimiser;
  Coarse coarse;
  std::vector<NumericsChoice> numerics;
  bool verify = false;      ///< simulate the ends of the 95 % intervals where the budget covers them, and learn
  int posterior_moves = 0;  ///< of every walker in the posterior; 0: no sampling
  double discrepancy = 0;   ///< relative error that the model is granted in every observable

  /// SHA-256 of everything that decides the answer.
  std::string identity() const;
};

/// Every block a job may hold, with its parameters.
const std::vector<Block>& job_blocks();

/// Where a file lies that a job (or the caller) names; used to read a job again from the copies in its folder.
using Locate = std::function<std::filesystem::path(const std::string& name)>;

/// Reads a job with its scene and its curves; paths in it are relative to the job's own folder. Every patched scene is
/// read once, so that a wrong path, tie or bound is found before the first run. Throws InputError.
Job read_job(const std::filesystem::path& file);
Job read_job(const std::filesystem::path& file, const std::string& name, const Locate& locate);

}  // namespace kerf::inverse
