#include "inverse/noise_audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf::inverse {
namespace {

constexpr std::size_t cuts_per_audited = 12;
constexpr int table_points = 7;         // the base included: six differences, three estimates beyond the first orders
constexpr double table_spacing = 2e-3;  // of a search coordinate; smooth parts of third order are then below 1e-8
constexpr double wide = 0.1;            // half width of the second difference that measures curvature
constexpr std::array jitters{1.0 / 12, 1.0 / 6};  // depths of cut: a third and two thirds of a cell of a four-cell chip
constexpr double least_step = 0.02, largest_step = 0.15;
constexpr double least_noise = 1e-6, largest_noise = 0.1;

/// Indices of the cuts to audit: the middles of equal parts of the list by depth, as far as they are usable. A
/// specimen cannot be begun a fraction of a cell farther on: its notch is what was measured.
std::vector<std::size_t> audited(const Objective& objective, const Evaluation& base) {
  std::vector<std::size_t> by_depth;
  for (std::size_t cut = 0; cut < objective.cuts(); ++cut)
    if (base.usable[cut] && !objective.job().cuts[cut].extension) by_depth.push_back(cut);
  std::stable_sort(by_depth.begin(), by_depth.end(),
                   [&](std::size_t a, std::size_t b) { return objective.depth(a) < objective.depth(b); });
  const std::size_t parts = (by_depth.size() + cuts_per_audited - 1) / cuts_per_audited;
  std::vector<std::size_t> chosen;
  for (std::size_t p = 0; p < parts; ++p) chosen.push_back(by_depth[(2 * p + 1) * by_depth.size() / (2 * parts)]);
  return chosen;
}

/// Coordinates alternately up and down, because everything up at once scales a cut and bends nothing; each on the side
/// where the bounds leave room for the whole table and on both sides for the wide difference.
Eigen::VectorXd direction(const ParameterSpace& space, const Eigen::VectorXd& point) {
  Eigen::VectorXd line(point.size());
  for (Eigen::Index j = 0; j < point.size(); ++j) {
    const double above = space.upper()[j] - point[j], below = point[j] - space.lower()[j];
    const double room = std::min(1.0, std::max(above, below) / (table_points * table_spacing));
    const double sign = j % 2 == 0 ? 1 : -1;
    line[j] = room * ((sign > 0 ? above : below) >= table_points * table_spacing ? sign : above >= below ? 1 : -1);
  }
  return line;
}

class Auditor {
 public:
  Auditor(Objective& objective, const Evaluation& base)
      : objective_(objective), base_(base), line_(direction(objective.space(), base.point)) {}

  NoiseAudit audit() {
    const std::vector<std::size_t> cuts = audited(objective_, base_);
    std::vector<Objective::Probe> probes;
    for (const std::size_t cut : cuts) add_probes(cut, probes);
    const std::vector<RunRecord> runs = objective_.simulate(probes);
    const std::size_t each = cuts.empty() ? 0 : runs.size() / cuts.size();
    for (std::size_t c = 0; c < cuts.size(); ++c)
      judge(cuts[c], {runs.begin() + static_cast<std::ptrdiff_t>(c * each),
                      runs.begin() + static_cast<std::ptrdiff_t>((c + 1) * each)});
    result_.runs = runs.size();
    conclude();
    return std::move(result_);
  }

 private:
  Eigen::VectorXd at(double distance) const { return objective_.space().clamp(base_.point + distance * line_); }

  void add_probes(std::size_t cut, std::vector<Objective::Probe>& probes) const {
    for (int i = 1; i < table_points; ++i) probes.push_back({at(i * table_spacing), cut});
    probes.push_back({at(wide), cut});
    probes.push_back({at(-wide), cut});
    for (const double jitter : jitters) probes.push_back({base_.point, cut, jitter});
  }

  /// Values of one observable as shares; empty when a run is not comparable with the base.
  std::vector<double> shares(std::size_t cut, Eigen::Index k, const std::vector<RunRecord>& runs, std::size_t from,
                             std::size_t count) const {
    const auto row = static_cast<Eigen::Index>(cut);
    const double unit = typical_size(base_.simulated, row, k);
    std::vector<double> values{base_.simulated(row, k) / unit};
    for (std::size_t i = from; i < from + count; ++i) {
      if (!objective_.misfit().is_usable(cut, runs[i]) || runs[i].branch != base_.runs[cut].branch) return {};
      values.push_back(objective_.misfit().observations(cut, runs[i])[k] / unit);
    }
    return values;
  }

  void judge(std::size_t cut, const std::vector<RunRecord>& runs) {
    const std::size_t in_table = table_points - 1;
    for (Eigen::Index k = 0; k < base_.simulated.cols(); ++k) {
      if (objective_.misfit().weights()(static_cast<Eigen::Index>(cut), k) == 0) continue;
      ObservableNoise entry;
      entry.cut = cut;
      entry.observable = static_cast<Observable>(k);
      if (const auto values = shares(cut, k, runs, 0, in_table); !values.empty()) {
        entry.table = ecnoise(values);
        entry.noise = entry.table->noise;
      }
      if (const auto values = shares(cut, k, runs, in_table, 2); !values.empty()) {
        const double above = (at(wide) - base_.point).lpNorm<Eigen::Infinity>();
        const double below = (at(-wide) - base_.point).lpNorm<Eigen::Infinity>();
        if (above > 0.5 * wide && below > 0.5 * wide)
          entry.curvature =
              std::abs(2 * ((values[1] - values[0]) / above - (values[0] - values[2]) / below) / (above + below));
      }
      if (const auto values = shares(cut, k, runs, in_table + 2, jitters.size()); !values.empty()) {
        const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
        double squares = 0;
        for (const double value : values) squares += (value - mean) * (value - mean);
        entry.jitter = std::sqrt(squares / static_cast<double>(values.size() - 1));
        entry.noise = std::max(entry.noise, *entry.jitter);
      }
      if (entry.noise > 0 && entry.curvature && *entry.curvature > 0)
        entry.step = 1.68 * std::sqrt(entry.noise / *entry.curvature);
      result_.observables.push_back(entry);
    }
  }

  void conclude() {
    std::optional<double> step;
    for (const ObservableNoise& entry : result_.observables) {
      if (entry.step) step = std::max(step.value_or(0), *entry.step);
      if (entry.observable == Observable::chip_ratio || (!entry.table && !entry.jitter)) continue;
      result_.measured = true;
      result_.noise = std::max(result_.noise, entry.noise);
      if (entry.table) result_.roughness = std::max(result_.roughness.value_or(0), entry.table->noise);
    }
    result_.noise =
        result_.measured ? std::clamp(result_.noise, least_noise, largest_noise) : objective_.choice().noise;
    result_.step = step ? std::clamp(*step, least_step, largest_step) : objective_.choice().step;
    result_.note =
        result_.measured
            ? fmt::format("a simulated force is rough by {:.2g} of its value, a difference takes a step of {:.2g}",
                          result_.noise, result_.step)
            : "no replicate could be compared; step and noise stay as assumed";
  }

  Objective& objective_;
  const Evaluation& base_;
  Eigen::VectorXd line_;
  NoiseAudit result_;
};

}  // namespace

NoiseAudit audit_noise(Objective& objective, const Evaluation& base) {
  return Auditor(objective, base).audit();
}

}  // namespace kerf::inverse
