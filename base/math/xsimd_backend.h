// Lane operations by xsimd; the architecture follows the compiler flags of the translation unit.
// Chosen by measurement: docs/design/0002-lanes.md.
#pragma once

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "base/math/lanes.h"

namespace strut {

template <class Arch>
struct XsimdBackend {
  using Vector = xsimd::batch<double, Arch>;
  using MaskVector = xsimd::batch_bool<double, Arch>;
  static constexpr int kWidth = static_cast<int>(Vector::size);

  static Vector broadcast(double x) { return Vector(x); }
  static Vector load(const double* p) { return Vector::load_unaligned(p); }
  static void store(double* p, Vector a) { a.store_unaligned(p); }
  static Vector add(Vector a, Vector b) { return a + b; }
  static Vector sub(Vector a, Vector b) { return a - b; }
  static Vector mul(Vector a, Vector b) { return a * b; }
  static Vector div(Vector a, Vector b) { return a / b; }
  static Vector neg(Vector a) { return -a; }
  static MaskVector less(Vector a, Vector b) { return a < b; }
  static MaskVector less_equal(Vector a, Vector b) { return a <= b; }
  static MaskVector mask_and(MaskVector a, MaskVector b) { return a & b; }
  static MaskVector mask_or(MaskVector a, MaskVector b) { return a | b; }
  static MaskVector mask_not(MaskVector a) { return !a; }
  static bool any(MaskVector a) { return xsimd::any(a); }
  static bool all(MaskVector a) { return xsimd::all(a); }
  static Vector select(MaskVector m, Vector a, Vector b) { return xsimd::select(m, a, b); }
  static Vector abs(Vector a) { return xsimd::abs(a); }
  static Vector sqrt(Vector a) { return xsimd::sqrt(a); }
  static Vector min(Vector a, Vector b) { return xsimd::min(a, b); }
  static Vector max(Vector a, Vector b) { return xsimd::max(a, b); }
  static Vector floor(Vector a) { return xsimd::floor(a); }
  static Vector sin(Vector a) { return xsimd::sin(a); }
  static Vector cos(Vector a) { return xsimd::cos(a); }
  static Vector atan(Vector a) { return xsimd::atan(a); }
  static Vector exp(Vector a) { return xsimd::exp(a); }
  static void sin_cos(Vector a, Vector& s, Vector& c) {
    const auto both = xsimd::sincos(a);
    s = both.first;
    c = both.second;
  }
  static Vector gather(const double* table, Vector index) {
    alignas(64) double at[kWidth];
    alignas(64) double out[kWidth];
    store(at, index);
    for (int i = 0; i < kWidth; ++i) out[i] = table[static_cast<std::ptrdiff_t>(at[i])];
    return load(out);
  }
};

using NativeLanes = Lanes<XsimdBackend<xsimd::default_arch>>;

}  // namespace strut
