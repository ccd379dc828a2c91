#pragma once

#include <memory>
#include <vector>

#include "models/base/parameter.hpp"

namespace kerf::laws {

/// Traction T (MPa) against opening delta (mm) of one fracture mode under increasing opening. Unloading goes straight
/// to the origin, so the largest opening so far is the only history; compression is contact, not cohesion.
class TractionLaw {
 public:
  virtual ~TractionLaw() = default;
  /// T(delta) for delta >= 0; zero from the critical opening on.
  virtual double traction(double opening) const = 0;
  /// dT/d delta, MPa/mm; at a kink the slope that lies ahead, so zero from the critical opening on.
  virtual double slope(double opening) const = 0;
  /// Area under T from 0 to delta, N/mm: the G of the mixed-mode criterion, theory Eq. (8).
  virtual double area(double opening) const = 0;
  virtual double strength() const = 0;          ///< sigma_c, the largest traction, MPa
  virtual double critical_opening() const = 0;  ///< delta_c, mm
  virtual double toughness() const = 0;         ///< G_c = area(delta_c), N/mm

  /// Energy that closing after the largest opening so far does not give back, N/mm: the area less the triangle under
  /// the straight way to the origin. Zero on a straight rise, G_c from the critical opening on; never falls as long as
  /// T/delta does not rise.
  double dissipated(double largest) const { return area(largest) - 0.5 * traction(largest) * largest; }
};

/// A family member: how it is declared in a file and how it is made from what was read.
struct TractionLawKind {
  std::string name;
  std::string meaning;
  std::vector<Parameter> parameters;
  std::unique_ptr<TractionLaw> (*make)(const Values&);
};

/// The registered laws; a new law is one file and one line here.
const std::vector<TractionLawKind>& traction_laws();

/// The law that `values` names. Its variant was validated by the reader.
std::unique_ptr<TractionLaw> make_traction_law(const Values& values);

}  // namespace kerf::laws
