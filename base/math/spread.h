// Moments and quantiles of readings of which some are missing (NaN).
#pragma once

#include <span>

namespace strut {

double calc_mean(std::span<const double> values);
/// Root mean square; 0 without readings.
double calc_rms(std::span<const double> values);
/// Standard deviation about the mean; 0 without readings.
double calc_spread(std::span<const double> values);
/// The largest value that at most `share` of the others are below; 0 without readings.
double calc_quantile(std::span<const double> values, double share);
std::size_t count_readings(std::span<const double> values);

}  // namespace strut
