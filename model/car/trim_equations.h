// Equations of a trim: the weighted accelerations that vanish in equilibrium, for any lane type.
#pragma once

#include "model/car/closures.h"
#include "model/car/dynamics.h"
#include "model/car/state.h"

namespace strut {

/// Unknowns u of a trim, of order one, and its equations r: the acceleration of each unknown. At
/// rest the unknowns from kSpinSlip on do not exist.
struct TrimIndex {
  static constexpr int kHeight = 0, kRoll = 1, kPitch = 2;
  static constexpr int kCorner = 3;                     // a coordinate for each corner
  static constexpr int kSpinSlip = kCorner + kCorners;  // for each wheel the deviation from the
                                                        // speed of free rolling
  static constexpr int kCount = kSpinSlip + kCorners;
};

/// Units of the unknowns.
inline constexpr double kTrimLength = 1e-2;  // m
inline constexpr double kTrimAngle = 1e-2;   // rad
inline constexpr double kTrimSlip = 1e-2;    // of the speed of free rolling

/// Largest residual of an equilibrium [m/s^2].
inline constexpr double kMaxTrimResidual = 1e-8;

/// `C`: type of the tables' coefficients (closures.h).
template <class T, class C>
struct TrimProblem {
  const Vehicle<T>* vehicle;
  TableClosure<T, C> closure;
  T center_height;  // m, at nominal trim
  T speed;          // m/s
  bool rolling = true;
  Workspace<T> workspace{};

  int size() const { return rolling ? TrimIndex::kCount : TrimIndex::kSpinSlip; }
};

/// The state at the unknowns, with the slips of relaxing tires at zero.
template <class T, class C>
State<T> make_trim_state(const TrimProblem<T, C>& p, const T* u) {
  using I = StateIndex;
  using U = TrimIndex;
  State<T> x;
  x.fill(T(0.0));
  T cr, sr, cp, sp;
  sin_cos(T(0.5 * kTrimAngle) * u[U::kRoll], sr, cr);
  sin_cos(T(0.5 * kTrimAngle) * u[U::kPitch], sp, cp);
  x[I::kPosition + 2] = p.center_height + T(kTrimLength) * u[U::kHeight];
  x[I::kQuaternion] = cp * cr;  // pitch about y, then roll about the pitched x
  x[I::kQuaternion + 1] = cp * sr;
  x[I::kQuaternion + 2] = sp * cr;
  x[I::kQuaternion + 3] = -(sp * sr);
  for (int c = 0; c < kCorners; ++c) x[I::kCorner + c] = T(kTrimLength) * u[U::kCorner + c];
  if (!p.rolling) return x;
  const Vec3<T> v =
      transpose_times(rotation_of(get_quaternion(x.data())), Vec3<T>{p.speed, T(0.0), T(0.0)});
  set_vec3(x.data(), I::kVelocity, v);
  for (int c = 0; c < kCorners; ++c) {
    const T& radius = p.vehicle->numbers.tire[axle_of(c)].radius;
    x[I::kSpin + c] = p.speed / radius * (T(1.0) + T(kTrimSlip) * u[U::kSpinSlip + c]);
  }
  return x;
}

/// dx/dt at x; with relaxation the slips of x are set to their steady values first.
template <class T, class C>
State<T> evaluate_trim(TrimProblem<T, C>& p, State<T>& x) {
  using I = StateIndex;
  const TireMode mode = p.rolling ? TireMode::kRolling : TireMode::kFrictionless;
  State<T> dx;
  dx.fill(T(0.0));
  calc_derivative(*p.vehicle, p.closure, mode, x.data(), dx.data(), p.workspace);
  if (!p.rolling || !p.vehicle->layout.relaxation) return dx;
  for (int c = 0; c < kCorners; ++c) {
    x[I::kKappa + c] = p.workspace.slip[c].kappa;
    x[I::kTanAlpha + c] = p.workspace.slip[c].tan_alpha;
  }
  calc_derivative(*p.vehicle, p.closure, mode, x.data(), dx.data(), p.workspace);
  return dx;
}

/// Writes the weighted accelerations relative to steady motion [m/s^2, rad/s^2] at the unknowns u;
/// returns the state there.
template <class T, class C>
State<T> calc_trim_residual(TrimProblem<T, C>& p, const T* u, T* r) {
  using I = StateIndex;
  using U = TrimIndex;
  // Weights of the corner and spin accelerations relative to those of the chassis.
  constexpr double kCornerWeight = 0.1, kSpinWeight = 1e-3;
  State<T> x = make_trim_state(p, u);
  const State<T> dx = evaluate_trim(p, x);
  const Workspace<T>& ws = p.workspace;
  const Vec3<T> acceleration = ws.rotation * ws.acceleration;
  r[U::kHeight] = acceleration.z;
  r[U::kRoll] = ws.angular_acceleration.x;
  r[U::kPitch] = ws.angular_acceleration.y;
  for (int c = 0; c < kCorners; ++c) {
    r[U::kCorner + c] = T(kCornerWeight) * ws.corner_acceleration[c];
  }
  if (!p.rolling) return x;
  for (int c = 0; c < kCorners; ++c) {
    const T steady = acceleration.x * x[I::kSpin + c] / p.speed;
    r[U::kSpinSlip + c] = T(kSpinWeight) * (dx[I::kSpin + c] - steady);
  }
  return x;
}

}  // namespace strut
