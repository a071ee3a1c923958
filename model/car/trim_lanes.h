// Trims of W cars at once, each in its own lane: Newton's method on the equations of
// trim_equations.h.
#pragma once

#include "base/math/linalg.h"
#include "model/car/trim_equations.h"

namespace strut {

template <class T>
struct LaneTrim {
  State<T> state;
  T residual;       // m/s^2, maximum
  T travel_excess;  // m; above 0 beyond the travel

  MaskOf<T> is_found() const {
    return (residual < T(kMaxTrimResidual)) & (travel_excess <= T(0.0));
  }
};

/// Finds steady rolling on flat ground (trim.h, solve_rolling). A lane's result does not depend on
/// the other lanes. Where a lane is not found, it has no equilibrium within the travel, or needs
/// the line search of solve_rolling.
template <class T, class C>
class LaneTrimmer {
 public:
  explicit LaneTrimmer(const TrimProblem<T, C>& problem) : p_(problem) {}

  LaneTrim<T> solve() {
    constexpr int kIterations = 20;
    constexpr double kEnough = 1e-10;  // m/s^2, above the rounding of forces
    constexpr double kSlow = 0.05;     // of the residual, that an old Jacobian may leave
    u_.fill(T(0.0));
    T before(0.0), error = evaluate();
    for (int i = 0; i < kIterations; ++i) {
      const Mask open = error > T(kEnough);
      if (!any(open)) break;
      renew_jacobian(open & (error > T(kSlow) * before));
      step(open);
      before = error;
      error = evaluate();
    }
    return {state_, error, p_.workspace.travel_excess};
  }

 private:
  static constexpr int N = TrimIndex::kCount;
  using Mask = MaskOf<T>;

  /// Residual and state at u; returns the largest residual, NaN where one is not finite.
  T evaluate() {
    state_ = calc_trim_residual(p_, u_.data(), r_.data());
    T error(0.0), zero(0.0);
    for (const T& r : r_) {
      error = max(error, abs(r));
      zero += r - r;  // NaN where r is not finite
    }
    return error + zero;
  }

  /// By forward differences.
  void renew_jacobian(Mask lanes) {
    constexpr double kStep = 1e-6;
    if (!any(lanes)) return;
    std::array<T, N> moved;
    for (int j = 0; j < N; ++j) {
      std::array<T, N> u = u_;
      u[j] = u[j] + T(kStep);
      calc_trim_residual(p_, u.data(), moved.data());
      for (int i = 0; i < N; ++i) {
        jacobian_[i][j] = select(lanes, (moved[i] - r_[i]) * T(1.0 / kStep), jacobian_[i][j]);
      }
    }
  }

  void step(Mask lanes) {
    SquareMatrix<T, N> a = jacobian_;
    std::array<T, N> du = r_;
    solve_pivoted(a, du);
    for (int i = 0; i < N; ++i) u_[i] = select(lanes, u_[i] - du[i], u_[i]);
  }

  TrimProblem<T, C> p_;
  std::array<T, N> u_, r_;
  SquareMatrix<T, N> jacobian_{};
  State<T> state_;
};

}  // namespace strut
