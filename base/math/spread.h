// Moments and quantiles of readings; those that are not finite count as missing.
#pragma once

#include <span>

namespace strut {

/// Mean; 0 without readings.
double calc_mean(std::span<const double> values);
/// Root mean square; 0 without readings.
double calc_rms(std::span<const double> values);
/// Standard deviation about the mean; 0 without readings.
double calc_spread(std::span<const double> values);
/// Order statistic number floor(fraction * (n - 1)) of n readings, counted from 0, `fraction` in
/// [0, 1]; 0 without readings.
double calc_quantile(std::span<const double> values, double fraction);
std::size_t count_readings(std::span<const double> values);

}  // namespace strut
