// A measured or synthetic input over time that drives a rig: road displacement, force, temperature.
//
// Samples at arbitrary times become a piecewise cubic. Signals have no state, so that all lanes and
// threads share one. Before the first and after the last sample the signal is constant.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/math/lanes.h"

namespace strut {

enum class Interpolation {
  kSpline,  // cubic, twice continuously differentiable, not-a-knot ends: O(interval^4)
  kLinear,  // no overshoot at steps; the rate jumps at the samples
};

/// value = c0 + c1 s + c2 s^2 + c3 s^3, s = t - begin. Only doubles, so that lanes can gather them.
struct SignalCell {
  double begin;  // s
  double c0, c1, c2, c3;
};
static_assert(sizeof(SignalCell) == 5 * sizeof(double));

struct InputSignal {
  std::string channel;            // input it drives, a name of ModelInfo::inputs
  double begin = 0.0, end = 0.0;  // s, first and last sample
  std::vector<SignalCell> cells;  // one per interval, then a sentinel
  // Equal bins of time index the cells: the cell of t is at most `search_steps` after that of its
  // bin.
  std::vector<double> bins;
  double inverse_bin = 0.0;  // 1/s
  int search_steps = 0;
};

/// Interpolates samples. Throws ModelError with the channel for fewer than two samples, different
/// numbers of times and values, numbers that are not finite, and times that do not increase.
InputSignal make_signal(const std::string& channel, const std::vector<double>& times,
                        const std::vector<double>& values, Interpolation interpolation);

/// Cubic Hermite interpolation of values and rates [1/s]; errors as above.
InputSignal make_signal(const std::string& channel, const std::vector<double>& times,
                        const std::vector<double>& values, const std::vector<double>& rates);

/// amplitude * sin(phase), the frequency [Hz] running linearly from `begin_frequency` at t = 0 to
/// `end_frequency` at `duration` [s]; to 5e-8 of the amplitude.
InputSignal make_chirp(const std::string& channel, double amplitude, double begin_frequency,
                       double end_frequency, double duration);

/// The integral over time from the first sample on, zero there [u s]; Hermite interpolation between
/// the samples, where it is exact.
InputSignal integrate_signal(const InputSignal& signal);

/// Highest time derivative of an input that a sensor may record in its place.
inline constexpr int kMaxInputDerivative = 2;

/// Correction of a recorded input u: gain u + offset[0] + offset[1] t + offset[2] t^2 / 2.
struct InputCorrection {
  double gain = 1.0;
  std::array<double, kMaxInputDerivative + 1> offset{};  // [u], [u/s], [u/s^2]
  bool operator==(const InputCorrection&) const = default;
};

void correct_signal(InputSignal& signal, const InputCorrection& correction);

/// 0 until `begin` [s], then linearly within `rise` [s] > 0 to `height`.
InputSignal make_step(const std::string& channel, double height, double begin, double rise);

/// height (1 - cos(2 pi (t - begin) / width)) / 2 over `width` [s], 0 before and after.
InputSignal make_bump(const std::string& channel, double height, double begin, double width);

template <class T>
struct SignalPoint {
  T value, rate, second_rate;  // [u], [u/s], [u/s^2] in the signal's unit u
};

/// Index of the first number of the cell of `held` [s], a time from the first to the last sample.
template <class T>
T find_cell(const InputSignal& signal, const T& held) {
  constexpr double kStride = 5.0;
  const double last_bin = static_cast<double>(signal.bins.size()) - 1.0;
  // Comparisons, not min and max: a NaN must end in bin 0, not outside the table.
  T bin = floor((held - T(signal.begin)) * T(signal.inverse_bin));
  bin = select(bin > T(0.0), bin, T(0.0));
  bin = select(bin < T(last_bin), bin, T(last_bin));
  const auto* table = reinterpret_cast<const double*>(signal.cells.data());
  T at = T(kStride) * gather(signal.bins.data(), bin);
  for (int i = 0; i < signal.search_steps; ++i) {
    at += select(gather(table, at + T(kStride)) <= held, T(kStride), T(0.0));
  }
  return at;
}

/// The signal at t [s]; at a sample, the piece of the interval that begins there.
template <class T>
SignalPoint<T> calc_signal(const InputSignal& signal, const T& t) {
  const T held = min(max(t, T(signal.begin)), T(signal.end));
  const auto* table = reinterpret_cast<const double*>(signal.cells.data());
  std::array<T, 5> cell;  // begin, then the coefficients
  const double first = get_lane(held, 0);
  if (all((held >= T(first)) & (held <= T(first)))) {  // one look-up serves all lanes
    table += static_cast<std::ptrdiff_t>(find_cell(signal, first));
    for (std::size_t i = 0; i < cell.size(); ++i) cell[i] = T(table[i]);
  } else {
    const T at = find_cell(signal, held);
    for (std::size_t i = 0; i < cell.size(); ++i) cell[i] = gather(table + i, at);
  }
  const auto& [begin, c0, c1, c2, c3] = cell;
  const auto inside = (t >= T(signal.begin)) & (t <= T(signal.end));
  const T s = held - begin;
  const T rate = c1 + s * (T(2.0) * c2 + s * (T(3.0) * c3));
  return {c0 + s * (c1 + s * (c2 + s * c3)), select(inside, rate, T(0.0)),
          select(inside, T(2.0) * c2 + T(6.0) * c3 * s, T(0.0))};
}

}  // namespace strut
