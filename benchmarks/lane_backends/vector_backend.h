// Lane operations by GCC's vector extensions, the smallest possible lane type. Elementary functions
// are those of libmvec, part of glibc 2.35 and later on x86-64.
#pragma once

#include <cstddef>
#include <cstring>

#include "base/math/lanes.h"

#ifdef __AVX512F__
#define STRUT_VECTOR_BYTES 64
#define STRUT_LIBMVEC(function) _ZGVeN8v_##function
#else
#define STRUT_VECTOR_BYTES 32
#define STRUT_LIBMVEC(function) _ZGVdN4v_##function
#endif

namespace strut {

using VectorOfDoubles = double __attribute__((vector_size(STRUT_VECTOR_BYTES)));

extern "C" {
VectorOfDoubles STRUT_LIBMVEC(sin)(VectorOfDoubles);
VectorOfDoubles STRUT_LIBMVEC(cos)(VectorOfDoubles);
VectorOfDoubles STRUT_LIBMVEC(atan)(VectorOfDoubles);
VectorOfDoubles STRUT_LIBMVEC(exp)(VectorOfDoubles);
}

struct VectorBackend {
  using Vector = VectorOfDoubles;
  using MaskVector = decltype(Vector{} < Vector{});
  static constexpr int kWidth = STRUT_VECTOR_BYTES / 8;

  /// Applies a scalar function to every element; the compiler vectorizes it.
  template <class Function>
  static Vector map(Vector a, Function function) {
    Vector out{};
    for (int i = 0; i < kWidth; ++i) out[i] = function(a[i]);
    return out;
  }

  static Vector broadcast(double x) { return x - Vector{}; }
  static Vector load(const double* p) {
    Vector a;
    std::memcpy(&a, p, sizeof a);
    return a;
  }
  static void store(double* p, Vector a) { std::memcpy(p, &a, sizeof a); }
  static Vector add(Vector a, Vector b) { return a + b; }
  static Vector sub(Vector a, Vector b) { return a - b; }
  static Vector mul(Vector a, Vector b) { return a * b; }
  static Vector div(Vector a, Vector b) { return a / b; }
  static Vector neg(Vector a) { return -a; }
  static MaskVector less(Vector a, Vector b) { return a < b; }
  static MaskVector less_equal(Vector a, Vector b) { return a <= b; }
  static MaskVector mask_and(MaskVector a, MaskVector b) { return a & b; }
  static MaskVector mask_or(MaskVector a, MaskVector b) { return a | b; }
  static MaskVector mask_not(MaskVector a) { return ~a; }
  static bool any(MaskVector a) {
    long long bits = 0;
    for (int i = 0; i < kWidth; ++i) bits |= a[i];
    return bits != 0;
  }
  static bool all(MaskVector a) { return !any(~a); }
  static Vector select(MaskVector m, Vector a, Vector b) { return m ? a : b; }
  static Vector abs(Vector a) {
    return map(a, [](double x) { return __builtin_fabs(x); });
  }
  static Vector sqrt(Vector a) {
    return map(a, [](double x) { return __builtin_sqrt(x); });
  }
  static Vector min(Vector a, Vector b) { return b < a ? b : a; }
  static Vector max(Vector a, Vector b) { return a < b ? b : a; }
  static Vector floor(Vector a) {
    return map(a, [](double x) { return __builtin_floor(x); });
  }
  static Vector sin(Vector a) { return STRUT_LIBMVEC(sin)(a); }
  static Vector cos(Vector a) { return STRUT_LIBMVEC(cos)(a); }
  static Vector atan(Vector a) { return STRUT_LIBMVEC(atan)(a); }
  static Vector exp(Vector a) { return STRUT_LIBMVEC(exp)(a); }
  static void sin_cos(Vector a, Vector& s, Vector& c) {
    s = sin(a);
    c = cos(a);
  }
  static Vector gather(const double* table, Vector index) {
    return map(index, [table](double i) { return table[static_cast<std::ptrdiff_t>(i)]; });
  }
};

}  // namespace strut
#undef STRUT_LIBMVEC
#undef STRUT_VECTOR_BYTES
