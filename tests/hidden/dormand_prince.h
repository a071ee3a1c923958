// Runge-Kutta 5(4) of Dormand and Prince with step control and dense output: the generator's own
// integrator, of another kind than the fixed steps of the program that is tested.
//
// E. Hairer, S. P. Norsett, G. Wanner: Solving Ordinary Differential Equations I, 2nd ed. 1993,
// sections II.4 to II.6 (method, control, dense output of order 4 as in their program DOPRI5).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace strut::hidden {

struct DormandPrinceOptions {
  double tolerance = 1e-8;     // relative, and absolute in units of `scale`
  std::vector<double> scale;   // absolute size of each state; empty: 1
  double largest_step = 5e-3;  // s, so that no bump is stepped over
  /// s; a step this short is taken as it is: where the right-hand side jumps, no step is exact.
  double smallest_step = 1e-9;
  double first_step = 1e-4;  // s
};

/// The seven stages of a step from `y`; stage 6 is the rate at the step's end.
struct DormandPrinceStep {
  std::array<std::vector<double>, 7> rate;
  std::vector<double> end, error, stage;

  explicit DormandPrinceStep(std::size_t size) : end(size), error(size), stage(size) {
    for (auto& r : rate) r.resize(size);
  }
};

namespace dopri {

inline constexpr double kNode[7] = {0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0};
inline constexpr double kWeight[7][6] = {
    {},
    {0.2},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
inline constexpr double kError[7] = {71.0 / 57600,      0.0,        -71.0 / 16695, 71.0 / 1920,
                                     -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
inline constexpr double kDense[7] = {-12715105075.0 / 11282082432.0,  0.0,
                                     87487479700.0 / 32700410799.0,   -10690763975.0 / 1880347072.0,
                                     701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0,
                                     69997945.0 / 29380423.0};

}  // namespace dopri

/// Fills stages 1 to 6, the end and its error from stage 0.
template <class Rates>
void calc_step(const Rates& rates, double t, double h, const std::vector<double>& y,
               DormandPrinceStep& step) {
  const std::size_t n = y.size();
  for (int s = 1; s < 7; ++s) {
    std::vector<double>& at = s == 6 ? step.end : step.stage;
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (int k = 0; k < s; ++k)
        sum += dopri::kWeight[s][k] * step.rate[static_cast<std::size_t>(k)][i];
      at[i] = y[i] + h * sum;
    }
    rates(t + dopri::kNode[s] * h, at, step.rate[static_cast<std::size_t>(s)]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 7; ++k) sum += dopri::kError[k] * step.rate[k][i];
    step.error[i] = h * sum;
  }
}

/// The state at t + theta h by the step's dense output, theta in [0, 1].
inline void calc_dense(const std::vector<double>& y, const DormandPrinceStep& step, double h,
                       double theta, std::vector<double>& at) {
  const double other = 1.0 - theta;
  for (std::size_t i = 0; i < y.size(); ++i) {
    double bend = 0.0;
    for (std::size_t k = 0; k < 7; ++k) bend += dopri::kDense[k] * step.rate[k][i];
    const double rise = step.end[i] - y[i];
    const double start = h * step.rate[0][i] - rise;
    const double last = rise - h * step.rate[6][i] - start;
    at[i] = y[i] + theta * (rise + other * (start + theta * (last + other * h * bend)));
  }
}

/// Root mean square of the error over the tolerance.
inline double calc_error_norm(const std::vector<double>& y, const DormandPrinceStep& step,
                              const DormandPrinceOptions& options) {
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double scale = options.scale.empty() ? 1.0 : options.scale[i];
    const double size = std::max({scale, std::fabs(y[i]), std::fabs(step.end[i])});
    const double ratio = step.error[i] / (options.tolerance * size);
    sum += ratio * ratio;
  }
  return std::sqrt(sum / static_cast<double>(y.size()));
}

/// Integrates rates(t, y, dy) from times.front() and passes the state at every time [s], ascending,
/// to observe(index, t, y). Kinks of the right-hand side are found by the error control: a step
/// across one is rejected until it is short enough. Throws std::runtime_error where the rates are
/// not finite.
template <class Rates, class Observe>
void integrate_dormand_prince(const Rates& rates, std::vector<double> y,
                              const std::vector<double>& times, const DormandPrinceOptions& options,
                              const Observe& observe) {
  DormandPrinceStep step(y.size());
  std::vector<double> sample(y.size());
  double t = times.front(), h = options.first_step;
  std::size_t next = 0;
  observe(next, t, y);
  ++next;
  rates(t, y, step.rate[0]);
  while (next < times.size()) {
    h = std::min(h, options.largest_step);
    calc_step(rates, t, h, y, step);
    const double error = calc_error_norm(y, step, options);
    const double change = 0.9 * std::pow(std::max(error, 1e-10), -0.2);
    if (!std::isfinite(error) && h <= options.smallest_step) {
      throw std::runtime_error("Dormand-Prince: no finite step at t = " + std::to_string(t));
    }
    if (!(error <= 1.0) && h > options.smallest_step) {
      h = std::max(h * (error > 1.0 ? std::max(0.2, change) : 0.1), options.smallest_step);
      continue;
    }
    for (; next < times.size() && times[next] <= t + h; ++next) {
      calc_dense(y, step, h, (times[next] - t) / h, sample);
      observe(next, times[next], sample);
    }
    t += h;
    y.swap(step.end);
    step.rate[0].swap(step.rate[6]);
    h *= std::clamp(change, 0.2, 5.0);
  }
}

}  // namespace strut::hidden
