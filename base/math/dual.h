// A number with its derivatives along N directions, for forward differentiation in lanes.
#pragma once

#include <array>

#include "base/math/bounded_trig.h"
#include "base/math/pair.h"

namespace strut {

/// A number that has no derivatives beside those of Dual<T, N>.
template <class S, class T>
concept PassiveFor = std::is_same_v<S, T> || std::is_arithmetic_v<S>;

/// Value and derivatives along N directions; T is `double` or lanes. Comparisons are of values, so
/// that a differentiated run takes the branches of the run itself.
template <class T, std::size_t N>
struct Dual {
  using Mask = MaskOf<T>;
  static constexpr int kWidth = kLaneCount<T>;

  T v;                 // value
  std::array<T, N> d;  // derivatives

  Dual() = default;
  Dual(double value) : Dual(T(value)) {}  // NOLINT: constants mix freely, as with lanes
  Dual(const T& value) requires(!std::is_same_v<T, double>) : v(value) {
    d.fill(T(0.0));
  }  // NOLINT

  /// The value with the derivatives slope * x.d.
  static Dual chain(const T& value, const T& slope, const Dual& x) {
    Dual y;
    y.v = value;
    for (std::size_t i = 0; i < N; ++i) y.d[i] = slope * x.d[i];
    return y;
  }

  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual y;
    y.v = a.v + b.v;
    for (std::size_t i = 0; i < N; ++i) y.d[i] = a.d[i] + b.d[i];
    return y;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual y;
    y.v = a.v - b.v;
    for (std::size_t i = 0; i < N; ++i) y.d[i] = a.d[i] - b.d[i];
    return y;
  }
  friend Dual operator-(const Dual& a) {
    Dual y;
    y.v = -a.v;
    for (std::size_t i = 0; i < N; ++i) y.d[i] = -a.d[i];
    return y;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual y;
    y.v = a.v * b.v;
    for (std::size_t i = 0; i < N; ++i) y.d[i] = a.v * b.d[i] + b.v * a.d[i];
    return y;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = T(1.0) / b.v;
    Dual y;
    y.v = a.v / b.v;
    for (std::size_t i = 0; i < N; ++i) y.d[i] = (a.d[i] - y.v * b.d[i]) * inverse;
    return y;
  }
  // Numbers without derivatives.
  template <PassiveFor<T> S>
  friend Dual operator+(const Dual& a, const S& b) {
    Dual y = a;
    y.v = a.v + T(b);
    return y;
  }
  template <PassiveFor<T> S>
  friend Dual operator+(const S& a, const Dual& b) {
    return b + a;
  }
  template <PassiveFor<T> S>
  friend Dual operator-(const Dual& a, const S& b) {
    Dual y = a;
    y.v = a.v - T(b);
    return y;
  }
  template <PassiveFor<T> S>
  friend Dual operator-(const S& a, const Dual& b) {
    Dual y = -b;
    y.v = T(a) - b.v;
    return y;
  }
  template <PassiveFor<T> S>
  friend Dual operator*(const S& a, const Dual& b) {
    return chain(T(a) * b.v, T(a), b);
  }
  template <PassiveFor<T> S>
  friend Dual operator*(const Dual& a, const S& b) {
    return b * a;
  }
  template <PassiveFor<T> S>
  friend Dual operator/(const Dual& a, const S& b) {
    return chain(a.v / T(b), T(1.0) / T(b), a);
  }
  template <PassiveFor<T> S>
  friend Dual operator/(const S& a, const Dual& b) {
    const T inverse = T(1.0) / b.v, value = T(a) * inverse;
    return chain(value, -value * inverse, b);
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend Mask operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend Mask operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend Mask operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend Mask operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }

  friend Dual select(const Mask& mask, const Dual& a, const Dual& b) {
    Dual y;
    y.v = select(mask, a.v, b.v);
    for (std::size_t i = 0; i < N; ++i) y.d[i] = select(mask, a.d[i], b.d[i]);
    return y;
  }
  friend Dual min(const Dual& a, const Dual& b) { return select(b.v < a.v, b, a); }
  friend Dual max(const Dual& a, const Dual& b) { return select(a.v < b.v, b, a); }
  friend Dual abs(const Dual& a) {
    return chain(abs(a.v), select(a.v < T(0.0), T(-1.0), T(1.0)), a);
  }
  friend Dual floor(const Dual& a) { return Dual(floor(a.v)); }
  friend Dual sqrt(const Dual& a) {
    const T root = sqrt(a.v);
    // At zero, where the slope is infinite, the derivatives are zero, as those of abs are
    // one-sided.
    return chain(root, select(root > T(0.0), T(0.5) / root, T(0.0)), a);
  }
  friend Dual exp(const Dual& a) {
    const T value = exp(a.v);
    return chain(value, value, a);
  }
  friend Dual atan(const Dual& a) { return chain(atan(a.v), T(1.0) / (T(1.0) + a.v * a.v), a); }
  friend void sin_cos(const Dual& a, Dual& s, Dual& c) {
    T sine, cosine;
    sin_cos(a.v, sine, cosine);
    s = chain(sine, cosine, a);
    c = chain(cosine, -sine, a);
  }
  friend Dual cos(const Dual& a) {
    Dual s, c;
    sin_cos(a, s, c);
    return c;
  }
  friend Dual gather(const double* table, const Dual& index) {
    return Dual(gather(table, index.v));
  }
  friend double get_lane(const Dual& a, int lane) { return get_lane(a.v, lane); }
  friend void set_lane(Dual& a, int lane, double value) { set_lane(a.v, lane, value); }
};

template <class T, std::size_t N>
inline constexpr std::size_t kDirectionCount<Dual<T, N>> = N;
template <class T>
concept HasDerivatives = (kDirectionCount<T> > 0);

template <class T, std::size_t N>
double get_slope(const Dual<T, N>& x, std::size_t direction, int lane) {
  return get_lane(x.d[direction], lane);
}

template <class T, std::size_t N>
bool all_equal(const Dual<T, N>& a, const Dual<T, N>& b) {
  bool equal = all_equal(a.v, b.v);
  for (std::size_t i = 0; i < a.d.size(); ++i) equal = equal && all_equal(a.d[i], b.d[i]);
  return equal;
}

/// Joins the fields of a struct with those of its derivatives; `X<T>` and `X<Dual<T, N>>` hold the
/// same fields in the same order, all of their scalar type.
template <template <class> class X, class T, std::size_t N>
X<Dual<T, N>> join_dual(const X<T>& value, const std::array<X<T>, N>& slopes) {
  using D = Dual<T, N>;
  static_assert(std::is_trivially_copyable_v<X<T>> && std::is_trivially_copyable_v<X<D>>);
  constexpr std::size_t kFields = sizeof(X<T>) / sizeof(T);
  static_assert(sizeof(X<D>) == kFields * sizeof(D));
  X<D> joined;
  auto* out = reinterpret_cast<unsigned char*>(&joined);
  const auto copy = [&](std::size_t to, const X<T>& from, std::size_t field) {
    __builtin_memcpy(out + to * sizeof(T),
                     reinterpret_cast<const unsigned char*>(&from) + field * sizeof(T), sizeof(T));
  };
  for (std::size_t field = 0; field < kFields; ++field) {
    copy(field * (N + 1), value, field);
    for (std::size_t i = 0; i < N; ++i) copy(field * (N + 1) + 1 + i, slopes[i], field);
  }
  return joined;
}

/// Adds a struct of derivatives along one direction to that of the duals, field by field.
template <template <class> class X, class T, std::size_t N>
void add_slope(const X<T>& slope, std::size_t direction, X<Dual<T, N>>& x) {
  constexpr std::size_t kFields = sizeof(X<T>) / sizeof(T);
  static_assert(sizeof(x) == kFields * sizeof(Dual<T, N>));
  const auto* in = reinterpret_cast<const T*>(&slope);
  auto* out = reinterpret_cast<Dual<T, N>*>(&x);
  for (std::size_t field = 0; field < kFields; ++field) out[field].d[direction] += in[field];
}

/// T without derivatives.
template <class T>
struct WithoutDerivatives {
  using Type = T;
};
template <class T, std::size_t N>
struct WithoutDerivatives<Dual<T, N>> {
  using Type = T;
};
template <class T>
using Passive = typename WithoutDerivatives<T>::Type;

/// `calc(value)` with its slope at x, for Dual and for pairs of them.
template <class T, std::size_t N, class Function, class Slope>
Dual<T, N> chain_rule(const Dual<T, N>& x, const Function& calc, const Slope& calc_slope) {
  return Dual<T, N>::chain(calc(x.v), calc_slope(x.v), x);
}
template <class T, std::size_t N, class Function, class Slope>
Pair<Dual<T, N>> chain_rule(const Pair<Dual<T, N>>& x, const Function& calc,
                            const Slope& calc_slope) {
  const Pair<T> at(x.a.v, x.b.v), value = calc(at), slope = calc_slope(at);
  return {Dual<T, N>::chain(value.a, slope.a, x.a), Dual<T, N>::chain(value.b, slope.b, x.b)};
}

template <class X>
inline constexpr bool kIsDual = false;
template <class T, std::size_t N>
inline constexpr bool kIsDual<Dual<T, N>> = true;
template <class T, std::size_t N>
inline constexpr bool kIsDual<Pair<Dual<T, N>>> = true;
template <class X>
concept DualNumber = kIsDual<X>;

template <DualNumber X>
X atan_any(const X& x) {
  return chain_rule(
      x, [](const auto& v) { return atan_any(v); },
      [](const auto& v) { return 1.0 / (1.0 + v * v); });
}
template <DualNumber X>
X atan_small(const X& x) {
  return chain_rule(
      x, [](const auto& v) { return atan_small(v); },
      [](const auto& v) { return 1.0 / (1.0 + v * v); });
}
template <DualNumber X>
X sin_bounded(const X& x) {
  return chain_rule(
      x, [](const auto& v) { return sin_bounded(v); },
      [](const auto& v) { return cos_bounded(v); });
}
template <DualNumber X>
X cos_bounded(const X& x) {
  return chain_rule(
      x, [](const auto& v) { return cos_bounded(v); },
      [](const auto& v) { return -sin_bounded(v); });
}
template <DualNumber X>
X cos_small(const X& x) {
  return chain_rule(
      x, [](const auto& v) { return cos_small(v); }, [](const auto& v) { return -sin_bounded(v); });
}

}  // namespace strut
