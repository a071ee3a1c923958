#include "model/scenario/input_signal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/error/model_error.h"

namespace strut {

namespace {

using Samples = std::vector<double>;

/// Cells per period of a chirp: Hermite's error is (2 pi / 128)^4 / 384 = 1.5e-8 of the amplitude.
constexpr double kCellsPerPeriod = 128.0;
constexpr std::size_t kBumpCells = 128;

void check_samples(const std::string& channel, const Samples& times, const Samples& values) {
  const auto fail = [&](const std::string& what) {
    throw ModelError(channel + what, ModelFault::kInput);
  };
  if (times.size() != values.size()) {
    fail(fmt::format(": {} times and {} values: the numbers must be equal", times.size(),
                     values.size()));
  }
  if (times.size() < 2) fail(fmt::format(": {} samples: must be at least 2", times.size()));
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !std::isfinite(values[i])) {
      fail(fmt::format(", sample {}: must be finite", i + 1));
    }
    if (i > 0 && !(times[i] > times[i - 1])) {
      fail(fmt::format(", sample {}: time = {:f} s: must be > {:f} s, the previous time", i + 1,
                       times[i], times[i - 1]));
    }
  }
}

/// Adds about one bin per cell, more where the samples are unevenly spaced.
void add_bins(InputSignal& signal) {
  const std::size_t cells = signal.cells.size() - 1;
  double shortest = signal.end - signal.begin;
  for (std::size_t i = 0; i < cells; ++i) {
    const double end = i + 1 < cells ? signal.cells[i + 1].begin : signal.end;
    shortest = std::min(shortest, end - signal.cells[i].begin);
  }
  const double span = signal.end - signal.begin;
  const double wanted = std::min(std::ceil(span / shortest), 4.0 * static_cast<double>(cells));
  const auto count = static_cast<std::size_t>(std::max(wanted, 1.0));
  const double width = span / static_cast<double>(count);
  signal.inverse_bin = 1.0 / width;
  // Widens the bins, because a time at the edge of a bin may be rounded into either one.
  const double slack = 1e-6 * width;
  const auto find_cell = [&](double t, std::size_t from) {
    while (from + 1 < cells && signal.cells[from + 1].begin <= t) ++from;
    return from;
  };
  std::size_t first = 0;
  for (std::size_t b = 0; b < count; ++b) {
    const double begin = signal.begin + static_cast<double>(b) * width;
    first = find_cell(begin - slack, first);
    const std::size_t last = find_cell(begin + width + slack, first);
    signal.bins.push_back(static_cast<double>(first));
    signal.search_steps = std::max(signal.search_steps, static_cast<int>(last - first));
  }
}

InputSignal join_cells(const std::string& channel, std::vector<SignalCell> cells, double end) {
  InputSignal signal;
  signal.channel = channel;
  signal.begin = cells.front().begin;
  signal.end = end;
  cells.push_back({std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0, 0.0});
  signal.cells = std::move(cells);
  add_bins(signal);
  return signal;
}

/// Second derivatives of the not-a-knot spline: the first two cells share one cubic, and so do the
/// last two. The end values are eliminated from the tridiagonal system (Thomas algorithm).
Samples solve_moments(const Samples& t, const Samples& y) {
  const std::size_t n = t.size();
  Samples moment(n, 0.0), ratio(n, 0.0);
  if (n == 2) return moment;
  const auto h = [&](std::size_t i) { return t[i + 1] - t[i]; };
  const auto bend = [&](std::size_t i) {
    return 6.0 * ((y[i + 1] - y[i]) / h(i) - (y[i] - y[i - 1]) / h(i - 1));
  };
  if (n == 3) return Samples(3, bend(1) / (3.0 * (h(0) + h(1))));
  for (std::size_t i = 1; i + 1 < n; ++i) {
    double before = h(i - 1), after = h(i), pivot = 2.0 * (before + after);
    if (i == 1) {
      pivot += before * (1.0 + before / after);
      after -= before * before / after;
      before = 0.0;
    } else if (i + 2 == n) {
      pivot += after * (1.0 + after / before);
      before -= after * after / before;
      after = 0.0;
    }
    pivot -= before * ratio[i - 1];
    ratio[i] = after / pivot;
    moment[i] = (bend(i) - before * moment[i - 1]) / pivot;
  }
  for (std::size_t i = n - 3; i > 0; --i) moment[i] -= ratio[i] * moment[i + 1];
  moment[0] = moment[1] - h(0) / h(1) * (moment[2] - moment[1]);
  moment[n - 1] = moment[n - 2] + h(n - 2) / h(n - 3) * (moment[n - 2] - moment[n - 3]);
  return moment;
}

Samples solve_spline_rates(const Samples& t, const Samples& y) {
  const Samples moment = solve_moments(t, y);
  const std::size_t n = t.size();
  Samples rate(n);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = t[i + 1] - t[i], slope = (y[i + 1] - y[i]) / h;
    rate[i] = slope - h / 6.0 * (2.0 * moment[i] + moment[i + 1]);
    rate[i + 1] = slope + h / 6.0 * (moment[i] + 2.0 * moment[i + 1]);
  }
  return rate;
}

InputSignal make_linear(const std::string& channel, const Samples& t, const Samples& y) {
  std::vector<SignalCell> cells;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    cells.push_back({t[i], y[i], (y[i + 1] - y[i]) / (t[i + 1] - t[i]), 0.0, 0.0});
  }
  return join_cells(channel, std::move(cells), t.back());
}

}  // namespace

InputSignal make_signal(const std::string& channel, const Samples& times, const Samples& values,
                        Interpolation interpolation) {
  check_samples(channel, times, values);
  if (interpolation == Interpolation::kLinear) return make_linear(channel, times, values);
  return make_signal(channel, times, values, solve_spline_rates(times, values));
}

InputSignal make_signal(const std::string& channel, const Samples& times, const Samples& values,
                        const Samples& rates) {
  check_samples(channel, times, values);
  check_samples(channel, times, rates);
  std::vector<SignalCell> cells;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double h = times[i + 1] - times[i], slope = (values[i + 1] - values[i]) / h;
    cells.push_back({times[i], values[i], rates[i],
                     (3.0 * slope - 2.0 * rates[i] - rates[i + 1]) / h,
                     (rates[i] + rates[i + 1] - 2.0 * slope) / (h * h)});
  }
  return join_cells(channel, std::move(cells), times.back());
}

InputSignal make_chirp(const std::string& channel, double amplitude, double begin_frequency,
                       double end_frequency, double duration) {
  const double highest = std::max(begin_frequency, end_frequency);
  const double cells = std::max(std::ceil(duration * highest * kCellsPerPeriod), 1.0);
  Samples times, values, rates;
  for (double i = 0.0; i <= cells; i += 1.0) {
    const double t = duration * i / cells, sweep = (end_frequency - begin_frequency) / duration;
    const double turn = 2.0 * std::numbers::pi;
    const double phase = turn * t * (begin_frequency + 0.5 * sweep * t);
    times.push_back(t);
    values.push_back(amplitude * std::sin(phase));
    rates.push_back(amplitude * std::cos(phase) * turn * (begin_frequency + sweep * t));
  }
  return make_signal(channel, times, values, rates);
}

InputSignal make_step(const std::string& channel, double height, double begin, double rise) {
  return make_signal(channel, {begin, begin + rise}, {0.0, height}, Interpolation::kLinear);
}

InputSignal make_bump(const std::string& channel, double height, double begin, double width) {
  Samples times, values, rates;
  for (std::size_t i = 0; i <= kBumpCells; ++i) {
    const double part = static_cast<double>(i) / kBumpCells, turn = 2.0 * std::numbers::pi;
    times.push_back(begin + width * part);
    values.push_back(0.5 * height * (1.0 - std::cos(turn * part)));
    rates.push_back(0.5 * height * turn / width * std::sin(turn * part));
  }
  values.back() = rates.back() = 0.0;
  return make_signal(channel, times, values, rates);
}

InputSignal integrate_signal(const InputSignal& signal) {
  const std::size_t cells = signal.cells.size() - 1;
  Samples times, values, rates;
  double sum = 0.0;
  for (std::size_t i = 0; i <= cells; ++i) {
    times.push_back(i < cells ? signal.cells[i].begin : signal.end);
    values.push_back(sum);
    rates.push_back(calc_signal(signal, times.back()).value);
    if (i == cells) break;
    const SignalCell& c = signal.cells[i];
    const double h = (i + 1 < cells ? signal.cells[i + 1].begin : signal.end) - c.begin;
    sum += h * (c.c0 + h * (c.c1 / 2.0 + h * (c.c2 / 3.0 + h * c.c3 / 4.0)));
  }
  return make_signal(signal.channel, times, values, rates);
}

void correct_signal(InputSignal& signal, const InputCorrection& correction) {
  const auto& [constant, rate, second_rate] = correction.offset;
  for (std::size_t i = 0; i + 1 < signal.cells.size(); ++i) {
    SignalCell& cell = signal.cells[i];
    for (double* c : {&cell.c0, &cell.c1, &cell.c2, &cell.c3}) *c *= correction.gain;
    cell.c0 += constant + cell.begin * (rate + 0.5 * second_rate * cell.begin);
    cell.c1 += rate + second_rate * cell.begin;
    cell.c2 += 0.5 * second_rate;
  }
}

}  // namespace strut
