// A damper whose force is not proportional to its speed, and elements in series with a damper.
#pragma once

#include "model/force/strut.h"

namespace strut {

/// F = c (1 - a sgn v) ((1 - r) + r / sqrt(1 + (v / v_b)^2)) (1 - l) exp(-b (T - T_0)) v,
/// v = -d(length)/dt. Each factor is exactly 1 where its effect is neutral.
template <class T>
struct DamperLaw {
  static constexpr Line kLine = kDamperLine;
  T damping;     // c, N s/m
  T asymmetry;   // a
  T knee_loss;   // r
  T knee_speed;  // v_b, m/s
  T fade;        // l
  T warm_fade;   // b, 1/K

  /// F / v [N s/m]; `warming` T - T_0 [K]. Root and exponential are left out where no lane needs
  /// them.
  T calc_rate(const T& speed, const T& warming) const {
    const T side = select(speed > T(0.0), T(1.0) - asymmetry, T(1.0) + asymmetry);
    T rate = damping * side;
    if (any(abs(knee_loss) > T(0.0))) {
      rate *= (T(1.0) - knee_loss) + knee_loss / sqrt(T(1.0) + square(speed / knee_speed));
    }
    rate *= T(1.0) - fade;
    if (any(abs(warm_fade) > T(0.0))) rate *= exp(-warm_fade * warming);
    return rate;
  }
};

/// Contact at the end of a lost stroke: it yields within kContactTime [s], and at kJointSpeed [m/s]
/// by at most the play, so that it vanishes with the play. It is as stiff as RK4 with 1 ms steps
/// allows: the integration error is 1 % of the effect that 1 to 30 mm of play have on the body
/// acceleration of a quarter car (3 to 17 % at half of kContactTime), and 1 to 10 % of the effect
/// of 0.3 mm.
inline constexpr double kContactTime = 1e-3, kJointSpeed = 0.5;

/// Rate at which a contact of a joint with play > 0 yields [1/s].
template <class T>
T calc_contact_rate(const T& play) {
  return sqrt(T(1.0 / square(kContactTime)) + square(T(kJointSpeed) / play));
}

/// Elements in series with a damper whose instantaneous force is f(v): a lost stroke, a lag, then a
/// rubber mount.
///
///   du/dt = v - w,   w = r (u - clamp(u, -p / 2, p / 2)),   r^2 = (1 / t_c)^2 + (v_j / p)^2
///   tau dy/dt + y = f(w),   (tau_m + kappa c_s) dz/dt + z = y,   F = z + tau_m dz/dt
///
/// with c_s = f(w) / w. u is the displacement in a joint with play p, the sum of the play of a worn
/// joint and the lost stroke of the damper itself. Within the play the rod moves freely and the
/// damper does not move; beyond it the contact is a spring with the force law f(w), of stiffness c
/// r for f = c w. Its energy is the integral of f(w) over u and the damper dissipates f(w) w, so no
/// energy is created by any law. w tends to v as p vanishes. w is exactly v where p is 0, y is
/// exactly f(w) where tau is 0, F is exactly y where kappa is 0.
template <class T>
struct DamperSeries {
  T play;        // p, m, of joint and damper
  T lag;         // tau, s
  T compliance;  // kappa, m/N
  T relaxation;  // tau_m, s
  T joint_play;  // play p [m]: where it is positive, the strut's dry friction is behind the joint
};

/// States y [N], z [N] and u [m] of a DamperSeries, their time derivatives, and their decay rates
/// [1/s] in the form d(state)/dt = -decay state + N.
template <class T>
struct DamperSeriesState {
  T lagged, lagged_rate, lagged_decay;
  T mount, mount_rate, mount_decay;
  T joint, joint_rate, joint_decay;
};

/// Speed w of the damper behind its joint [m/s] at the strut's speed v; sets rate and decay of the
/// joint.
template <class T>
T calc_joint_speed(const DamperSeries<T>& series, const T& speed, DamperSeriesState<T>& state) {
  const auto loose = series.play > T(0.0);
  state.joint_decay = state.joint_rate = T(0.0);
  if (!any(loose)) return speed;
  const T half = T(0.5) * series.play;
  state.joint_decay = select(loose, calc_contact_rate(select(loose, series.play, T(1.0))), T(0.0));
  const T passed = state.joint_decay * (state.joint - min(max(state.joint, -half), half));
  state.joint_rate = select(loose, speed - passed, T(0.0));
  return select(loose, passed, speed);
}

/// Displacement of a joint after a long motion at constant speed [m].
template <class T>
T calc_settled_joint(const DamperSeries<T>& series, const T& speed) {
  const auto loose = series.play > T(0.0);
  const T side = select(speed > T(0.0), T(0.5), select(speed < T(0.0), T(-0.5), T(0.0)));
  const T yielded = speed / calc_contact_rate(select(loose, series.play, T(1.0)));
  return select(loose, series.play * side + yielded, T(0.0));
}

/// Force of the damper [N]; sets rates and decays of `state`.
template <class T>
T calc_series_force(const DamperSeries<T>& series, const T& law_force, const T& law_rate,
                    DamperSeriesState<T>& state) {
  const auto lags = series.lag > T(0.0), yields = series.compliance > T(0.0);
  state.lagged_decay = state.lagged_rate = state.mount_decay = state.mount_rate = T(0.0);
  T force = law_force;
  if (any(lags)) {
    state.lagged_decay = select(lags, T(1.0) / select(lags, series.lag, T(1.0)), T(0.0));
    state.lagged_rate = state.lagged_decay * (law_force - state.lagged);
    force = select(lags, state.lagged, force);
  }
  if (any(yields)) {
    const T time = series.relaxation + series.compliance * abs(law_rate);
    state.mount_decay = select(yields, T(1.0) / time, T(0.0));
    state.mount_rate = state.mount_decay * (force - state.mount);
    force = select(yields, state.mount + series.relaxation * state.mount_rate, force);
  }
  return force;
}

}  // namespace strut
