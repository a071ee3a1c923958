// Lane operations by std::experimental::simd of libstdc++ (Parallelism TS 2). It vectorizes sine
// and cosine; arctangent and exponential call the C library element by element.
#pragma once

#include <cstddef>
#include <experimental/simd>

#include "base/math/lanes.h"

namespace strut {

struct StdxBackend {
  using Vector = std::experimental::native_simd<double>;
  using MaskVector = Vector::mask_type;
  static constexpr int kWidth = static_cast<int>(Vector::size());

  static Vector broadcast(double x) { return Vector(x); }
  static Vector load(const double* p) { return {p, std::experimental::element_aligned}; }
  static void store(double* p, Vector a) { a.copy_to(p, std::experimental::element_aligned); }
  static Vector add(Vector a, Vector b) { return a + b; }
  static Vector sub(Vector a, Vector b) { return a - b; }
  static Vector mul(Vector a, Vector b) { return a * b; }
  static Vector div(Vector a, Vector b) { return a / b; }
  static Vector neg(Vector a) { return -a; }
  static MaskVector less(Vector a, Vector b) { return a < b; }
  static MaskVector less_equal(Vector a, Vector b) { return a <= b; }
  static MaskVector mask_and(MaskVector a, MaskVector b) { return a && b; }
  static MaskVector mask_or(MaskVector a, MaskVector b) { return a || b; }
  static MaskVector mask_not(MaskVector a) { return !a; }
  static bool any(MaskVector a) { return any_of(a); }
  static bool all(MaskVector a) { return all_of(a); }
  static Vector select(MaskVector m, Vector a, Vector b) {
    where(m, b) = a;
    return b;
  }
  static Vector abs(Vector a) { return std::experimental::abs(a); }
  static Vector sqrt(Vector a) { return std::experimental::sqrt(a); }
  // Not std::experimental::min and max, which treat NaN differently from `double`.
  static Vector min(Vector a, Vector b) { return select(b < a, b, a); }
  static Vector max(Vector a, Vector b) { return select(a < b, b, a); }
  static Vector floor(Vector a) { return std::experimental::floor(a); }
  static Vector sin(Vector a) { return std::experimental::sin(a); }
  static Vector cos(Vector a) { return std::experimental::cos(a); }
  static Vector atan(Vector a) { return std::experimental::atan(a); }
  static Vector exp(Vector a) { return std::experimental::exp(a); }
  static void sin_cos(Vector a, Vector& s, Vector& c) {
    s = sin(a);
    c = cos(a);
  }
  static Vector gather(const double* table, Vector index) {
    return Vector([&](auto i) { return table[static_cast<std::ptrdiff_t>(index[i])]; });
  }
};

}  // namespace strut
