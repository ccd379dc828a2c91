#include "inverse/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "models/base/units.hpp"

namespace kerf::inverse {
namespace {

class Resampler {
 public:
  Resampler(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space, const Job& job)
      : model_(model), misfit_(misfit), space_(space), job_(job), known_(model.known()) {}

  /// How often every cut counts when `counts(cut)` says so; nothing when no data are left to fit.
  template <class Counts>
  std::optional<std::vector<double>> estimate(const Counts& counts) const {
    Restriction restriction;
    double left = 0;
    for (std::size_t cut = 0; cut < job_.cuts.size(); ++cut) {
      restriction.multiplicity.push_back(counts(cut));
      left += known_[cut] ? restriction.multiplicity.back() : 0;
    }
    if (left == 0) return std::nullopt;
    const ModelMinimum found =
        minimise(model_, misfit_, space_, model_.base().point, space_.lower(), space_.upper(), restriction);
    const Eigen::VectorXd point = space_.values(found.point);
    std::vector<double> values(point.begin(), point.end());
    std::vector<double> result = values;
    if (misfit_.edge_force()) result.push_back(found.edge_force);
    for (const DerivedQuantity& quantity : job_.derived) result.push_back(quantity.of(values));
    return result;
  }

  std::vector<std::string> specimens() const {
    std::set<std::string> names;
    for (std::size_t cut = 0; cut < job_.cuts.size(); ++cut)
      if (known_[cut]) names.insert(job_.cuts[cut].specimen);
    return {names.begin(), names.end()};
  }

  const Job& job() const { return job_; }
  bool known(std::size_t cut) const { return known_[cut]; }

 private:
  const LocalModel& model_;
  const Misfit& misfit_;
  const ParameterSpace& space_;
  const Job& job_;
  CutMask known_;
};

Bootstrap bootstrap(const Resampler& resampler, const std::vector<std::string>& specimens, int draws) {
  Bootstrap result{.specimens = static_cast<int>(specimens.size()), .draws = 0, .standard_deviations = {}};
  std::mt19937_64 random(1);
  std::vector<double> sum, squares;
  for (int draw = 0; draw < draws; ++draw) {
    std::map<std::string, double> drawn;
    // The engine alone is the same everywhere; a distribution of the standard library is not.
    for (std::size_t i = 0; i < specimens.size(); ++i) drawn[specimens[random() % specimens.size()]] += 1;
    const auto values = resampler.estimate([&](std::size_t cut) { return drawn[resampler.job().cuts[cut].specimen]; });
    if (!values) continue;
    sum.resize(values->size());
    squares.resize(values->size());
    for (std::size_t j = 0; j < values->size(); ++j) {
      sum[j] += (*values)[j];
      squares[j] += (*values)[j] * (*values)[j];
    }
    ++result.draws;
  }
  for (std::size_t j = 0; j < sum.size(); ++j) {
    const double mean = sum[j] / result.draws;
    result.standard_deviations.push_back(std::sqrt(std::max(0.0, squares[j] / result.draws - mean * mean)));
  }
  return result;
}

}  // namespace

Resampling resample(const LocalModel& model, const Misfit& misfit, const ParameterSpace& space, const Job& job,
                    int draws) {
  const Resampler resampler(model, misfit, space, job);
  Resampling result;
  const auto add = [](std::vector<LeftOut>& to, std::string what, std::optional<std::vector<double>> values) {
    if (values) to.push_back({std::move(what), std::move(*values)});
  };
  for (std::size_t left_out = 0; left_out < job.cuts.size(); ++left_out)
    if (resampler.known(left_out))
      add(result.without_cut,
          fmt::format("depth {:.4g} mm, rake {:.4g} deg", job.cuts[left_out].depth,
                      job.cuts[left_out].rake / consistent_units_in("deg")),
          resampler.estimate([&](std::size_t cut) { return cut == left_out ? 0.0 : 1.0; }));
  const std::vector<std::string> specimens = resampler.specimens();
  if (specimens.size() < 2) return result;
  for (const std::string& left_out : specimens)
    add(result.without_specimen, left_out,
        resampler.estimate([&](std::size_t cut) { return job.cuts[cut].specimen == left_out ? 0.0 : 1.0; }));
  if (specimens.size() >= 4) result.bootstrap = bootstrap(resampler, specimens, draws);
  return result;
}

}  // namespace kerf::inverse
