// Estimates the noise of a sensor from its own record.
#pragma once

#include <array>
#include <span>
#include <string>

#include "base/names/name_table.h"

namespace strut {

enum class NoiseSource { kGiven, kEstimated, kQuantized };
inline constexpr std::array<Named<NoiseSource>, 3> kNoiseSources = {
    {{NoiseSource::kGiven, "given"},
     {NoiseSource::kEstimated, "estimated"},
     {NoiseSource::kQuantized, "quantized"}}};
static_assert(names_all(kNoiseSources, NoiseSource::kQuantized));

struct NoiseEstimate {
  double sigma = 0.0;    // standard deviation of white noise per sample
  double quantum = 0.0;  // smallest difference between readings: a digital sensor's resolution
  NoiseSource source = NoiseSource::kEstimated;
  /// Relative standard error of sigma; 0 where it is given.
  double uncertainty = 0.0;
};

/// Estimates white noise from differences of fourth order, to which a signal well below a tenth of
/// the sampling rate hardly contributes:
///
///   d_i = y_i - 4 y_(i+1) + 6 y_(i+2) - 4 y_(i+3) + y_(i+4),   sigma^2 = median_b mean(d^2) /
///   (0.973 70)
///
/// over blocks b of 64 differences; 70 = 1 + 16 + 36 + 16 + 1, and 0.973 is the ratio of median to
/// mean of such a block. The median ignores fast motion in less than half of the record, such as a
/// bump or a stop. White noise is measured to 2 % in 10000 samples. (Differences of order k as a
/// noise estimate: P. Hall, J. W. Kay, D. M. Titterington, Biometrika 77 (1990).) Sigma is at least
/// that of the rounding to the sensor's quantum q, q / sqrt(12). Missing samples (NaN) are ignored.
///
/// Motion that is fast on purpose, up to a third of the sampling rate, is in the differences, too.
/// White noise has the same power in every band: where the quietest of six bands between an eighth
/// and a half of the sampling rate (Blackman-Harris windows of 64 samples, whose leakage is 92 dB
/// down, median over the record) has less than a tenth of the power that the differences suggest,
/// the noise is that band's. Recordings of real machines, with noise that is not white, have more
/// than a fourth of it there.
NoiseEstimate estimate_noise(std::span<const double> values);

}  // namespace strut
