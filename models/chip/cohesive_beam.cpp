#include "models/chip/cohesive_beam.hpp"

#include <fmt/format.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "models/chip/beam_section.hpp"
#include "models/chip/cohesive_profile.hpp"

namespace kerf::chip {

using namespace cohesive;

namespace {

constexpr double pi = std::numbers::pi;

/// direction.
class Search {
 public:
  Search(const CohesiveBeam& beam, const Profile& profile)
      : profile_(profile),
        turn_(0.5 * pi - beam.rake),
        direction_(beam.rake - std::atan(beam.friction)),
        least_pull_(0.2 * beam.mode_I->toughness()) {}

  struct Point {
    double phase, pull;
  };

  std::optional<Point> run() {
    if (const auto rough = bracket(coarse)) {
      if (const auto exact = polish(*rough)) return exact;
    }
    if (folded_) return std::nullopt;
    known_phase_.reset();
    const auto near = bracket(fine);
    if (!near) return std::nullopt;
    if (const auto exact = polish(*near)) return exact;
    const auto left = residual(*near, fine);
    return left && std::hypot(left->turn, left->direction) < noise(fine) ? near : std::nullopt;
  }

  /// Under some force the section folded up before the chip had turned to the face.
  bool folded() const { return folded_; }

  /// Newton from a neighbouring solution.
  std::optional<Point> polish(Point at, double tolerance = fine) const {
    const double good = 1e2 * tolerance;
    for (int step = 0; step < 25; ++step) {
      const auto now = residual(at, tolerance);
      if (!now) return std::nullopt;
      const double size = std::hypot(now->turn, now->direction);
      if (size < good) return at;
      const double d_phase = 0.1 * std::sqrt(tolerance), d_pull = std::sqrt(tolerance) * at.pull;
      const auto by_phase = residual({at.phase - d_phase, at.pull}, tolerance);
      const auto by_pull = residual({at.phase, at.pull + d_pull}, tolerance);
      if (!by_phase || !by_pull) return std::nullopt;
      const double a = (now->turn - by_phase->turn) / d_phase, b = (by_pull->turn - now->turn) / d_pull;
      const double c = (now->direction - by_phase->direction) / d_phase,
                   d = (by_pull->direction - now->direction) / d_pull;
      const double determinant = a * d - b * c;
      const double step_phase = -(d * now->turn - b * now->direction) / determinant;
      const double step_pull = -(a * now->direction - c * now->turn) / determinant;
      Point trial = at;
      bool better = false;
      constexpr int halvings = 14;
      for (int halving = 0; halving < halvings && !better; ++halving) {
        const double scale = std::ldexp(1.0, -halving);
        trial = {at.phase + scale * step_phase, at.pull + scale * step_pull};
        const auto next = trial.pull > 0.0 ? residual(trial, tolerance) : std::nullopt;
        better = next && std::hypot(next->turn, next->direction) < size;
      }
      // What is left is the noise of the integration.
      if (!better) return size < noise(tolerance) ? std::optional(at) : std::nullopt;
      at = trial;
    }
    const auto last = residual(at, tolerance);
    return last && std::hypot(last->turn, last->direction) < noise(tolerance) ? std::optional(at) : std::nullopt;
  }

  static constexpr double fine = 1e-10, coarse = 1e-7;

 private:
  static constexpr double jump = 0.02;  // rad
  /// Up to where bracketing goes: from a rough solution Newton does the rest.
  static double enough(double tolerance) { return tolerance > fine ? 1e-3 : 1e-7; }
  /// What the integration leaves of a residual in rad where the turn hangs on the seventh digit of the phase.
  static double noise(double tolerance) { return 10.0 * std::sqrt(tolerance); }

  struct Residual {
    double turn, direction;
  };
  std::optional<Residual> residual(Point at, double tolerance) const {
    const Shot shot = profile_.shoot(at.phase, at.pull, tolerance);
    if (shot.end != Shot::End::contact) return std::nullopt;
    return residual(shot);
  }
  Residual residual(const Shot& shot) const {
    return {shot.contact[rotation] - turn_, std::atan2(shot.tool[force_y], shot.tool[force_x]) - direction_};
  }

  /// Missing turn at given pull: rises with the phase from "closes again" to "folds up".
  double missing_turn(double phase, double pull, double tolerance) const {
    const Shot shot = profile_.shoot(phase, pull, tolerance);
    switch (shot.end) {
      case Shot::End::contact:
        return residual(shot).turn;
      case Shot::End::over:
      case Shot::End::folded:
        return 2.0;
      default:
        return -2.0;
    }
  }

  /// Turns the chip to the rake face under this pull; the residue of the force's direction, if that is possible.
  std::optional<double> direction_at(double pull, double tolerance) {
    const auto missing = [&](double phase) { return missing_turn(phase, pull, tolerance); };
    double low = 0.0, high = 0.0, at_low = 0.0, at_high = 0.0;
    bool found = false;
    if (known_phase_) {
      double width = 0.02;
      low = *known_phase_ - width;
      high = *known_phase_ + width;
      at_low = missing(low);
      at_high = missing(high);
      for (; at_low >= 0.0 && width < 0.4; width *= 2.0) {
        high = low;
        at_high = at_low;
        low -= 2.0 * width;
        at_low = missing(low);
      }
      for (width = 0.02; at_high < 0.0 && width < 0.4; width *= 2.0) {
        low = high;
        at_low = at_high;
        high += 2.0 * width;
        at_high = missing(high);
      }
      found = at_low < 0.0 && at_high >= 0.0;
    }
    if (!found) {
      constexpr int steps = 60;
      double previous = missing(0.0);
      for (int i = 1; i <= steps && !found; ++i) {
        const double phase = 2.0 * pi * i / steps;
        const double here = missing(phase);
        if (previous < 0.0 && here >= 0.0) {
          low = 2.0 * pi * (i - 1) / steps;
          high = phase;
          at_low = previous;
          at_high = here;
          found = true;
        }
        previous = here;
      }
    }
    if (!found) return std::nullopt;
    std::uintmax_t steps = 100;
    const double width = 1e-1 * tolerance;
    const auto near_enough = [&](double phase) {  // an exact zero ends the search
      const double turn = missing(phase);
      return std::abs(turn) < enough(tolerance) ? 0.0 : turn;
    };
    const auto [a, b] = boost::math::tools::toms748_solve(
        near_enough, low, high, at_low, at_high, [&](double x, double z) { return std::abs(x - z) < width; }, steps);
    const double phase = 0.5 * (a + b);
    const Shot shot = profile_.shoot(phase, pull, tolerance);
    const Residual left = shot.end == Shot::End::contact ? residual(shot) : Residual{2.0, 0.0};
    if (std::abs(left.turn) > jump) {  // a jump, no solution
      folded_ = folded_ || profile_.shoot(b, pull, tolerance).end == Shot::End::folded;
      return std::nullopt;
    }
    known_phase_ = phase;
    return left.direction;
  }

  /// The force turns from upright to along the plane as the pull grows.
  std::optional<Point> bracket(double tolerance) {
    double low = 0.0, high = 0.0, at_low = 0.0, at_high = 0.0;
    for (double pull = least_pull_; pull < 1e5 * least_pull_ && !(high > 0.0); pull *= 1.7) {
      const auto direction = direction_at(pull, tolerance);
      if (!direction) known_phase_.reset();
      if (direction && *direction <= 0.0) {
        high = pull;
        at_high = *direction;
      } else if (direction || !(at_low > 0.0)) {
        low = pull;
        at_low = direction.value_or(0.0);
      }
    }
    if (!(high > 0.0) || low == 0.0) return std::nullopt;
    // Too small a pull may not turn the chip at all: the shear of the plane takes it up.
    for (int halving = 0; halving < 20 && !(at_low > 0.0); ++halving) {
      const double pull = 0.5 * (low + high);
      const auto direction = direction_at(pull, tolerance);
      if (!direction) known_phase_.reset();
      if (direction && *direction <= 0.0) {
        high = pull;
        at_high = *direction;
      } else {
        low = pull;
        at_low = direction.value_or(0.0);
      }
    }
    if (!(at_low > 0.0)) return std::nullopt;
    bool lost = false;
    std::uintmax_t steps = 60;
    const auto [a, b] = boost::math::tools::toms748_solve(
        [&](double pull) {
          const auto direction = direction_at(pull, tolerance);
          lost = lost || !direction;
          return direction && std::abs(*direction) > 10.0 * enough(tolerance) ? *direction : 0.0;
        },
        low, high, at_low, at_high, [&](double x, double z) { return std::abs(x - z) < 1e3 * tolerance * std::abs(x); },
        steps);
    const double pull = 0.5 * (a + b);
    if (lost || !direction_at(pull, tolerance)) return std::nullopt;
    return Point{*known_phase_, pull};
  }

  const Profile& profile_;
  double turn_, direction_, least_pull_;
  std::optional<double> known_phase_;
  bool folded_ = false;
};

CohesiveBeamSolution describe(const CohesiveBeam& beam, const Profile& profile, Search::Point at) {
  CohesiveBeamSolution solution{};
  const Shot shot = profile.shoot(at.phase, at.pull, Search::fine, &solution.sections);
  const State& tip = shot.crack_tip;
  for (const ChipSection& section : solution.sections) {
    if (section.arc == shot.crack_tip_arc) solution.crack_tip = section;
  }

  const double F_x = shot.tool[force_x], F_y = shot.tool[force_y];
  solution.normal_force = F_x * std::cos(beam.rake) + F_y * std::sin(beam.rake);
  solution.F_c = F_x;
  solution.F_t = -F_y;
  solution.root_curvature = shot.root_curvature;
  solution.work_I = profile.work_I(tip);
  solution.work_II = profile.work_II(tip);
  solution.area_I = profile.area_I(tip);
  solution.area_II = profile.area_II(tip);
  const double k = shot.root_curvature / beam.yield_curvature();
  solution.plastic_work =
      plastic_work(k, beam.hardening) * beam.bending_stiffness() * beam.yield_curvature() * beam.yield_curvature();
  const double tool = solution.F_c - beam.friction * solution.normal_force;
  solution.imbalance = (solution.work_I + solution.work_II + solution.plastic_work) / tool - 1.0;

  const double tip_x = profile.lower_x(tip, shot.crack_tip_arc);
  const double tool_x =
      profile.lower_x(shot.contact, shot.contact_arc) + profile.opening(shot.contact) * std::tan(beam.rake);
  solution.tip_gap = tip_x - tool_x;
  solution.front_gap = shot.front_x - tool_x;
  solution.process_zone = shot.front_x - tip_x;
  solution.contact_length = shot.contact_arc - shot.front_arc;
  solution.touching = solution.front_gap <= 0.0 || solution.contact_length < beam.depth;
  const double residual = (k - section_moment(k, beam.hardening)) * beam.yield_curvature();
  solution.curl_radius = residual > 0.0 ? 1.0 / residual : std::numeric_limits<double>::infinity();
  return solution;
}

/// A number only where the energies agree.
CohesiveBeamOutcome checked(CohesiveBeamSolution solution) {
  constexpr double most = 1e-3;
  if (std::abs(solution.imbalance) <= most) return {std::move(solution), {}};
  if (solution.touching) return {{}, "touching: the tool meets the chip ahead of the crack front", true};
  return {{}, fmt::format("the tool's work and that of fracture and bending differ by {:.2g}", solution.imbalance)};
}

/// The tool's tip stands inside the process zone: ever shorter zones, each solved from its neighbour, until the zone
/// ends at the tip.
CohesiveBeamOutcome cut_at_the_tip(const CohesiveBeam& beam, Profile& profile, const Search& search,
                                   Search::Point nearest, double gap_long) {
  const double front = profile.opening_plane().front();
  double long_zone = profile.opening(profile.shoot(nearest.phase, nearest.pull, Search::fine).crack_tip);
  double short_zone = 0.0, gap_short = 0.0;
  bool lost = false;
  const auto gap_at = [&](double opening) {
    profile.end_at(opening);
    auto found = search.polish(nearest, Search::coarse);
    if (!found) found = Search(beam, profile).run();
    if (!found) {
      lost = true;
      return 0.0;
    }
    nearest = *found;
    return describe(beam, profile, nearest).tip_gap;
  };
  constexpr double shrink = 0.85;
  while (short_zone == 0.0 && !lost) {
    const double opening = shrink * long_zone;
    if (opening <= front) {
      return {{},
              "touching: the tool's tip reaches the front of the crack, so that the chip does not bend ahead of it",
              true};
    }
    const double gap = gap_at(opening);
    if (gap < 0.0) {
      long_zone = opening;
      gap_long = gap;
    } else {
      short_zone = opening;
      gap_short = gap;
    }
  }
  std::uintmax_t steps = 60;
  double opening = short_zone;
  if (!lost && gap_short > 0.0) {
    const auto [a, b] = boost::math::tools::toms748_solve(gap_at, short_zone, long_zone, gap_short, gap_long,
                                                          boost::math::tools::eps_tolerance<double>(20), steps);
    opening = 0.5 * (a + b);
  }
  profile.end_at(opening);
  const auto cut = lost ? std::nullopt : search.polish(nearest);
  if (!cut) return {{}, "no steady bent chip was found whose bridging ends at the tool's tip"};
  return checked(describe(beam, profile, *cut));
}

}  // namespace

double foundation_stiffness(double modulus, double root_rotation, double depth) {
  return modulus / (3.0 * std::pow(root_rotation, 4) * depth);
}

double shear_foundation_stiffness(double shear_modulus, double depth) {
  return 8.0 * shear_modulus / (3.0 * depth);
}

CohesiveBeamOutcome solve(const CohesiveBeam& beam) {
  Profile profile(beam);
  const auto jump = [](const char* mode, const Plane& plane) {
    return fmt::format(
        "the mode {} traction falls by {:.4g} MPa/mm, steeper than the material beside the crack plane can follow "
        "({:.4g} MPa/mm): the crack would jump",
        mode, plane.steepest_fall(), plane.stiffness());
  };
  if (profile.opening_plane().jumps()) return {{}, jump("I", profile.opening_plane())};
  if (profile.sliding_plane() && profile.sliding_plane()->jumps()) return {{}, jump("II", *profile.sliding_plane())};

  Search search(beam, profile);
  const auto at = search.run();
  if (!at && search.folded()) {
    return {
        {},
        "touching: the section folds up, as a plastic hinge, before the chip has turned to the rake face, so that no "
        "steady bent chip keeps the crack ahead of the tool",
        true};
  }
  if (!at) return {{}, "no force on the rake face opens the crack and turns the chip to the face"};
  auto solution = describe(beam, profile, *at);
  if (!beam.tool_cuts_bridging || solution.tip_gap >= 0.0) return checked(std::move(solution));
  return cut_at_the_tip(beam, profile, search, *at, solution.tip_gap);
}

}  // namespace kerf::chip
