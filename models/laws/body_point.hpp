#pragma once

#include <array>
#include <cstddef>

#include "models/laws/material_point.hpp"

namespace kerf::laws {

/// A number that a law keeps at every point, and its value in material that nothing has happened to.
struct Memory {
  const char* name;
  double at_rest;
};
constexpr std::size_t most_memory = 4;

/// What the laws of bodies update: eight points. Kirchhoff stress (MPa) in the frame of the grid; temperature (K) and
/// `heating`, the heat (MPa, per reference volume) that yielding has set free in the step, only of thermal laws.
struct BodyPoints {
  Lanes xx, yy, zz, xy;
  std::array<Lanes, most_memory> memory;
  Lanes temperature, heating;
};

/// Volume after a step over volume before it: the determinant of 1 + l.
inline Lanes volume_growth(const StrainIncrement& l) {
  return (1.0 + l.xx) * (1.0 + l.yy) - l.xy * l.yx;
}

}  // namespace kerf::laws
