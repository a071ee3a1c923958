// Two values evaluated in step: the left and right wheel of an axle.
//
// Long chains of dependent operations (the arctangents of the tire) leave a processor waiting.
// Evaluating two wheels at once gives it a second, independent chain to work on.
#pragma once

#include "base/math/lanes.h"

namespace strut {

template <class Mask>
struct PairMask {
  Mask a, b;
  friend PairMask operator&(PairMask x, PairMask y) { return {x.a & y.a, x.b & y.b}; }
  friend PairMask operator|(PairMask x, PairMask y) { return {x.a | y.a, x.b | y.b}; }
  friend PairMask operator!(PairMask x) { return {!x.a, !x.b}; }
};

/// A number that stands for both values of a Pair<T>.
template <class Number, class T>
concept SingleOf = std::is_convertible_v<Number, T>;

/// Two values of T; arithmetic is by element. A T or a double stands for both.
template <class T>
struct Pair {
  using Mask = PairMask<MaskOf<T>>;
  T a, b;

  Pair() = default;
  Pair(const T& first, const T& second) : a(first), b(second) {}
  Pair(const T& both) : a(both), b(both) {}  // NOLINT: a T stands for both
  template <SingleOf<T> Number>
  requires(!std::is_same_v<T, Number>) Pair(const Number& both)
      : a(both), b(both) {}  // NOLINT: so does a number

  friend Pair operator+(const Pair& x, const Pair& y) { return {x.a + y.a, x.b + y.b}; }
  friend Pair operator-(const Pair& x, const Pair& y) { return {x.a - y.a, x.b - y.b}; }
  friend Pair operator*(const Pair& x, const Pair& y) { return {x.a * y.a, x.b * y.b}; }
  friend Pair operator/(const Pair& x, const Pair& y) { return {x.a / y.a, x.b / y.b}; }
  friend Pair operator-(const Pair& x) { return {-x.a, -x.b}; }
  template <SingleOf<T> S>
  friend Pair operator+(const S& s, const Pair& x) {
    return {s + x.a, s + x.b};
  }
  template <SingleOf<T> S>
  friend Pair operator+(const Pair& x, const S& s) {
    return {x.a + s, x.b + s};
  }
  template <SingleOf<T> S>
  friend Pair operator-(const S& s, const Pair& x) {
    return {s - x.a, s - x.b};
  }
  template <SingleOf<T> S>
  friend Pair operator-(const Pair& x, const S& s) {
    return {x.a - s, x.b - s};
  }
  template <SingleOf<T> S>
  friend Pair operator*(const S& s, const Pair& x) {
    return {s * x.a, s * x.b};
  }
  template <SingleOf<T> S>
  friend Pair operator*(const Pair& x, const S& s) {
    return {x.a * s, x.b * s};
  }
  template <SingleOf<T> S>
  friend Pair operator/(const S& s, const Pair& x) {
    return {s / x.a, s / x.b};
  }
  template <SingleOf<T> S>
  friend Pair operator/(const Pair& x, const S& s) {
    return {x.a / s, x.b / s};
  }
  Pair& operator+=(const Pair& y) { return *this = *this + y; }
  Pair& operator-=(const Pair& y) { return *this = *this - y; }
  Pair& operator*=(const Pair& y) { return *this = *this * y; }

  friend Mask operator<(const Pair& x, const Pair& y) { return {x.a < y.a, x.b < y.b}; }
  friend Mask operator>(const Pair& x, const Pair& y) { return {x.a > y.a, x.b > y.b}; }
  friend Mask operator<=(const Pair& x, const Pair& y) { return {x.a <= y.a, x.b <= y.b}; }
  friend Mask operator>=(const Pair& x, const Pair& y) { return {x.a >= y.a, x.b >= y.b}; }

  friend Pair abs(const Pair& x) { return {abs(x.a), abs(x.b)}; }
  friend Pair sqrt(const Pair& x) { return {sqrt(x.a), sqrt(x.b)}; }
  friend Pair exp(const Pair& x) { return {exp(x.a), exp(x.b)}; }
  friend Pair min(const Pair& x, const Pair& y) { return {min(x.a, y.a), min(x.b, y.b)}; }
  friend Pair max(const Pair& x, const Pair& y) { return {max(x.a, y.a), max(x.b, y.b)}; }
  friend Pair floor(const Pair& x) { return {floor(x.a), floor(x.b)}; }
  friend Pair select(const Mask& mask, const Pair& x, const Pair& y) {
    return {select(mask.a, x.a, y.a), select(mask.b, x.b, y.b)};
  }
};

/// Makes one struct of pairs from two structs, field by field; all fields of `X<T>` are of type T.
template <template <class> class X, class T>
X<Pair<T>> join_pair(const X<T>& a, const X<T>& b) {
  constexpr std::size_t kFields = sizeof(X<T>) / sizeof(T);
  static_assert(sizeof(X<Pair<T>>) == 2 * kFields * sizeof(T));
  X<Pair<T>> pair;
  auto* out = reinterpret_cast<unsigned char*>(&pair);
  for (std::size_t i = 0; i < kFields; ++i) {
    __builtin_memcpy(out + 2 * i * sizeof(T),
                     reinterpret_cast<const unsigned char*>(&a) + i * sizeof(T), sizeof(T));
    __builtin_memcpy(out + (2 * i + 1) * sizeof(T),
                     reinterpret_cast<const unsigned char*>(&b) + i * sizeof(T), sizeof(T));
  }
  return pair;
}

/// The inverse of join_pair.
template <template <class> class X, class T>
void split_pair(const X<Pair<T>>& pair, X<T>& a, X<T>& b) {
  constexpr std::size_t kFields = sizeof(X<T>) / sizeof(T);
  const auto* in = reinterpret_cast<const unsigned char*>(&pair);
  for (std::size_t i = 0; i < kFields; ++i) {
    __builtin_memcpy(reinterpret_cast<unsigned char*>(&a) + i * sizeof(T), in + 2 * i * sizeof(T),
                     sizeof(T));
    __builtin_memcpy(reinterpret_cast<unsigned char*>(&b) + i * sizeof(T),
                     in + (2 * i + 1) * sizeof(T), sizeof(T));
  }
}

}  // namespace strut
