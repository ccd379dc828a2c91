#include "models/chip/cohesive_profile.hpp"

#include <boost/numeric/odeint.hpp>
#include <limits>
#include <numbers>

namespace kerf::chip::cohesive {

Shot Profile::shoot(double phase, double pull, double tolerance, std::vector<ChipSection>* sections) const {
  namespace odeint = boost::numeric::odeint;

  // E'I w'''' + (R_x - k_t h^2/4) w'' + k w = 0: what decays ahead obeys w'' = S w' - P w.
  const double half = 0.5 * beam_.depth;
  const double shear = sliding_ ? sliding_->initial_stiffness() * half * half : 0.0;
  const double P = std::sqrt(opening_.initial_stiffness() / bending_);
  const double S2 = 2.0 * P - (pull - shear) / bending_;
  Shot shot;
  if (S2 <= 0.0) return shot;
  const double S = std::sqrt(S2);
  constexpr double share = 1e-4;  // of the critical opening: far from where any law bends
  const double w = share * opening_.end() * std::cos(phase);
  const double theta = share * opening_.end() * std::sqrt(P / 2.0) * std::sin(phase);
  const double kappa = S * theta - P * w;
  const double kappa_slope = S * kappa - P * theta;
  State y{theta, kappa, pull, -bending_ * kappa_slope + (shear - pull) * theta, 0.0, w, half * std::abs(theta)};

  double arc = 0.0;
  bool past_front = false;
  Branch branch;
  enum Event { softened, failed, turned, released, beyond, hinged, shut, events };
  const double beyond_the_face = 0.5 * std::numbers::pi - beam_.rake + 0.5;
  constexpr double folded_flat = 2.0;  // depth times curvature: the inner face has no length left
  constexpr int most_steps = 20000;
  int steps = 0;
  if (sections) sections->push_back(section(y, arc, branch));

  for (;;) {
    const auto system = [&](const State& at, State& d, double) { derivative(at, d, branch); };
    const auto passed = [&](const State& at, int event) {
      switch (event) {
        case softened:
          return !past_front && opening(at) >= opening_.front();
        case failed:
          return !branch.free && failure(at) >= 0.0;
        case turned:  // from loading to unloading, or back
          if (branch.on_face) return false;
          if (branch.unloading) return at[curvature] > branch.most_curvature * (1.0 + 1e-12);
          return at[curvature] > yield_curvature_ &&
                 moment_slope(at, branch.free ? Tractions{0.0, 0.0} : tractions(at)) <= 0.0;
        case released:
          return (branch.free || past_front) && !branch.on_face && moment(at, branch) <= 0.0;
        case beyond:
          return at[rotation] >= beyond_the_face;
        case hinged:
          return beam_.depth * at[curvature] >= folded_flat;
        default:
          return at[rotation] < -0.5 || (opening(at) > opening_.front() && at[rotation] < 0.0);
      }
    };
    auto stepper = odeint::make_dense_output(1e-16, tolerance, odeint::runge_kutta_dopri5<State>());
    stepper.initialize(y, arc, 0.01 / S);
    odeint::runge_kutta_dopri5<State> single;

    int event = events;
    while (event == events) {
      if (++steps > most_steps) {
        shot.end = Shot::End::over;
        return shot;
      }
      const auto [from, to] = stepper.do_step(system);
      double first = to;
      for (int candidate = 0; candidate < events; ++candidate) {
        if (!passed(stepper.current_state(), candidate)) continue;
        double before = from, after = to;
        State between;
        while (after - before > 4.0 * std::numeric_limits<double>::epsilon() * after) {
          const double middle = 0.5 * (before + after);
          if (middle <= before || middle >= after) break;
          stepper.calc_state(middle, between);
          (passed(between, candidate) ? after : before) = middle;
        }
        if (event == events || after < first) {
          first = after;
          event = candidate;
        }
      }
      if (event == events) {
        y = stepper.current_state();
      } else {
        // The dense output is a lower-order interpolation: go there by a step of its own.
        State start = stepper.previous_state();
        single.do_step(system, start, from, y, first - from);
      }
      arc = first;
      if (sections) sections->push_back(section(y, arc, branch));
    }

    switch (event) {
      case softened:
        past_front = true;
        shot.front_arc = arc;
        shot.front_x = lower_x(y, arc);
        break;
      case failed:
        branch.free = true;
        shot.crack_tip = y;
        shot.crack_tip_arc = arc;
        break;
      case turned:
        branch.unloading = !branch.unloading;
        if (branch.unloading) branch.most_curvature = y[curvature];
        break;
      case released:
        shot.contact = y;
        shot.contact_arc = arc;
        shot.root_curvature = branch.unloading ? branch.most_curvature : y[curvature];
        branch.on_face = !branch.free;
        break;
      case beyond:
        shot.end = Shot::End::over;
        return shot;
      case hinged:
        shot.end = Shot::End::folded;
        return shot;
      default:
        shot.end = Shot::End::closed;
        return shot;
    }
    if (branch.free && (branch.on_face || event == released)) {
      shot.end = Shot::End::contact;
      shot.tool = y;
      return shot;
    }
  }
}

/// Finds phase and pull far ahead such that the chip ends tangent to the rake face under a force in the tool's

}  // namespace kerf::chip::cohesive
