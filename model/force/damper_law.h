// A damper whose force is not proportional to its speed, and one that answers late.
#pragma once

#include "model/force/strut.h"

namespace strut {

/// F = c (1 - a sgn v) ((1 - r) + r / sqrt(1 + (v / v_b)^2)) abs(v) / (abs(v) + v_l) (1 - l)
/// exp(-b (T - T_0)) v, v = -d(length)/dt. Each factor is exactly 1 where its effect is neutral.
template <class T>
struct DamperLaw {
  static constexpr Line kLine = kDamperLine;
  T damping;     // c, N s/m
  T asymmetry;   // a
  T knee_loss;   // r
  T knee_speed;  // v_b, m/s
  T leak_speed;  // v_l, m/s
  T fade;        // l
  T warm_fade;   // b, 1/K

  /// F / v [N s/m]; `warming` T - T_0 [K].
  T calc_rate(const T& speed, const T& warming) const {
    const T size = abs(speed);
    const T side = select(speed > T(0.0), T(1.0) - asymmetry, T(1.0) + asymmetry);
    const T knee = (T(1.0) - knee_loss) + knee_loss / sqrt(T(1.0) + square(speed / knee_speed));
    // At rest 0 / tiny: no force where there is a leak, and nothing to divide by where there is
    // none.
    constexpr double kTiny = 1e-300;
    const T held = select(leak_speed > T(0.0), size / max(size + leak_speed, T(kTiny)), T(1.0));
    return damping * side * knee * held * (T(1.0) - fade) * exp(-warm_fade * warming);
  }
};

/// What lies in series with a damper whose instantaneous force is f(v): a lag, then a rubber mount.
///
///   tau dy/dt + y = f(v),   (tau_m + kappa c_s) dw/dt + w = y,   F = w + tau_m dw/dt
///
/// with c_s = f(v) / v. y is f(v) itself where tau is 0, F is y where kappa is 0.
template <class T>
struct DamperSeries {
  T lag;         // tau, s
  T compliance;  // kappa, m/N
  T relaxation;  // tau_m, s
};

/// States y [N] and w [N] of a DamperSeries with their rates [N/s], each also as -decay * state +
/// the rest, decay [1/s].
template <class T>
struct DamperSeriesState {
  T lagged, lagged_rate, lagged_decay;
  T mount, mount_rate, mount_decay;
};

/// Force of the damper [N]; fills rates and decays of `state`.
template <class T>
T calc_series_force(const DamperSeries<T>& series, const T& law_force, const T& law_rate,
                    DamperSeriesState<T>& state) {
  const auto lags = series.lag > T(0.0), yields = series.compliance > T(0.0);
  state.lagged_decay = select(lags, T(1.0) / select(lags, series.lag, T(1.0)), T(0.0));
  state.lagged_rate = state.lagged_decay * (law_force - state.lagged);
  const T lagged = select(lags, state.lagged, law_force);
  const T time = series.relaxation + series.compliance * abs(law_rate);
  state.mount_decay = select(yields, T(1.0) / time, T(0.0));
  state.mount_rate = state.mount_decay * (lagged - state.mount);
  return select(yields, state.mount + series.relaxation * state.mount_rate, lagged);
}

}  // namespace strut
