// One step of RK4 and of the Adams-Bashforth-Moulton pair, each lane with its own step length.
//
// A few components may be stiff and scalar (the spin of a wheel against its slip stiffness):
// d(u)/dt = -decay u + N(u, rest). For them both methods use their exponential form, with the
// decay rate frozen at the start of the step: Krogstad's ETDRK4-B (J. Comput. Phys. 203, 2005, eq.
// 51) and the exponential Adams formulas of Cox and Matthews (J. Comput. Phys. 176, 2002, eq. 11)
// with their implicit counterpart. With decay = 0 they are the classical methods; they have order
// four for any decay, because N compensates for the linear part.
//
// A system offers
//   static constexpr int kCapacity;         largest state
//   int size() const;                       state in use
//   int stiff_count() const;                number of stiff components, at most kMaxStiff
//   int stiff_at(int i) const;              index of the i-th stiff component in the state
//   void calc_derivative(const T& t, const T* x, T* dx, T* decay);
#pragma once

#include <algorithm>
#include <array>

#include "base/math/exponential.h"

namespace strut {

inline constexpr int kMaxStiff = 20;

/// Weights of the exponential formulas for each stiff component over one step.
template <class T>
struct StiffWeights {
  std::array<T, kMaxStiff> decay, step;  // 1/s, frozen; s
  std::array<PhiFunctions<T>, kMaxStiff> full;
  std::array<PhiFunctions<T>, kMaxStiff> half;
  int known = 0;  // number of components that have weights
};

template <class T>
void update_stiff_weights(const T* decay, const T& h, int count, StiffWeights<T>& weights) {
  for (int i = 0; i < count; ++i) {
    const bool is_known =
        i < weights.known && all_equal(weights.decay[i], decay[i]) && all_equal(weights.step[i], h);
    if (is_known) continue;
    weights.decay[i] = decay[i];
    weights.step[i] = h;
    weights.full[i] = calc_phi(-decay[i] * h);
    weights.half[i] = calc_phi(T(-0.5) * decay[i] * h);
  }
  weights.known = std::max(weights.known, count);
}

/// Buffers of both steppers.
template <class T, int N>
struct StepScratch {
  std::array<std::array<T, N>, 4> k;
  std::array<T, N> stage;
  std::array<T, kMaxStiff> unused_decay;
};

/// x1 = RK4 step of length h from (t, x) with derivative f there.
template <class T, class System>
void step_rk4(System& system, const T& t, const T* x, const T* f, const StiffWeights<T>& weights,
              const T& h, T* x1, StepScratch<T, System::kCapacity>& scratch) {
  const int n = system.size(), count = system.stiff_count();
  const T half = T(0.5) * h;
  T* stage = scratch.stage.data();
  T *k2 = scratch.k[1].data(), *k3 = scratch.k[2].data(), *k4 = scratch.k[3].data();
  std::array<T, kMaxStiff> n1, n2, n3;
  const auto nonlinear = [&](const T* k, const T* u, std::array<T, kMaxStiff>& out) {
    for (int i = 0; i < count; ++i) {
      const int at = system.stiff_at(i);
      out[i] = k[at] + weights.decay[i] * u[at];
    }
  };

  nonlinear(f, x, n1);
  for (int i = 0; i < n; ++i) stage[i] = x[i] + half * f[i];
  for (int i = 0; i < count; ++i) {
    const PhiFunctions<T>& p = weights.half[i];
    stage[system.stiff_at(i)] = p.exponential * x[system.stiff_at(i)] + half * p.phi1 * n1[i];
  }
  system.calc_derivative(t + half, stage, k2, scratch.unused_decay.data());
  nonlinear(k2, stage, n2);

  for (int i = 0; i < n; ++i) stage[i] = x[i] + half * k2[i];
  for (int i = 0; i < count; ++i) {
    const PhiFunctions<T>& p = weights.half[i];
    stage[system.stiff_at(i)] = p.exponential * x[system.stiff_at(i)] +
                                half * (p.phi1 * n1[i] + T(2.0) * p.phi2 * (n2[i] - n1[i]));
  }
  system.calc_derivative(t + half, stage, k3, scratch.unused_decay.data());
  nonlinear(k3, stage, n3);

  for (int i = 0; i < n; ++i) stage[i] = x[i] + h * k3[i];
  for (int i = 0; i < count; ++i) {
    const PhiFunctions<T>& p = weights.full[i];
    stage[system.stiff_at(i)] = p.exponential * x[system.stiff_at(i)] +
                                h * (p.phi1 * n1[i] + T(2.0) * p.phi2 * (n3[i] - n1[i]));
  }
  system.calc_derivative(t + h, stage, k4, scratch.unused_decay.data());

  const T sixth = h * T(1.0 / 6.0);
  std::array<T, kMaxStiff> n4;
  nonlinear(k4, stage, n4);
  for (int i = 0; i < n; ++i) {
    x1[i] = x[i] + sixth * (f[i] + T(2.0) * (k2[i] + k3[i]) + k4[i]);
  }
  for (int i = 0; i < count; ++i) {
    const PhiFunctions<T>& p = weights.full[i];
    const T w1 = p.phi1 - T(3.0) * p.phi2 + T(4.0) * p.phi3;
    const T w2 = T(2.0) * p.phi2 - T(4.0) * p.phi3;
    const T w3 = T(4.0) * p.phi3 - p.phi2;
    x1[system.stiff_at(i)] = p.exponential * x[system.stiff_at(i)] +
                             h * (w1 * n1[i] + w2 * (n2[i] + n3[i]) + w3 * n4[i]);
  }
}

/// States and derivatives at the last three step ends before the current one, newest first.
template <class T>
struct AdamsHistory {
  std::array<const T*, 3> x, f;
};

/// x1 = step by predicting (Adams-Bashforth 4), evaluating and correcting (Adams-Moulton 4). The
/// caller does the final evaluation, which is also the next step's derivative.
template <class T, class System>
void step_abm4(System& system, const T& t, const T* x, const T* f, const AdamsHistory<T>& past,
               const StiffWeights<T>& weights, const T& h, T* x1,
               StepScratch<T, System::kCapacity>& scratch) {
  const int n = system.size(), count = system.stiff_count();
  T* predicted = scratch.stage.data();
  T* fp = scratch.k[1].data();
  const T scale = h * T(1.0 / 24.0);
  for (int i = 0; i < n; ++i) {
    predicted[i] = x[i] + scale * (T(55.0) * f[i] - T(59.0) * past.f[0][i] +
                                   T(37.0) * past.f[1][i] - T(9.0) * past.f[2][i]);
  }
  std::array<std::array<T, kMaxStiff>, 4> nonlinear;  // newest first
  for (int i = 0; i < count; ++i) {
    const PhiFunctions<T>& p = weights.full[i];
    const T n0 = f[system.stiff_at(i)] + weights.decay[i] * x[system.stiff_at(i)];
    T nj[3];
    for (int j = 0; j < 3; ++j) {
      nj[j] = past.f[j][system.stiff_at(i)] + weights.decay[i] * past.x[j][system.stiff_at(i)];
    }
    nonlinear[0][i] = n0;
    for (int j = 0; j < 3; ++j) nonlinear[j + 1][i] = nj[j];
    // Newton's backward differences of N over the last four points.
    const T d1 = n0 - nj[0];
    const T d2 = d1 - (nj[0] - nj[1]);
    const T d3 = d2 - (nj[0] - T(2.0) * nj[1] + nj[2]);
    predicted[system.stiff_at(i)] =
        p.exponential * x[system.stiff_at(i)] +
        h * (p.phi1 * n0 + p.phi2 * d1 + (p.phi3 + T(0.5) * p.phi2) * d2 +
             (p.phi4 + p.phi3 + T(1.0 / 3.0) * p.phi2) * d3);
  }
  system.calc_derivative(t + h, predicted, fp, scratch.unused_decay.data());
  for (int i = 0; i < n; ++i) {
    x1[i] = x[i] + scale * (T(9.0) * fp[i] + T(19.0) * f[i] - T(5.0) * past.f[0][i] + past.f[1][i]);
  }
  for (int i = 0; i < count; ++i) {
    const PhiFunctions<T>& p = weights.full[i];
    const T n1 = fp[system.stiff_at(i)] + weights.decay[i] * predicted[system.stiff_at(i)];
    const T d1 = n1 - nonlinear[0][i];
    const T e1 = nonlinear[0][i] - nonlinear[1][i];
    const T d2 = d1 - e1;
    const T d3 = d2 - (e1 - (nonlinear[1][i] - nonlinear[2][i]));
    x1[system.stiff_at(i)] =
        p.exponential * x[system.stiff_at(i)] +
        h * (p.phi1 * n1 + (p.phi2 - p.phi1) * d1 + (p.phi3 - T(0.5) * p.phi2) * d2 +
             (p.phi4 - T(1.0 / 6.0) * p.phi2) * d3);
  }
}

/// Cubic Hermite interpolation at the fraction theta of a step of length h.
template <class T>
void interpolate_state(const T* x0, const T* f0, const T* x1, const T* f1, const T& h,
                       const T& theta, int n, T* x) {
  const T t2 = theta * theta, t3 = t2 * theta;
  const T b1 = T(3.0) * t2 - T(2.0) * t3;
  const T c0 = h * (theta - T(2.0) * t2 + t3), c1 = h * (t3 - t2);
  for (int i = 0; i < n; ++i) x[i] = x0[i] + b1 * (x1[i] - x0[i]) + c0 * f0[i] + c1 * f1[i];
}

}  // namespace strut
