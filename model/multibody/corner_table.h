// A corner's motion functions as polynomials in its one coordinate.
//
// With a fixed steering rack, all motion functions of a corner depend on q only and are analytic
// over the travel, so one polynomial per function serves every simulation: no gathers, no Newton,
// no trigonometry. Derivatives are those of the polynomials, so the tabulated car is an exactly
// consistent mechanical system. Tests compare it with the Newton closure.
#pragma once

#include "base/math/dual.h"
#include "model/multibody/corner.h"

namespace strut {

inline constexpr int kTableTerms = 20;  // capacity; the degrees in use are in CornerDegrees
/// Relative size below which Chebyshev coefficients are dropped.
inline constexpr long double kTableTolerance = 1e-11L;

/// Tabulated functions, grouped by the number of derivatives that the equations need.
inline constexpr int kTwiceFunctions = 3;  // moment
inline constexpr int kOnceFunctions = 18;  // inertia 6, coupling 3, mass, center 3, axis 3, lines 2
inline constexpr int kPlainFunctions = 3;  // upright rate
inline constexpr int kInertiaFunctions = 9;  // the first functions of the once group

/// Degree in use, by group of functions.
struct CornerDegrees {
  int moment = 0, inertia = 0, place = 0, rate = 0;
};

/// Coefficients by power of q [m], lowest first. C is double where all lanes share one geometry and
/// inertia, else the lane type.
template <class C>
struct CornerCoefficients {
  std::array<std::array<C, kTwiceFunctions>, kTableTerms> twice;
  std::array<std::array<C, kOnceFunctions>, kTableTerms> once;
  std::array<std::array<C, kPlainFunctions>, kTableTerms> plain;
};

/// Horner's scheme for `Count` of the N polynomials from `first` on, with their first `Order`
/// derivatives: derivative[order][function]. Value and slope of nine functions fit the 32 registers
/// of AVX-512.
template <int Order, int Count, std::size_t N, class C, class T>
inline void evaluate_group(const std::array<std::array<C, N>, kTableTerms>& coefficient,
                           std::size_t first, int degree, const T& x,
                           std::array<std::array<T, Count>, Order + 1>& derivative) {
  const auto top = static_cast<std::size_t>(degree);
  if (top == 0) {
    for (std::size_t f = 0; f < Count; ++f) {
      derivative[0][f] = T(coefficient[0][first + f]);
      for (int order = 1; order <= Order; ++order) derivative[order][f] = T(0.0);
    }
    return;
  }
  for (std::size_t f = 0; f < Count; ++f) {
    const T highest(coefficient[top][first + f]);
    derivative[0][f] = highest * x + T(coefficient[top - 1][first + f]);
    if constexpr (Order >= 1) derivative[1][f] = highest;
    for (int order = 2; order <= Order; ++order) derivative[order][f] = T(0.0);
  }
  for (std::size_t power = top - 1; power-- > 0;) {
    const std::array<C, N>& row = coefficient[power];
    for (std::size_t f = 0; f < Count; ++f) {
      for (int order = Order; order >= 1; --order) {
        derivative[order][f] = derivative[order][f] * x + derivative[order - 1][f];
      }
      derivative[0][f] = derivative[0][f] * x + T(row[first + f]);
    }
  }
  double factorial = 1.0;
  for (int order = 2; order <= Order; ++order) {
    factorial *= order;
    for (std::size_t f = 0; f < Count; ++f) derivative[order][f] *= T(factorial);
  }
}

/// Values of `Count` functions at q with their first `Order` derivatives by q, by derivative; of a
/// dual q by one polynomial more for each function, which costs less than carrying its directions
/// through all of them.
template <int Order, int Count, std::size_t N, class C, class T>
std::array<std::array<T, Count>, Order + 1> evaluate_functions(
    const std::array<std::array<C, N>, kTableTerms>& coefficient, std::size_t first, int degree,
    const T& q) {
  std::array<std::array<T, Count>, Order + 1> derivative;
  evaluate_group<Order, Count>(coefficient, first, degree, q, derivative);
  return derivative;
}
template <int Order, int Count, std::size_t N, class C, class T, std::size_t Directions>
std::array<std::array<Dual<T, Directions>, Count>, Order + 1> evaluate_functions(
    const std::array<std::array<C, N>, kTableTerms>& coefficient, std::size_t first, int degree,
    const Dual<T, Directions>& q) {
  std::array<std::array<T, Count>, Order + 2> value;
  evaluate_group<Order + 1, Count>(coefficient, first, degree, q.v, value);
  std::array<std::array<Dual<T, Directions>, Count>, Order + 1> derivative;
  for (std::size_t order = 0; order <= Order; ++order) {
    for (std::size_t f = 0; f < Count; ++f) {
      derivative[order][f] = Dual<T, Directions>::chain(value[order][f], value[order + 1][f], q);
    }
  }
  return derivative;
}

/// Motion functions at q from the table, except center_qq (update_center_acceleration).
template <class T, class C>
void update_corner_motion(const CornerCoefficients<C>& table, const CornerDegrees& degree,
                          const T& q, CornerMotion<T>& motion) {
  const auto [m, m_q, m_qq] = evaluate_functions<2, 3>(table.twice, 0, degree.moment, q);
  motion.moment = {m[0], m[1], m[2]};
  motion.moment_q = {m_q[0], m_q[1], m_q[2]};
  motion.moment_qq = {m_qq[0], m_qq[1], m_qq[2]};

  const auto [a, a_q] = evaluate_functions<1, 9>(table.once, 0, degree.inertia, q);
  motion.inertia = {a[0], a[1], a[2], a[3], a[4], a[5]};
  motion.inertia_q = {a_q[0], a_q[1], a_q[2], a_q[3], a_q[4], a_q[5]};
  motion.coupling = {a[6], a[7], a[8]};
  motion.coupling_q = {a_q[6], a_q[7], a_q[8]};
  const auto [b, b_q] = evaluate_functions<1, 9>(table.once, kInertiaFunctions, degree.place, q);
  motion.mass = b[0];
  motion.mass_q = b_q[0];
  motion.center = {b[1], b[2], b[3]};
  motion.center_q = {b_q[1], b_q[2], b_q[3]};
  motion.axis = {b[4], b[5], b[6]};
  motion.axis_q = {b_q[4], b_q[5], b_q[6]};
  motion.length = {b[7], b[8]};
  motion.length_q = {b_q[7], b_q[8]};
  const auto [w] = evaluate_functions<0, 3>(table.plain, 0, degree.rate, q);
  motion.upright_rate = {w[0], w[1], w[2]};
}

/// Second derivative of the wheel center, used for output only.
template <class T, class C>
void update_center_acceleration(const CornerCoefficients<C>& table, const CornerDegrees& degree,
                                const T& q, CornerMotion<T>& motion) {
  const auto [c, c_q, c_qq] =
      evaluate_functions<2, 3>(table.once, kInertiaFunctions + 1, degree.place, q);
  motion.center_qq = {c_qq[0], c_qq[1], c_qq[2]};
}

/// Wheel center with its slope, and spin axis, for the location of contact events.
template <class T, class C>
void update_wheel_place(const CornerCoefficients<C>& table, const CornerDegrees& degree, const T& q,
                        CornerMotion<T>& motion) {
  const auto [b, b_q] =
      evaluate_functions<1, 6>(table.once, kInertiaFunctions + 1, degree.place, q);
  motion.center = {b[0], b[1], b[2]};
  motion.center_q = {b_q[0], b_q[1], b_q[2]};
  motion.axis = {b[3], b[4], b[5]};
}

/// The tabulated functions of a motion, in table order.
template <class T>
void collect_functions(const CornerMotion<T>& motion, std::array<T, kTwiceFunctions>& twice,
                       std::array<T, kOnceFunctions>& once, std::array<T, kPlainFunctions>& plain) {
  const Sym3<T>& j = motion.inertia;
  const Vec3<T>&b = motion.coupling, &c = motion.center, &u = motion.axis;
  twice = {motion.moment.x, motion.moment.y, motion.moment.z};
  once = {j.xx,
          j.yy,
          j.zz,
          j.xy,
          j.xz,
          j.yz,
          b.x,
          b.y,
          b.z,
          motion.mass,
          c.x,
          c.y,
          c.z,
          u.x,
          u.y,
          u.z,
          motion.length[0],
          motion.length[1]};
  plain = {motion.upright_rate.x, motion.upright_rate.y, motion.upright_rate.z};
}

}  // namespace strut
