// Derivatives of a trim by the implicit function theorem: of r(u, p) = 0,
//
//   du/dp = -(dr/du)^-1 dr/dp
//
// with both derivatives of r by its duals.
#pragma once

#include "base/math/dual.h"
#include "base/math/linalg.h"
#include "model/car/trim_equations.h"

namespace strut {

/// The unknowns at the state of a trim of steady rolling; the inverse of make_trim_state.
template <class T, std::size_t N, class C>
std::array<Dual<T, N>, TrimIndex::kCount> find_trim_unknowns(const TrimProblem<Dual<T, N>, C>& p,
                                                             const State<Dual<T, N>>& state) {
  using I = StateIndex;
  using U = TrimIndex;
  const auto get = [&](int component) { return state[static_cast<std::size_t>(component)].v; };
  const T whole = get(I::kQuaternion);
  std::array<Dual<T, N>, U::kCount> u;
  u[U::kHeight] = (get(I::kPosition + 2) - p.center_height.v) * T(1.0 / kTrimLength);
  u[U::kRoll] = T(2.0 / kTrimAngle) * atan(get(I::kQuaternion + 1) / whole);
  u[U::kPitch] = T(2.0 / kTrimAngle) * atan(get(I::kQuaternion + 2) / whole);
  for (int c = 0; c < kCorners; ++c) {
    u[U::kCorner + c] = get(I::kCorner + c) * T(1.0 / kTrimLength);
    const T free = p.speed.v / p.vehicle->numbers.tire[axle_of(c)].radius.v;
    u[U::kSpinSlip + c] = (get(I::kSpin + c) / free - T(1.0)) * T(1.0 / kTrimSlip);
  }
  return u;
}

/// Sets the derivatives of a trim's state, whose values are given.
template <class T, std::size_t N, class C>
void differentiate_trim(TrimProblem<Dual<T, N>, C> p, State<Dual<T, N>>& state) {
  using D = Dual<T, N>;
  constexpr std::size_t kCount = TrimIndex::kCount;
  std::array<D, kCount> u = find_trim_unknowns(p, state), r;
  calc_trim_residual(p, u.data(), r.data());
  const std::array<D, kCount> at_rest = r;
  SquareMatrix<T, kCount> jacobian;
  for (std::size_t first = 0; first < kCount; first += N) {
    std::array<D, kCount> seeded = u;
    for (std::size_t i = 0; i < N && first + i < kCount; ++i) seeded[first + i].d[i] = T(1.0);
    calc_trim_residual(p, seeded.data(), r.data());
    for (std::size_t i = 0; i < N && first + i < kCount; ++i) {
      for (std::size_t row = 0; row < kCount; ++row) {
        jacobian[row][first + i] = r[row].d[i] - at_rest[row].d[i];
      }
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    SquareMatrix<T, kCount> a = jacobian;
    std::array<T, kCount> slope;
    for (std::size_t row = 0; row < kCount; ++row) slope[row] = -at_rest[row].d[i];
    solve_pivoted(a, slope);
    for (std::size_t row = 0; row < kCount; ++row) u[row].d[i] = slope[row];
  }
  const State<D> moved = calc_trim_residual(p, u.data(), r.data());
  for (std::size_t i = 0; i < state.size(); ++i) state[i].d = moved[i].d;
}

}  // namespace strut
