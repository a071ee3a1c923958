// One scalar type for W simulations in lockstep.
//
// Physics is written once as a template over `T`; `T` is `double` or `Lanes<Backend>`. This header
// declares every operation on `T` that physics uses. Comparing lanes gives a mask that does not
// convert to `bool`, so a branch on a lane is a compile error; `select` replaces it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace strut {

// --- double: a lane vector of width one -----------------------------------------------------

using std::atan;
using std::cos;
using std::exp;
using std::floor;
using std::sin;
using std::sqrt;

inline double abs(double x) { return std::fabs(x); }
inline double min(double a, double b) { return b < a ? b : a; }
inline double max(double a, double b) { return a < b ? b : a; }
inline double select(bool mask, double if_true, double if_false) {
  return mask ? if_true : if_false;
}
inline bool any(bool mask) { return mask; }
inline bool all(bool mask) { return mask; }
inline void sin_cos(double x, double& s, double& c) {
  s = std::sin(x);
  c = std::cos(x);
}
inline double get_lane(double x, int /*lane*/) { return x; }
inline void set_lane(double& x, int /*lane*/, double value) { x = value; }
inline bool get_mask_lane(bool mask, int /*lane*/) { return mask; }
/// table[index], index holding whole numbers >= 0.
inline double gather(const double* table, double index) {
  return table[static_cast<std::ptrdiff_t>(index)];
}

// --- Lanes ----------------------------------------------------------------------------------

/// Comparison result of lanes: one truth value per simulation, no conversion to bool.
template <class Backend>
struct LaneMask {
  typename Backend::MaskVector m;

  friend LaneMask operator&(LaneMask a, LaneMask b) { return {Backend::mask_and(a.m, b.m)}; }
  friend LaneMask operator|(LaneMask a, LaneMask b) { return {Backend::mask_or(a.m, b.m)}; }
  friend LaneMask operator!(LaneMask a) { return {Backend::mask_not(a.m)}; }
  friend bool any(LaneMask a) { return Backend::any(a.m); }
  friend bool all(LaneMask a) { return Backend::all(a.m); }
  friend bool get_mask_lane(LaneMask a, int lane) {
    alignas(64) std::array<double, Backend::kWidth> values;
    Backend::store(values.data(),
                   Backend::select(a.m, Backend::broadcast(1.0), Backend::broadcast(0.0)));
    return values[static_cast<std::size_t>(lane)] > 0.5;
  }
};

/// W doubles, one per simulation. `Backend` supplies the vector type and its operations.
template <class Backend>
struct Lanes {
  using Mask = LaneMask<Backend>;
  static constexpr int kWidth = Backend::kWidth;

  typename Backend::Vector v;

  Lanes() = default;
  Lanes(double value) : v(Backend::broadcast(value)) {}  // NOLINT: constants mix freely with lanes
  explicit Lanes(typename Backend::Vector value, int) : v(value) {}
  static Lanes wrap(typename Backend::Vector value) { return Lanes(value, 0); }

  friend Lanes operator+(Lanes a, Lanes b) { return wrap(Backend::add(a.v, b.v)); }
  friend Lanes operator-(Lanes a, Lanes b) { return wrap(Backend::sub(a.v, b.v)); }
  friend Lanes operator*(Lanes a, Lanes b) { return wrap(Backend::mul(a.v, b.v)); }
  friend Lanes operator/(Lanes a, Lanes b) { return wrap(Backend::div(a.v, b.v)); }
  friend Lanes operator-(Lanes a) { return wrap(Backend::neg(a.v)); }
  Lanes& operator+=(Lanes b) { return *this = *this + b; }
  Lanes& operator-=(Lanes b) { return *this = *this - b; }
  Lanes& operator*=(Lanes b) { return *this = *this * b; }

  friend Mask operator<(Lanes a, Lanes b) { return {Backend::less(a.v, b.v)}; }
  friend Mask operator>(Lanes a, Lanes b) { return {Backend::less(b.v, a.v)}; }
  friend Mask operator<=(Lanes a, Lanes b) { return {Backend::less_equal(a.v, b.v)}; }
  friend Mask operator>=(Lanes a, Lanes b) { return {Backend::less_equal(b.v, a.v)}; }

  friend Lanes abs(Lanes a) { return wrap(Backend::abs(a.v)); }
  friend Lanes sqrt(Lanes a) { return wrap(Backend::sqrt(a.v)); }
  friend Lanes min(Lanes a, Lanes b) { return wrap(Backend::min(a.v, b.v)); }
  friend Lanes max(Lanes a, Lanes b) { return wrap(Backend::max(a.v, b.v)); }
  friend Lanes floor(Lanes a) { return wrap(Backend::floor(a.v)); }
  friend Lanes sin(Lanes a) { return wrap(Backend::sin(a.v)); }
  friend Lanes cos(Lanes a) { return wrap(Backend::cos(a.v)); }
  friend Lanes atan(Lanes a) { return wrap(Backend::atan(a.v)); }
  friend Lanes exp(Lanes a) { return wrap(Backend::exp(a.v)); }
  friend void sin_cos(Lanes a, Lanes& s, Lanes& c) { Backend::sin_cos(a.v, s.v, c.v); }
  friend Lanes select(Mask mask, Lanes if_true, Lanes if_false) {
    return wrap(Backend::select(mask.m, if_true.v, if_false.v));
  }
  friend Lanes gather(const double* table, Lanes index) {
    return wrap(Backend::gather(table, index.v));
  }

  friend double get_lane(Lanes a, int lane) {
    alignas(64) std::array<double, kWidth> values;
    Backend::store(values.data(), a.v);
    return values[static_cast<std::size_t>(lane)];
  }
  friend void set_lane(Lanes& a, int lane, double value) {
    alignas(64) std::array<double, kWidth> values;
    Backend::store(values.data(), a.v);
    values[static_cast<std::size_t>(lane)] = value;
    a.v = Backend::load(values.data());
  }
};

// --- traits of T for generic code -----------------------------------------------------------

template <class T>
struct ScalarTraits {
  static constexpr int kWidth = T::kWidth;
  using Mask = typename T::Mask;
};
template <>
struct ScalarTraits<double> {
  static constexpr int kWidth = 1;
  using Mask = bool;
};

/// Number of simulations in a `T`.
template <class T>
inline constexpr int kLaneCount = ScalarTraits<T>::kWidth;

template <class T>
using MaskOf = typename ScalarTraits<T>::Mask;

/// False in lanes that hold NaN or infinity.
template <class T>
MaskOf<T> is_finite(const T& x) {
  return abs(x) <= T(1.7976931348623157e308);
}

/// Whether two values are equal in every lane.
template <class T>
bool all_equal(const T& a, const T& b) {
  return all((a >= b) & (a <= b));
}

/// Number of directions along which a T carries derivatives (dual.h).
template <class T>
inline constexpr std::size_t kDirectionCount = 0;

/// Derivative along a direction in one lane; only duals have any.
template <class T>
double get_slope(const T& /*x*/, std::size_t /*direction*/, int /*lane*/) {
  return 0.0;
}

template <class T>
T square(const T& x) {
  return x * x;
}

/// Interleaves the fields of W plain structs of doubles into one struct of lanes: `X<double>` and
/// `X<T>` hold the same fields in the same order, all of their scalar type.
template <template <class> class X, class T>
X<T> pack_lanes(const X<double>* lanes) {
  static_assert(std::is_trivially_copyable_v<X<double>> && std::is_trivially_copyable_v<X<T>>);
  constexpr std::size_t kFields = sizeof(X<double>) / sizeof(double);
  static_assert(sizeof(X<T>) == kFields * sizeof(T));
  constexpr std::size_t kWidth = static_cast<std::size_t>(kLaneCount<T>);
  X<T> packed;
  auto* out = reinterpret_cast<unsigned char*>(&packed);
  for (std::size_t field = 0; field < kFields; ++field) {
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const auto* in = reinterpret_cast<const unsigned char*>(lanes + lane);
      __builtin_memcpy(out + (field * kWidth + lane) * sizeof(double), in + field * sizeof(double),
                       sizeof(double));
    }
  }
  return packed;
}

}  // namespace strut
