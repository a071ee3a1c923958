// Noise of a channel's sensor that is not white: 1/f drift, and lines of the mains.
//
//   S(f) = sigma^2 (1 + f_c / f + sum_l N r_l^2 / 2 min(1, 1 / (pi (f - f_l) T)^2))
//
// f_c: corner frequency [Hz], below which drift exceeds the white noise; N, T: samples and duration
// of the record; f_l, r_l: frequency and rms over sigma of a line, whose leakage in a record that
// is not tapered falls as (f - f_l)^-2.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace strut {

struct MainsLine {
  double frequency = 0.0;  // Hz
  double rms = 0.0;        // over sigma
};

struct SensorColor {
  int channel = -1;     // index in ModelInfo::channels
  double corner = 0.0;  // Hz
  std::vector<MainsLine> lines;
};

/// Variance beyond the white noise at a frequency > 0 [Hz], over sigma^2, in a record of `samples`
/// every `interval` s.
double calc_color(const SensorColor& color, double frequency, std::size_t samples, double interval);

/// Periodogram of a channel's residual in one run, over sigma^2, at the frequencies k / (samples *
/// interval), k = 0 ... samples / 2, and what white noise and common sources let expect there.
struct ResidualSpectrum {
  std::size_t samples = 0;
  double interval = 0.0;                // s
  std::vector<double> power, expected;  // expected 0: not measured
  /// The part of the power that a fit's unknowns leave, where they follow some of it; power is then
  /// over that part. Empty: all.
  std::vector<double> freedom{};
};

/// Estimates the color of a channel from its residuals in all runs, by maximum likelihood over
/// drift with an rms of 0 to 1/2 of sigma (prior: half normal, sigma / 4) and lines at the
/// harmonics of 50 and 60 Hz that exceed the noise by a factor of 12 and have an rms of at most
/// sigma: what is larger is not noise.
SensorColor estimate_color(int channel, std::span<const ResidualSpectrum> residuals);

/// The drift's part of it: the corner frequency [Hz].
double estimate_corner(std::span<const ResidualSpectrum> residuals);

}  // namespace strut
