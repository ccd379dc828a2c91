#pragma once

#include <cmath>
#include <cstddef>
#ifdef __AVX512DQ__
#include <immintrin.h>
#endif

namespace kerf {

/// Material points are worked on eight at a time, one in each lane. Arithmetic, comparison and `mask ? a : b` are the
/// compiler's own on such vectors; it maps them to whatever SIMD registers the machine has.
constexpr std::size_t lane_count = 8;
using Lanes = double __attribute__((vector_size(64)));
using LaneInts = int __attribute__((vector_size(32)));
using LaneMask = decltype(Lanes{} < Lanes{});

constexpr Lanes all_lanes(double value) {
  return Lanes{value, value, value, value, value, value, value, value};
}

inline Lanes load(const double* from) {
  using Unaligned = double __attribute__((vector_size(64), aligned(8), may_alias));
  return *reinterpret_cast<const Unaligned*>(from);
}
inline void store(double* to, Lanes values) {
  using Unaligned = double __attribute__((vector_size(64), aligned(8), may_alias));
  *reinterpret_cast<Unaligned*>(to) = values;
}

inline double sum(Lanes v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

/// f of each lane by itself, for functions that have no SIMD form.
template <class Function>
Lanes each_lane(Lanes v, Function&& f) {
  Lanes result{};
  for (std::size_t i = 0; i < lane_count; ++i) result[i] = f(v[i]);
  return result;
}

// What GCC does not find the instruction for.
#ifdef __AVX512DQ__
inline Lanes sqrt(Lanes v) {
  return _mm512_maskz_sqrt_pd(0xFF, v);  // GCC 12 warns falsely about the plain one
}
/// 1/v and 1/sqrt(v) of normal numbers to the last digit or two: the machine's estimate and two steps of Newton's take
/// a third of the time of division and root.
inline Lanes rough_reciprocal(Lanes v) {  // to eight digits
  const Lanes y = _mm512_maskz_rcp14_pd(0xFF, v);
  return y + y * (1.0 - v * y);
}
inline Lanes reciprocal(Lanes v) {
  const Lanes y = rough_reciprocal(v);
  return y + y * (1.0 - v * y);
}
inline Lanes inverse_sqrt(Lanes v) {
  Lanes y = _mm512_maskz_rsqrt14_pd(0xFF, v);
  y *= 1.5 - 0.5 * v * y * y;
  return y * (1.5 - 0.5 * v * y * y);
}
inline bool any(LaneMask mask) {
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask)) != 0;
}
#else
inline Lanes sqrt(Lanes v) {
  return each_lane(v, [](double x) { return std::sqrt(x); });
}
inline Lanes rough_reciprocal(Lanes v) {
  return 1.0 / v;
}
inline Lanes reciprocal(Lanes v) {
  return 1.0 / v;
}
inline Lanes inverse_sqrt(Lanes v) {
  return 1.0 / sqrt(v);
}
inline bool any(LaneMask mask) {
  return (mask[0] | mask[1] | mask[2] | mask[3] | mask[4] | mask[5] | mask[6] | mask[7]) != 0;
}
#endif

inline Lanes abs(Lanes v) {
  return v < 0.0 ? -v : v;
}

}  // namespace kerf
