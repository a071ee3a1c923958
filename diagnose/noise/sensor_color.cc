#include "diagnose/noise/sensor_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace strut {
namespace {

constexpr double kHighestLine = 100.0;  // Hz; higher frequencies are not whitened
constexpr double kHighestDrift = 20.0;  // Hz; beyond, drift of this size is far below the noise
constexpr double kMainsTolerance = 0.005;

double get_frequency(const ResidualSpectrum& s, std::size_t k) {
  return static_cast<double>(k) / (static_cast<double>(s.samples) * s.interval);
}

/// Corner frequency of drift with this rms over sigma in a record: the sum over its frequencies.
double calc_corner(const ResidualSpectrum& s, double rms) {
  constexpr double kEuler = std::numbers::egamma;
  const double harmonic = std::log(0.5 * static_cast<double>(s.samples)) + kEuler;
  return rms * rms / (2.0 * s.interval * harmonic);
}

/// Whittle's likelihood of the periodograms below kHighestDrift.
double calc_log_likelihood(std::span<const ResidualSpectrum> residuals, double corner) {
  double sum = 0.0;
  for (const ResidualSpectrum& s : residuals) {
    for (std::size_t k = 1; k < s.power.size(); ++k) {
      const double frequency = get_frequency(s, k);
      if (frequency > kHighestDrift) break;
      if (s.expected[k] == 0.0) continue;
      const double expected = s.expected[k] + corner / frequency;
      const double freedom = s.freedom.empty() ? 1.0 : s.freedom[k];
      sum -= freedom * (std::log(expected) + s.power[k] / expected);
    }
  }
  return sum;
}

/// The strongest line around a harmonic over all runs; an rms of 0 where none stands out.
MainsLine find_line(const SensorColor& color, std::span<const ResidualSpectrum> residuals,
                    double harmonic) {
  constexpr double kClear = 12.0;  // exceeded by white noise in 6e-6 of all bins
  MainsLine line;
  for (const ResidualSpectrum& s : residuals) {
    const double step = get_frequency(s, 1), reach = kMainsTolerance * harmonic + step;
    const auto first = static_cast<std::size_t>(std::ceil((harmonic - reach) / step));
    const auto last = static_cast<std::size_t>((harmonic + reach) / step);
    for (std::size_t k = std::max<std::size_t>(first, 1); k <= last && k < s.power.size(); ++k) {
      const double frequency = get_frequency(s, k);
      const double noise = s.expected[k] + calc_color(color, frequency, s.samples, s.interval);
      if (s.expected[k] == 0.0 || s.power[k] < kClear * noise) continue;
      const double rms = std::sqrt(2.0 * (s.power[k] - noise) / static_cast<double>(s.samples));
      if (rms > line.rms) line = {frequency, rms};
    }
  }
  return line;
}

}  // namespace

double calc_color(const SensorColor& color, double frequency, std::size_t samples,
                  double interval) {
  const auto count = static_cast<double>(samples);
  double variance = color.corner / frequency;
  for (const MainsLine& line : color.lines) {
    const double away = std::numbers::pi * (frequency - line.frequency) * count * interval;
    variance += 0.5 * count * line.rms * line.rms / std::max(1.0, away * away);
  }
  return variance;
}

double estimate_corner(std::span<const ResidualSpectrum> residuals) {
  constexpr std::array kDrift = {0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5};
  constexpr double kUsual = 0.25;
  double best = 0.0, max_likelihood = -std::numeric_limits<double>::infinity();
  for (const double rms : kDrift) {
    const double corner = calc_corner(residuals.front(), rms), ratio = rms / kUsual;
    const double likelihood = calc_log_likelihood(residuals, corner) - 0.5 * ratio * ratio;
    if (likelihood <= max_likelihood) continue;
    max_likelihood = likelihood;
    best = corner;
  }
  return best;
}

SensorColor estimate_color(int channel, std::span<const ResidualSpectrum> residuals) {
  constexpr double kMaxRms = 1.0;
  SensorColor color;
  color.channel = channel;
  color.corner = estimate_corner(residuals);
  const SensorColor drift = color;
  for (const double mains : {50.0, 60.0}) {
    for (double harmonic = mains; harmonic <= kHighestLine; harmonic += mains) {
      const MainsLine line = find_line(drift, residuals, harmonic);
      if (line.rms > 0.0 && line.rms <= kMaxRms) color.lines.push_back(line);
    }
  }
  return color;
}

}  // namespace strut
