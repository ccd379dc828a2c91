#pragma once

#include <algorithm>
#include <array>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "models/chip/beam_section.hpp"
#include "models/chip/cohesive_beam.hpp"
#include "models/laws/traction_law.hpp"

namespace kerf::chip::cohesive {

// The integration of the beam of cohesive_beam.hpp along its arc, Eqs. (1) and (2) there.

/// The crack plane and the material beside it as two springs in series, one fracture mode.
class Plane {
 public:
  Plane(const laws::TractionLaw& law, double stiffness) : law_(&law), stiffness_(stiffness) {
    // Where the law falls faster than the spring stretches, the opening would jump.
    constexpr int samples = 4000;
    for (int i = 0; i < samples; ++i) {
      const double opening = law.critical_opening() * (i + 0.5) / samples;
      steepest_fall_ = std::min(steepest_fall_, law.slope(opening));
      if (law.traction(opening) > law.traction(peak_)) peak_ = opening;
    }
    initial_stiffness_ = 1.0 / (1.0 / stiffness + 1.0 / law.slope(0.0));
    front_ = total(peak_);
  }

  bool jumps() const { return -steepest_fall_ >= stiffness_; }
  double steepest_fall() const { return -steepest_fall_; }
  double stiffness() const { return stiffness_; }
  double initial_stiffness() const { return initial_stiffness_; }
  double end() const { return law_->critical_opening(); }  ///< of the total opening: no traction is left to stretch
  double front() const { return front_; }                  ///< total opening at the largest traction
  double toughness() const { return law_->toughness(); }

  /// Cohesive part of the total opening x; closing is none.
  double opening(double x) const {
    if (x <= 0.0) return 0.0;
    if (x >= end()) return x;
    const auto excess = [&](double opening) {
      return std::pair{law_->traction(opening) - stiffness_ * (x - opening), law_->slope(opening) + stiffness_};
    };
    std::uintmax_t steps = 100;
    return boost::math::tools::newton_raphson_iterate(excess, x, 0.0, x, 48, steps);
  }
  /// Closing is contact on the elastic material: linear.
  double traction(double x) const {
    if (x <= 0.0) return stiffness_ * x;
    return x >= end() ? 0.0 : law_->traction(opening(x));
  }
  double area(double x) const { return law_->area(opening(x)); }
  /// Work done on law and spring up to x.
  double work(double x) const {
    const double traction_now = traction(x);
    return area(x) + 0.5 * traction_now * traction_now / stiffness_;
  }

 private:
  double total(double opening) const { return opening + law_->traction(opening) / stiffness_; }

  const laws::TractionLaw* law_;
  double stiffness_, initial_stiffness_ = 0.0, steepest_fall_ = 0.0, peak_ = 0.0, front_ = 0.0;
};

enum Component : std::size_t { rotation, curvature, force_x, force_y, slide, lift, largest_sliding, components };
using State = std::array<double, components>;

/// How the integration from far ahead ended.
struct Shot {
  enum class End {
    contact,  ///< M = 0 behind the crack tip
    closed,   ///< the crack closes again: bent too little
    over,     ///< turns beyond the rake face: bent too much
    folded,   ///< a hinge: the section has no length left on its inner side
    unstable  ///< R_x far ahead buckles the layer off its foundation
  };
  End end = End::unstable;
  State crack_tip{}, contact{};
  double crack_tip_arc = 0.0, contact_arc = 0.0, front_arc = 0.0, front_x = 0.0;
  State tool{};  ///< R of the whole tool: that of the contact, or of the crack tip where that lies on the face
  double root_curvature = 0.0;
};

/// The beam and what holds for each of its states. Refers to the `beam` it is made for.
class Profile {
 public:
  explicit Profile(const CohesiveBeam& beam)
      : beam_(beam),
        opening_(*beam.mode_I, beam.normal_stiffness),
        end_opening_(opening_.end()),
        bending_(beam.bending_stiffness()),
        yield_curvature_(beam.yield_curvature()) {
    if (beam.mode_II) sliding_.emplace(*beam.mode_II, beam.shear_stiffness);
  }

  const Plane& opening_plane() const { return opening_; }
  const std::optional<Plane>& sliding_plane() const { return sliding_; }
  /// Total opening at which the tractions end although the law goes on: the tool's tip cuts them.
  void end_at(double opening) { end_opening_ = opening; }

  double opening(const State& y) const { return y[lift] + 0.5 * beam_.depth * (1.0 - std::cos(y[rotation])); }
  double sliding(const State& y) const { return y[slide] - 0.5 * beam_.depth * std::sin(y[rotation]); }
  double lower_x(const State& y, double arc) const { return sliding(y) - arc; }

  double loading_moment(double kappa) const {
    return section_moment(kappa / yield_curvature_, beam_.hardening) * bending_ * yield_curvature_;
  }

  double area_I(const State& y) const { return opening_.area(opening(y)); }
  double area_II(const State& y) const { return sliding_ ? sliding_->area(y[largest_sliding]) : 0.0; }
  double work_I(const State& y) const { return opening_.work(opening(y)); }
  double work_II(const State& y) const {
    if (!sliding_ || y[largest_sliding] <= 0.0) return 0.0;
    const double back = sliding(y) / y[largest_sliding];  // unloads straight to the origin
    return sliding_->work(y[largest_sliding]) -
           0.5 * sliding_->traction(y[largest_sliding]) * y[largest_sliding] * (1.0 - back * back);
  }

  /// Integrates from far ahead, where the layer rests on the linear foundation: `phase` is the mix of lift and rotation
  /// there, `pull` is R_x. Errors of that start die out along s, since only what decays ahead grows towards the crack.
  Shot shoot(double phase, double pull, double tolerance, std::vector<ChipSection>* sections = nullptr) const;

 private:
  struct Tractions {
    double x, y;
  };
  Tractions tractions(const State& y) const {
    double along = 0.0;
    if (sliding_) {
      const double now = sliding(y), size = std::abs(now), most = y[largest_sliding];
      const double traction =
          size >= most ? sliding_->traction(size) : (most > 0.0 ? sliding_->traction(most) * size / most : 0.0);
      along = now > 0.0 ? -traction : traction;
    }
    return {along, -opening_.traction(opening(y))};
  }

  /// Which branch of the section and which part of the layer the integration is on.
  struct Branch {
    bool free = false;       ///< behind the crack tip
    bool on_face = false;    ///< lies on the rake face while the plane still pulls: straight, M = 0
    bool unloading = false;  ///< elastically, from the largest curvature
    double most_curvature = 0.0;
  };

  double moment(const State& y, const Branch& branch) const {
    if (!branch.unloading) return loading_moment(y[curvature]);
    return loading_moment(branch.most_curvature) - bending_ * (branch.most_curvature - y[curvature]);
  }
  double moment_slope(const State& y, const Tractions& q) const {
    const double c = std::cos(y[rotation]), s = std::sin(y[rotation]);
    return -(y[force_y] * c + y[force_x] * s) + 0.5 * beam_.depth * (q.x * c - q.y * s);
  }
  void derivative(const State& y, State& d, const Branch& branch) const {
    const Tractions q = branch.free ? Tractions{0.0, 0.0} : tractions(y);
    double stiffness = bending_;
    if (const double k = y[curvature] / yield_curvature_; !branch.unloading && k > 1.0)
      stiffness *= beam_.hardening + (1.0 - beam_.hardening) / (k * k * k);
    const double kappa = branch.on_face ? 0.0 : y[curvature];
    d[rotation] = kappa;
    d[curvature] = branch.on_face ? 0.0 : moment_slope(y, q) / stiffness;
    d[force_x] = -q.x;
    d[force_y] = -q.y;
    d[slide] = 1.0 - std::cos(y[rotation]);
    d[lift] = std::sin(y[rotation]);
    const double now = sliding(y);
    const double rate = d[slide] - 0.5 * beam_.depth * std::cos(y[rotation]) * kappa;
    const double growth = now >= 0.0 ? rate : -rate;
    d[largest_sliding] = std::abs(now) >= y[largest_sliding] * (1.0 - 1e-9) && growth > 0.0 ? growth : 0.0;
  }

  /// Zero where both tractions end, negative before.
  double failure(const State& y) const {
    const double opened = opening(y);
    if (opened <= 0.0) return -1.0;
    double sum = std::pow(opening_.area(opened) / opening_.toughness(), beam_.exponent_n);
    if (sliding_) sum += std::pow(area_II(y) / sliding_->toughness(), beam_.exponent_m);
    return std::max(sum - 1.0, opened / end_opening_ - 1.0);
  }

  ChipSection section(const State& y, double arc, const Branch& branch) const {
    return {.arc = arc,
            .rotation = y[rotation],
            .curvature = y[curvature],
            .moment = moment(y, branch),
            .force_x = y[force_x],
            .force_y = y[force_y],
            .slide_axis = y[slide],
            .lift_axis = y[lift],
            .largest_sliding = y[largest_sliding]};
  }

  const CohesiveBeam& beam_;
  Plane opening_;
  std::optional<Plane> sliding_;
  double end_opening_, bending_, yield_curvature_;
};

}  // namespace kerf::chip::cohesive
