// Steppers against closed forms: order, stiff components, lanes; the phi functions they rest on.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/math/xsimd_backend.h"
#include "model/integrate/steppers.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

/// Components: a = sin t, b = cos t, c = exp(sin t) (c' = c cos t), d' = u;
/// stiff: u' = -lambda (u - a b) + b^2 - a^2, so u = a b + jump exp(-lambda t);
///        v' = -v (1 + v), so v = exp(-t) / (2 - exp(-t)) from v = 1.
/// The linear rates handed to the stepper are `factor` times lambda and 1 + v.
template <class T>
struct ClosedFormSystem {
  static constexpr int kCapacity = 6;
  enum : int { kA, kB, kC, kD, kU, kV };
  T lambda, factor;

  int size() const { return kCapacity; }
  int stiff_at(int i) const { return kU + i; }
  int stiff_count() const { return 2; }

  void calc_derivative(const T& t, const T* x, T* dx, T* decay) const {
    dx[kA] = x[kB];
    dx[kB] = -x[kA];
    dx[kC] = x[kC] * cos(t);
    dx[kD] = x[kU];
    dx[kU] = -lambda * (x[kU] - x[kA] * x[kB]) + x[kB] * x[kB] - x[kA] * x[kA];
    dx[kV] = -x[kV] * (T(1.0) + x[kV]);
    decay[0] = factor * lambda;
    decay[1] = factor * (T(1.0) + x[kV]);
  }
};

constexpr double kJump = 0.5;
using Values = std::array<double, 6>;

Values calc_exact(double lambda, double t, double jump = kJump) {
  const double fade = jump * std::exp(-lambda * t);
  return {std::sin(t),
          std::cos(t),
          std::exp(std::sin(t)),
          0.5 * std::sin(t) * std::sin(t) + (jump - fade) / lambda,
          std::sin(t) * std::cos(t) + fade,
          std::exp(-t) / (2.0 - std::exp(-t))};
}

enum class Method { kRk4, kAbm4 };

/// `steps` steps of length h from t = 0; Adams starts with three Runge-Kutta steps.
template <class T>
std::array<T, 6> integrate(ClosedFormSystem<T> system, Method method, const T& h, int steps,
                           double jump = kJump) {
  constexpr int n = ClosedFormSystem<T>::kCapacity;
  // Step ends in a ring: the current one at head, the past before it.
  std::array<std::array<T, n>, 5> x, f;
  for (int i = 0; i < n; ++i) x[0][i] = T(calc_exact(1.0, 0.0, jump)[i]);
  std::array<T, kMaxStiff> decay;
  StepScratch<T, n> scratch{};
  StiffWeights<T> weights{};
  T t(0.0);
  for (int step = 0; step < steps; ++step) {
    const T* now = x[step % 5].data();
    T* slope = f[step % 5].data();
    T* next = x[(step + 1) % 5].data();
    system.calc_derivative(t, now, slope, decay.data());
    update_stiff_weights(decay.data(), h, system.stiff_count(), weights);
    if (method == Method::kRk4 || step < 3) {
      step_rk4<T>(system, t, now, slope, weights, h, next, scratch);
    } else {
      AdamsHistory<T> past{};
      for (int j = 0; j < 3; ++j) {
        past.x[j] = x[(step - 1 - j) % 5].data();
        past.f[j] = f[(step - 1 - j) % 5].data();
      }
      step_abm4<T>(system, t, now, slope, past, weights, h, next, scratch);
    }
    t = t + h;
  }
  return x[steps % 5];
}

/// Largest errors of the ordinary and of the stiff components after two seconds.
std::array<double, 2> calc_errors(Method method, double lambda, double factor, int steps) {
  constexpr double kEnd = 2.0;
  const Values x = integrate<double>({lambda, factor}, method, kEnd / steps, steps);
  const Values exact = calc_exact(lambda, kEnd);
  std::array<double, 2> worst{};
  for (int i = 0; i < 6; ++i) {
    double& group = worst[i < ClosedFormSystem<double>::kU ? 0 : 1];
    group = std::max(group, std::abs(x[i] - exact[i]));
  }
  return worst;
}

void check_order_four(Method method, double factor) {
  constexpr double kLambda = 3.0;
  constexpr int kSteps = 640;  // h = 3 ms: errors of 1e-11 stand clear of rounding
  const auto coarse = calc_errors(method, kLambda, factor, kSteps);
  const auto fine = calc_errors(method, kLambda, factor, 2 * kSteps);
  for (int group = 0; group < 2; ++group) {
    const double order = std::log2(coarse[group] / fine[group]);
    INFO((method == Method::kRk4 ? "rk4" : "abm4")
         << ", decay factor " << factor << ", " << (group == 0 ? "ordinary" : "stiff")
         << " components: errors " << coarse[group] << ", " << fine[group] << ", order " << order);
    CHECK(std::abs(order - 4.0) < tolerance(0.2));
  }
}

TEST_CASE("RK4 and Adams converge with order four, whatever linear rate is split off",
          "[unit][property]") {
  // 0: the classical formulas; 1: the true rate; others: wrong rates, made good by the remainder.
  for (const double factor : {0.0, 0.5, 1.0, 2.0}) {
    check_order_four(Method::kRk4, factor);
    check_order_four(Method::kAbm4, factor);
  }
}

TEST_CASE("Without a linear rate the exponential formulas are the classical ones", "[unit]") {
  // The same system with all components ordinary: a frozen rate of zero may cost rounding only.
  struct Classical : ClosedFormSystem<double> {
    int stiff_count() const { return 0; }
  } classical{{2.0, 0.0}};
  const ClosedFormSystem<double> split{2.0, 0.0};
  constexpr double kStep = 0.1;
  Values x = calc_exact(2.0, 0.3), f{}, x1{}, x1_classical{};
  std::array<double, kMaxStiff> decay{};
  split.calc_derivative(0.3, x.data(), f.data(), decay.data());
  StiffWeights<double> weights{};
  update_stiff_weights(decay.data(), kStep, 2, weights);
  StepScratch<double, 6> scratch{};
  AdamsHistory<double> past{};
  std::array<Values, 3> past_x{}, past_f{};
  for (int j = 0; j < 3; ++j) {
    const double t = 0.3 - (j + 1) * kStep;
    past_x[j] = calc_exact(2.0, t);
    split.calc_derivative(t, past_x[j].data(), past_f[j].data(), decay.data());
    past.x[j] = past_x[j].data();
    past.f[j] = past_f[j].data();
  }
  const auto check_equal = [&] {
    for (int i = 0; i < 6; ++i) CHECK(std::abs(x1[i] - x1_classical[i]) < tolerance(1e-15));
  };
  step_rk4<double>(split, 0.3, x.data(), f.data(), weights, kStep, x1.data(), scratch);
  step_rk4<double>(classical, 0.3, x.data(), f.data(), weights, kStep, x1_classical.data(),
                   scratch);
  check_equal();
  step_abm4<double>(split, 0.3, x.data(), f.data(), past, weights, kStep, x1.data(), scratch);
  step_abm4<double>(classical, 0.3, x.data(), f.data(), past, weights, kStep, x1_classical.data(),
                    scratch);
  check_equal();
}

TEST_CASE("A rate far beyond explicit stability leaves the slow motion accurate", "[unit]") {
  // lambda h = 20; explicit RK4 is stable up to 2.8. With the true rate the slow manifold u = a b
  // is met up to stiff order reduction, h^4 times the fourth derivative / (lambda h) = 5e-6; a rate
  // wrong by a tenth leaves a tenth of h u' = 0.05 in a stage, of which the step keeps a tenth.
  constexpr double kStep = 0.05, kLambda = 20.0 / kStep;
  constexpr int kSteps = 40;
  const Values exact = calc_exact(kLambda, kStep * kSteps, 0.0);
  for (const Method method : {Method::kRk4, Method::kAbm4}) {
    for (const double factor : {0.9, 1.0, 1.1}) {
      const Values x = integrate<double>({kLambda, factor}, method, kStep, kSteps, 0.0);
      const double error = std::abs(x[4] - exact[4]);
      INFO((method == Method::kRk4 ? "rk4" : "abm4")
           << ", factor " << factor << ", error " << error);
      CHECK(error < tolerance(factor == 1.0 ? 2e-5 : 5e-4));
    }
    const Values wild = integrate<double>({kLambda, 0.0}, method, kStep, kSteps, 0.0);
    CHECK_FALSE(std::abs(wild[4] - exact[4]) < 1e6);
  }
}

TEST_CASE("A lane equals its scalar twin at its own step length", "[unit]") {
  constexpr int kLanes = kLaneCount<NativeLanes>;
  constexpr int kSteps = 50;
  NativeLanes h(0.0), lambda(0.0), factor(0.0);
  const auto step_of = [](int lane) { return 0.01 * (1 + lane); };
  const auto rate_of = [](int lane) { return 2.0 + 40.0 * lane; };
  const auto factor_of = [](int lane) { return 1.0 - 0.1 * lane; };
  for (int lane = 0; lane < kLanes; ++lane) {
    set_lane(h, lane, step_of(lane));
    set_lane(lambda, lane, rate_of(lane));
    set_lane(factor, lane, factor_of(lane));
  }
  for (const Method method : {Method::kRk4, Method::kAbm4}) {
    const auto lanes = integrate<NativeLanes>({lambda, factor}, method, h, kSteps);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Values twin =
          integrate<double>({rate_of(lane), factor_of(lane)}, method, step_of(lane), kSteps);
      for (int i = 0; i < 6; ++i) {
        // Fifty steps of rounding; exp and cos of lanes and of libm differ in the last place.
        CHECK(std::abs(get_lane(lanes[i], lane) - twin[i]) < tolerance(1e-14));
      }
    }
  }
}

/// phi_k(z) = exp(z) / (k-1)! sum (-z)^n / (n! (n + k)): positive terms for z < 0, no cancellation.
long double calc_phi_by_series(int k, long double z) {
  long double term = 1.0L, sum = 0.0L, factorial = 1.0L;
  for (int n = 0; n < 400; ++n) {
    sum += term / static_cast<long double>(n + k);
    term *= -z / static_cast<long double>(n + 1);
  }
  for (int i = 2; i < k; ++i) factorial *= static_cast<long double>(i);
  return std::exp(z) * sum / factorial;
}

TEST_CASE("The phi functions equal their series", "[unit][property]") {
  std::array<double, 5> worst{};
  const auto compare = [&](double z) {
    const PhiFunctions<double> phi = calc_phi(z);
    const double values[] = {phi.phi1, phi.phi2, phi.phi3, phi.phi4};
    // exp is only ever added to numbers of order one: its absolute error counts.
    worst[0] = std::max(worst[0], std::abs(phi.exponential - std::exp(z)));
    for (int k = 1; k <= 4; ++k) {
      const long double truth = calc_phi_by_series(k, static_cast<long double>(z));
      const double error =
          static_cast<double>(std::abs((static_cast<long double>(values[k - 1]) - truth) / truth));
      worst[k] = std::max(worst[k], error);
    }
  };
  for (int i = 0; i <= 5000; ++i) compare(-0.01 * i);
  for (double z = -1.0; z < -1e-18; z *= 0.7) compare(z);
  for (const double z : {-0.9999999999999999, -1.0000000000000002}) compare(z);
  INFO("worst errors of exp, phi1..phi4: " << worst[0] << " " << worst[1] << " " << worst[2] << " "
                                           << worst[3] << " " << worst[4]);
  // Dividing by z <= -1 after subtracting 1/k! keeps two digits fewer than the rounding of 1e-16.
  for (const double error : worst) CHECK(error < tolerance(1e-14));
}

}  // namespace
}  // namespace strut
