// Sine, cosine and arctangent for arguments whose bounds are known.
//
// The tire evaluates about twenty of them per wheel. The general functions of a vector library
// reduce large arguments and take up to three divisions each; here the arctangent takes one
// division, sine and cosine none. The polynomials interpolate atan(sqrt z)/sqrt z on [0, 1] and
// sin(sqrt z)/sqrt z on [0, (pi/2)^2] at the Chebyshev nodes, computed in 50 digits; truncation
// errors are 1.3e-15 and 3e-19. Small arguments use Taylor series.
#pragma once

#include <array>
#include <cstddef>

#include "base/math/lanes.h"

namespace strut {

namespace bounded_trig {

inline constexpr double kPi = 3.14159265358979323846;

inline constexpr std::array<double, 18> kAtan = {
    0.9999999999999988,    -0.33333333333253284,  0.19999999991319195,  -0.14285713910426773,
    0.11111102499422242,   -0.09090787968013053,  0.07691170067941966,  -0.06659119943643073,
    0.05845587712383866,   -0.051278290246137094, 0.04377190010711523,  -0.034874503444929254,
    0.02458916421806469,   -0.014458808736889693, 0.006642618398837011, -0.0021983905110338,
    0.0004611471226395625, -4.572466752859746e-05};
inline constexpr std::array<double, 9> kSin = {1.0,
                                               -0.16666666666666666,
                                               0.008333333333333165,
                                               -0.00019841269841200994,
                                               2.7557319209909048e-06,
                                               -2.5052106768133637e-08,
                                               1.605893462678577e-10,
                                               -7.642861177610004e-13,
                                               2.7198054490294612e-15};
inline constexpr std::array<double, 8> kAtanSmall = {1.0,     -1.0 / 3,  1.0 / 5,  -1.0 / 7,
                                                     1.0 / 9, -1.0 / 11, 1.0 / 13, -1.0 / 15};
inline constexpr std::array<double, 6> kCosSmall = {1.0,        -1.0 / 2,    1.0 / 24,
                                                    -1.0 / 720, 1.0 / 40320, -1.0 / 3628800};

/// sum over k of c[k] z^k. Even and odd terms are evaluated by separate Horner schemes, which
/// halves the chain of dependent operations.
template <class T, std::size_t N>
[[gnu::always_inline]] inline T calc_polynomial(const std::array<double, N>& c, const T& z) {
  constexpr std::size_t kLastEven = (N - 1) / 2 * 2;
  constexpr std::size_t kLastOdd = N / 2 * 2 - 1;
  const T z2 = z * z;
  T even(c[kLastEven]), odd(c[kLastOdd]);
#pragma GCC unroll 16
  for (std::size_t k = kLastEven; k >= 2; k -= 2) even = even * z2 + c[k - 2];
#pragma GCC unroll 16
  for (std::size_t k = kLastOdd; k >= 3; k -= 2) odd = odd * z2 + c[k - 2];
  return odd * z + even;
}

/// sin r for |r| <= pi/2.
template <class T>
[[gnu::always_inline]] inline T sin_quarter(const T& r) {
  return r * calc_polynomial(kSin, r * r);
}

}  // namespace bounded_trig

/// arctan(y/x) for x >= 0, y >= 0, not both zero [rad]; absolute error below 3e-15.
template <class T>
[[gnu::always_inline]] inline T atan_quadrant(const T& y, const T& x) {
  const auto steep = x < y;
  const T t = select(steep, -x, y) / select(steep, y, x);
  const T offset = select(steep, T(bounded_trig::kPi / 2.0), T(0.0));
  return t * bounded_trig::calc_polynomial(bounded_trig::kAtan, t * t) + offset;
}

/// arctan x for any x [rad]; absolute error below 3e-15, odd to the last bit.
template <class T>
[[gnu::always_inline]] inline T atan_any(const T& x) {
  const auto steep = T(1.0) < abs(x);
  const T t = select(steep, T(-1.0), x) / select(steep, x, T(1.0));
  const T quarter = select(x < T(0.0), T(-bounded_trig::kPi / 2.0), T(bounded_trig::kPi / 2.0));
  return t * bounded_trig::calc_polynomial(bounded_trig::kAtan, t * t) +
         select(steep, quarter, T(0.0));
}

/// arctan x for |x| <= 0.12 [rad]; relative error below 3e-16.
template <class T>
[[gnu::always_inline]] inline T atan_small(const T& x) {
  return x * bounded_trig::calc_polynomial(bounded_trig::kAtanSmall, x * x);
}

/// sin x for |x| <= pi; absolute error below 4e-16.
template <class T>
[[gnu::always_inline]] inline T sin_bounded(const T& x) {
  using bounded_trig::kPi;
  return bounded_trig::sin_quarter(max(min(x, kPi - x), -kPi - x));
}

/// cos x for |x| <= pi; absolute error below 4e-16.
template <class T>
[[gnu::always_inline]] inline T cos_bounded(const T& x) {
  return bounded_trig::sin_quarter(bounded_trig::kPi / 2.0 - abs(x));
}

/// cos x for |x| <= 0.24; absolute error below 3e-16.
template <class T>
[[gnu::always_inline]] inline T cos_small(const T& x) {
  return bounded_trig::calc_polynomial(bounded_trig::kCosSmall, x * x);
}

}  // namespace strut
