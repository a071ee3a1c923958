// The noise of a sensor from its own record.
#pragma once

#include <span>
#include <string>

namespace strut {

enum class NoiseSource { kGiven, kEstimated, kQuantized };

struct NoiseEstimate {
  double sigma = 0.0;    // 1 sigma of white noise per sample
  double quantum = 0.0;  // smallest difference between readings; what a digital sensor resolves
  NoiseSource source = NoiseSource::kEstimated;
  /// 1 sigma of sigma itself, relative: 0 where it is given.
  double uncertainty = 0.0;
};

/// From differences of fourth order, which a signal that lives well below a tenth of the sampling
/// rate hardly reaches:
///
///   d_i = y_i - 4 y_(i+1) + 6 y_(i+2) - 4 y_(i+3) + y_(i+4),   sigma^2 = median_b mean(d^2) /
///   (0.973 70)
///
/// over blocks b of 64 differences; 70 = 1 + 16 + 36 + 16 + 1, and 0.973 is the median over the
/// mean of such a block. The median leaves aside what is fast in less than half of the record, a
/// bump or a stop. White noise is measured to 2 % in 10000 samples. (Differences of order k as a
/// noise estimate: P. Hall, J. W. Kay, D. M. Titterington, Biometrika 77 (1990).) Where the
/// sensor's quantum q is coarser than its noise, sigma is at least that of rounding, q / sqrt(12).
/// Missing samples (NaN) are left aside.
NoiseEstimate estimate_noise(std::span<const double> values);

}  // namespace strut
