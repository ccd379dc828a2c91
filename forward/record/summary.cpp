#include "forward/record/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "forward/effects/heat.hpp"
#include "forward/record/statistics.hpp"

namespace kerf::forward {
namespace {

/// Of a quantity of the samples from `from` on, by their travel: least squares.
template <class Quantity>
double slope(const std::vector<ForceSample>& history, std::size_t from, const Quantity& quantity) {
  const double n = static_cast<double>(history.size() - from);
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = from; i < history.size(); ++i) {
    const double travel = history[i].travel - history[from].travel, value = quantity(history[i]);
    x += travel;
    y += value;
    xx += travel * travel;
    xy += travel * value;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

template <class Samples, class Member>
std::vector<double> series(const Samples& samples, Member member) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const auto& sample : samples) values.push_back(sample.*member);
  return values;
}

/// First crossing that may count: the ramp is over and the tool has cut half a depth of unbroken material.
std::size_t earliest(const Scene& scene) {
  const double ramp_travel = 0.5 * scene.cut.speed * scene.cut.ramp;
  const double travel = ramp_travel + (0.5 + scene.cut.notch) * scene.cut.depth;
  return static_cast<std::size_t>(std::ceil(travel / scene.cell_length()));
}

struct SteadyPart {
  std::size_t from;
  bool steady;
  std::optional<Swing> swing = {};  ///< of the force about its steady value

  Estimate mean(std::span<const double> of) const { return level(of.subspan(from), swing); }
  bool knows(std::span<const double> force, double tolerance) const {
    const Estimate of_force = mean(force);
    return steady && of_force.standard_error < tolerance * std::abs(of_force.value);
  }
};

/// Two depths at least, whose halves agree to 1 %, or, where friction makes the force wander, to twice the scatter of
/// their difference but never worse than 3 %.
bool is_steady(std::span<const double> force, const Scene& scene) {
  if (static_cast<double>(force.size()) * scene.cell_length() < 1.999 * scene.cut.depth) return false;
  const Estimate first = batch_mean(force.first(force.size() / 2)), second = batch_mean(force.last(force.size() / 2));
  const double mean = std::abs(batch_mean(force).value);
  const double scatter = 2.0 * std::hypot(first.standard_error, second.standard_error);
  return std::abs(first.value - second.value) < std::clamp(scatter, 0.01 * mean, 0.03 * mean);
}

SteadyPart plain_steady_part(std::span<const double> whole, const Scene& scene) {
  const std::size_t truncated = truncation_point(whole, earliest(scene));
  if (truncated == whole.size()) return {truncated, false};
  // The truncation point sits deep in a quiet record: whatever before it has the same mean counts as well.
  const double settled = batch_mean(whole.subspan(truncated)).value;
  std::size_t from = truncated;
  while (from > earliest(scene) &&
         std::abs(batch_mean(whole.subspan(from - 1)).value - settled) < 0.002 * std::abs(settled))
    --from;
  // A slow run-in, as friction makes it, may take up to half of the record.
  const std::size_t middle = std::max(truncated, whole.size() / 2);
  for (const std::size_t start : {from, truncated, middle})
    if (is_steady(whole.subspan(start), scene)) return {start, true};
  return {from, false};
}

/// The chip remembers the curvature that its root was given, and comes down on the rake face with it a crack lead
/// later: long chips of stiff materials swing for many depths. Where that hides the mean, the swing is taken out, from
/// the latest start that tells the mean to the tolerance: in the first swings the chip's end finds the rake face.
SteadyPart steady_part(std::span<const double> force, const Scene& scene) {
  SteadyPart best = plain_steady_part(force, scene);
  if (best.from >= force.size() || best.knows(force, scene.steady_state.tolerance)) return best;
  const std::size_t first = earliest(scene);
  double least = best.steady ? best.mean(force).standard_error : std::numeric_limits<double>::infinity();
  for (std::size_t eighths = 4; eighths > 0; --eighths) {
    const std::size_t from = first + (force.size() - first) * eighths / 8;
    const std::optional<Swing> swing = find_swing(force.subspan(from));
    if (!swing || !is_steady(calmed(force.subspan(from), *swing), scene)) continue;
    const SteadyPart part{from, true, swing};
    if (part.knows(force, scene.steady_state.tolerance)) return part;
    const double error = part.mean(force).standard_error;
    if (error >= least) continue;
    least = error;
    best = part;
  }
  return best;
}

/// Length of the process zone at this instant.
double process_zone(const Crack& crack, const Cohesive& cohesive) {
  double pairs = 0.0;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (!crack.intact[k]) continue;
    const double used = cohesive.mode_I->area(crack.largest_normal[k]) / cohesive.mode_I->toughness() +
                        cohesive.mode_II->area(crack.largest_shear[k]) / cohesive.mode_II->toughness();
    if (used > 0.05) pairs += 1.0;
  }
  return pairs * crack.spacing;
}

Snapshot picture(const State& state, const Scene& scene) {
  Snapshot shot;
  std::vector<double> temperature;
  if (scene.thermal) temperature = temperatures(state, scene);
  const Particles& p = state.particles;
  for (const std::size_t side : {below, above})
    for (std::size_t i = p.begin[side]; i < p.begin[side + 1]; ++i) {
      if (p.volume[i] == 0.0) continue;
      const double pressure = -(p.stress_xx[i] + p.stress_yy[i] + p.stress_zz[i]) / 3.0;
      const double sx = p.stress_xx[i] + pressure, sy = p.stress_yy[i] + pressure, sz = p.stress_zz[i] + pressure;
      shot.x.push_back(p.x[i]);
      shot.y.push_back(p.y[i]);
      shot.velocity_x.push_back(p.velocity_x[i]);
      shot.velocity_y.push_back(p.velocity_y[i]);
      shot.equivalent_stress.push_back(
          std::sqrt(1.5 * (sx * sx + sy * sy + sz * sz + 2.0 * p.stress_xy[i] * p.stress_xy[i])));
      shot.pressure.push_back(pressure);
      shot.plastic_strain.push_back(p.plastic_strain[i]);
      if (scene.thermal) shot.temperature.push_back(temperature[i]);
      shot.side.push_back(side == above ? 1 : -1);
    }
  const Crack& crack = state.crack;
  for (std::size_t k = 0; k < crack.size(); ++k) {
    if (crack.face[above].inverse_mass[k] > 0.0) {
      shot.upper_face_x.push_back(crack.face[above].x[k]);
      shot.upper_face_y.push_back(crack.face[above].y[k]);
    }
    if (crack.face[below].inverse_mass[k] > 0.0) {
      shot.lower_face_x.push_back(crack.face[below].x[k]);
      shot.lower_face_y.push_back(crack.face[below].y[k]);
    }
  }
  shot.tool_tip_x = state.tool.x;
  shot.tool_tip_y = state.tool.y;
  shot.tip_radius = state.tool.tip_radius;
  shot.cell = state.grid.cell_y;
  return shot;
}

CutResult::Heat heat_of(const State& state, const Scene& scene) {
  const Particles& p = state.particles;
  const std::vector<double> T = temperatures(state, scene);
  CutResult::Heat heat{.chip = 0.0, .highest = scene.thermal->start, .friction = {}};
  if (scene.thermal->friction_share > 0.0) heat.friction = state.work.friction_heat;
  double volume = 0.0;
  const double low = 1.25 * scene.cut.depth, high = 2.75 * scene.cut.depth,
               ahead = state.tool.x + 2.5 * scene.cut.depth;
  for (std::size_t i = 0; i < p.begin[above + 1]; ++i) {
    if (p.volume[i] == 0.0) continue;
    heat.highest = std::max(heat.highest, T[i]);
    if (i < p.begin[above] || p.y[i] < low || p.y[i] > high || p.x[i] > ahead) continue;
    volume += p.volume[i];
    heat.chip += p.volume[i] * T[i];
  }
  heat.chip = volume > 0.0 ? heat.chip / volume : std::nan("");
  return heat;
}

/// Largest plastic strain of the particles that have a cell of the base to themselves.
double coarse_strain(const State& state, const Scene& scene) {
  const Particles& p = state.particles;
  const double shared = scene.cell() * scene.cell_length() / scene.particles_per_cell();
  double largest = 0.0;
  for (std::size_t i = 0; i < p.begin[above]; ++i)
    if (p.volume[i] > 1.5 * shared) largest = std::max(largest, p.plastic_strain[i]);
  return largest;
}

}  // namespace

bool well_enough_known(const std::vector<ForceSample>& history, const Scene& scene) {
  if (history.back().travel < scene.steady_state.not_before * scene.cut.depth) return false;
  const std::vector<double> force = series(history, &ForceSample::F_c);
  return steady_part(force, scene).knows(force, scene.steady_state.tolerance);
}

void summarise(CutResult& result, const Recorder& recorder, const State& state, const Scene& scene) {
  const std::vector<ForceSample>& history = recorder.history();
  result.history = history;
  result.snapshot = picture(state, scene);
  if (scene.thermal) result.heat = heat_of(state, scene);
  if (history.empty()) return;
  result.ledger = history.back().ledger;
  if (scene.grips) {
    result.is_specimen = true;
    result.process_zone = process_zone(state.crack, scene.cohesive);
    result.mode_I_fraction = history.back().fracture_I / result.ledger.fracture;
    return;
  }

  const SteadyPart part = steady_part(series(history, &ForceSample::F_c), scene);
  result.steady = part.steady;
  const std::size_t from = std::min(part.from, history.size() - 1);
  result.steady_from = history[from].travel;
  const auto mean = [&](auto member) {
    const std::vector<double> values = series(history, member);
    return level(std::span(values).subspan(from), part.swing);
  };
  result.F_c = mean(&ForceSample::F_c);
  result.F_t = mean(&ForceSample::F_t);
  for (const ToolFace face : faces_of(scene)) {
    const auto of_face = [&](double FaceForce::*member) {
      std::vector<double> values;
      values.reserve(history.size());
      for (const ForceSample& sample : history) values.push_back(sample.face[static_cast<std::size_t>(face)].*member);
      return level(std::span(values).subspan(from), part.swing);
    };
    result.faces.push_back(
        {face, of_face(&FaceForce::normal), of_face(&FaceForce::tangential), of_face(&FaceForce::contact_length)});
    if (face == ToolFace::rake && scene.friction && scene.friction->coefficient > 0.0)
      result.sliding_share = result.faces.back().tangential.value / of_face(&FaceForce::slip_limit).value;
  }
  result.crack_lead = mean(&ForceSample::crack_lead);
  result.softening_lead = mean(&ForceSample::softening_lead);
  result.deepest_penetration = mean(&ForceSample::penetration).value / scene.cell();
  if (scene.fine_base_height() < scene.base_height()) result.coarse_strain = coarse_strain(state, scene);
  // The chip reaches the place where it is measured later than the force settles: it has a start of its own.
  const std::vector<double> ratio = series(recorder.chip(), &ChipShape::ratio);
  std::size_t grown = from;
  for (std::size_t k = from; k < ratio.size(); ++k)
    if (!std::isfinite(ratio[k])) grown = k + 1;
  const std::size_t chip_from = std::min(truncation_point(ratio, grown), ratio.size() - 1);
  const auto chip_mean = [&](auto member) {
    const std::vector<double> values = series(recorder.chip(), member);
    return batch_mean(std::span(values).subspan(chip_from));
  };
  result.chip_ratio = chip_mean(&ChipShape::ratio);
  result.chip_curvature = chip_mean(&ChipShape::curvature);
  result.branch = result.softening_lead.value > 0.2 * scene.cut.depth ? Branch::bending : Branch::touching;

  result.process_zone = process_zone(state.crack, scene.cohesive);
  result.lost_length = state.work.lost_length;
  double normal = 0.0;
  for (const FaceResult& face : result.faces) normal += face.normal.value;
  result.edge_share = normal > 0.0 ? mean(&ForceSample::at_edge).value / normal : 0.0;
  result.inertia_share = state.density * scene.cut.depth * scene.cut.speed * scene.cut.speed / result.F_c.value;
  const double ahead = scene.log ? scene.log->length - state.tool.x : scene.window.ahead * scene.cut.depth;
  result.room_ahead = ahead - result.softening_lead.value;

  const double mode_I = history.back().fracture_I - history[from].fracture_I;
  const double fracture = history.back().ledger.fracture - history[from].ledger.fracture;
  // New area lies behind the softened front, whose distance to the tool may swing, and which goes from cell to cell: a
  // line through all samples knows its advance to a fraction of a cell, their first and last to one or two.
  const double energy_per_area =
      slope(history, from, [](const ForceSample& sample) { return sample.ledger.fracture; }) /
      slope(history, from, [](const ForceSample& sample) { return sample.travel + sample.softening_lead; });
  const double broken_length = history.back().broken_length - history[from].broken_length;
  const double broken_energy = history.back().broken_energy - history[from].broken_energy;
  result.mode_I_fraction = mode_I / fracture;
  result.fracture_energy = energy_per_area;
  result.fracture_energy_ratio = broken_length > 0.0 ? energy_per_area / (broken_energy / broken_length) : 0.0;
}

const char* name(Branch branch) {
  return branch == Branch::touching ? "touching" : "bending";
}

}  // namespace kerf::forward
