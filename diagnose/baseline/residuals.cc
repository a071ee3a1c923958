#include "diagnose/baseline/residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "base/math/spread.h"
#include "base/text/format_number.h"

namespace strut {
namespace {

/// The readings less their mean on an even clock of as many samples, linearly interpolated.
std::vector<double> make_even(std::span<const double> times, std::span<const double> values) {
  std::vector<double> t, v;
  t.reserve(times.size());
  v.reserve(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    t.push_back(times[i]);
    v.push_back(values[i]);
  }
  if (t.size() < 2) return {};
  std::vector<double> even(t.size());
  const double mean = calc_mean(v);
  const double interval = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  std::size_t k = 0;
  for (std::size_t i = 0; i < even.size(); ++i) {
    const double at = t.front() + interval * static_cast<double>(i);
    while (k + 2 < t.size() && t[k + 1] <= at) ++k;
    const double theta = (at - t[k]) / (t[k + 1] - t[k]);
    even[i] = v[k] + theta * (v[k + 1] - v[k]) - mean;
  }
  return even;
}

/// The largest prime factor of a number above 1.
std::size_t find_largest_factor(std::size_t n) {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; ++p) {
    for (; n % p == 0; n /= p) largest = p;
  }
  return std::max(largest, n);
}

using Spectrum = std::vector<std::complex<double>>;

/// The transform of any number of values. Eigen's takes O(n p) steps, p the largest
/// prime factor of n; where that is large, by Bluestein's convolution with a
/// chirp (L. I. Bluestein, IEEE Trans. Audio Electroacoust. 18 (1970)).
Spectrum transform(const std::vector<double>& values) {
  constexpr std::size_t kMaxFactor = 50;
  thread_local Eigen::FFT<double> fft;  // keeps its tables
  const std::size_t n = values.size();
  Spectrum spectrum;
  if (find_largest_factor(n) <= kMaxFactor) {
    fft.fwd(spectrum, values);
    return spectrum;
  }
  const std::size_t size = std::bit_ceil(2 * n - 1);
  Spectrum chirp(n), signal(size), filter(size), product(size);
  for (std::size_t k = 0; k < n; ++k) {
    const double angle = static_cast<double>(k * k % (2 * n)) / static_cast<double>(n);
    chirp[k] = std::polar(1.0, -std::numbers::pi * angle);
    signal[k] = values[k] * chirp[k];
    filter[k] = filter[(size - k) % size] = std::conj(chirp[k]);
  }
  Spectrum of_signal, of_filter;
  fft.fwd(of_signal, signal);
  fft.fwd(of_filter, filter);
  for (std::size_t i = 0; i < size; ++i) product[i] = of_signal[i] * of_filter[i];
  fft.inv(signal, product);
  spectrum.resize(n);
  for (std::size_t k = 0; k < n; ++k) spectrum[k] = signal[k] * chirp[k];
  return spectrum;
}

/// Mean square by band of `values`, one every `interval` s.
std::array<double, kBands.size()> calc_band_powers(const std::vector<double>& values,
                                                   double interval) {
  std::array<double, kBands.size()> powers{};
  if (values.size() < 2) return powers;
  const Spectrum spectrum = transform(values);
  const std::size_t n = values.size();
  const double norm = 1.0 / (static_cast<double>(n) * static_cast<double>(n));
  for (std::size_t k = 0; k < n; ++k) {
    const auto cycles = static_cast<double>(std::min(k, n - k));
    const double frequency = cycles / (static_cast<double>(n) * interval);
    for (std::size_t b = 0; b < kBands.size(); ++b) {
      if (frequency < kBands[b].from || frequency >= kBands[b].to) continue;
      powers[b] += norm * std::norm(spectrum[k]);
    }
  }
  return powers;
}

double calc_interval(std::span<const double> times) {
  return (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

/// Number of readings that carry the information of one, for neighbors correlated by `rho`:
/// (1 + rho) / (1 - rho) for an autoregressive process of first order.
double calc_correlation_length(double rho) {
  const double r = std::clamp(rho, 0.0, 0.999);
  return (1.0 + r) / (1.0 - r);
}

void fill_signs(std::span<const double> state, std::span<const double> residual,
                StateResidual& result) {
  std::array<std::vector<double>, 2> sides;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!std::isfinite(state[i]) || !std::isfinite(residual[i]) || state[i] == 0.0) continue;
    sides[state[i] > 0.0 ? 1 : 0].push_back(residual[i]);
  }
  result.mean_negative = calc_mean(sides[0]);
  result.mean_positive = calc_mean(sides[1]);
  const double length = calc_correlation_length(calc_neighbor_correlation(residual));
  double variance = 0.0;
  for (const std::vector<double>& side : sides) {
    if (side.empty()) continue;
    const double spread = calc_spread(side);
    variance += spread * spread * length / static_cast<double>(side.size());
  }
  result.difference_sigma = std::sqrt(variance);
}

}  // namespace

std::string describe(const FrequencyBand& band) {
  const bool is_open = band.to > 1e6;
  if (band.from == 0.0 && is_open) return "all frequencies";
  if (band.from == 0.0) return fmt::format("< {} Hz", format_rounded(band.to));
  if (is_open) return fmt::format("> {} Hz", format_rounded(band.from));
  return fmt::format("{}-{} Hz", format_rounded(band.from), format_rounded(band.to));
}

std::vector<WindowResidual> calc_window_residuals(std::span<const double> times,
                                                  std::span<const double> residual,
                                                  double measured_spread,
                                                  const std::vector<TimeWindow>& windows) {
  std::vector<WindowResidual> results;
  results.reserve(windows.size());
  for (const TimeWindow& window : windows) {
    const auto first = std::lower_bound(times.begin(), times.end(), window.from) - times.begin();
    const auto end = &window == &windows.back()
                         ? std::upper_bound(times.begin(), times.end(), window.to)
                         : std::lower_bound(times.begin(), times.end(), window.to);
    const auto last = end - times.begin();
    const auto part = residual.subspan(static_cast<std::size_t>(first),
                                       static_cast<std::size_t>(std::max(first, last) - first));
    const double rms = calc_rms(part);
    results.push_back(
        {window, count_readings(part), rms, measured_spread > 0.0 ? rms / measured_spread : 0.0});
  }
  return results;
}

std::vector<BandResidual> calc_band_residuals(std::span<const double> times,
                                              std::span<const double> residual,
                                              std::span<const double> measured, double sigma) {
  const double interval = calc_interval(times), nyquist = 0.5 / interval;
  const auto residual_power = calc_band_powers(make_even(times, residual), interval);
  const auto measured_power = calc_band_powers(make_even(times, measured), interval);
  std::vector<BandResidual> results;
  results.reserve(kBands.size());
  for (std::size_t b = 0; b < kBands.size(); ++b) {
    const double width = std::max(0.0, std::min(kBands[b].to, nyquist) - kBands[b].from);
    results.push_back({kBands[b], std::sqrt(residual_power[b]), std::sqrt(measured_power[b]),
                       sigma * std::sqrt(width / nyquist)});
  }
  return results;
}

StateResidual calc_state_residual(const std::string& name, const std::string& unit,
                                  std::span<const double> state, std::span<const double> residual) {
  StateResidual result{name, unit, {}, 0.0, 0.0, 0.0, 0.0};
  const double low = calc_quantile(state, 0.005), high = calc_quantile(state, 0.995);
  if (!(high > low)) return result;
  const double width = (high - low) / static_cast<double>(kStateBins);
  std::array<std::vector<double>, kStateBins> members;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (!std::isfinite(state[i]) || !std::isfinite(residual[i])) continue;
    const double at =
        std::clamp((state[i] - low) / width, 0.0, static_cast<double>(kStateBins) - 0.5);
    members[static_cast<std::size_t>(at)].push_back(residual[i]);
  }
  double explained = 0.0, total = 0.0;
  result.bins.reserve(kStateBins);
  for (std::size_t b = 0; b < kStateBins; ++b) {
    const double mean = calc_mean(members[b]), rms = calc_rms(members[b]);
    const auto count = static_cast<double>(members[b].size());
    result.bins.push_back(
        {low + (static_cast<double>(b) + 0.5) * width, members[b].size(), mean, rms});
    explained += count * mean * mean;
    total += count * rms * rms;
  }
  result.explained = total > 0.0 ? explained / total : 0.0;
  fill_signs(state, residual, result);
  return result;
}

double calc_neighbor_correlation(std::span<const double> residual) {
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i + 1 < residual.size(); ++i) {
    if (!std::isfinite(residual[i]) || !std::isfinite(residual[i + 1])) continue;
    products += residual[i] * residual[i + 1];
    squares += 0.5 * (residual[i] * residual[i] + residual[i + 1] * residual[i + 1]);
  }
  return squares > 0.0 ? products / squares : 0.0;
}

}  // namespace strut
