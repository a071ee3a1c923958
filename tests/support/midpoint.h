// The midpoint rule: an integrator for references that shares nothing with the program's.
#pragma once

#include <cmath>
#include <cstddef>

namespace strut::test {

/// Integrates dx/dt = derive(t, x) from t = 0 and x = 0 over `duration` [s] in steps of `h` [s].
/// State: an array of doubles.
template <class State, class Derive>
State integrate_by_midpoint(double duration, double h, const Derive& derive) {
  const auto add = [](State a, double scale, const State& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += scale * b[i];
    return a;
  };
  State x{};
  for (long i = 0, steps = std::lround(duration / h); i < steps; ++i) {
    const double t = h * static_cast<double>(i);
    x = add(x, h, derive(t + 0.5 * h, add(x, 0.5 * h, derive(t, x))));
  }
  return x;
}

}  // namespace strut::test
