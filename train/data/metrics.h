// Accuracy of an identification: the five metrics of the paper.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace strut {

/// Metrics of one parameter, errors in its unit. Equations 14 to 18 of Pan, Sun, Min, Li, Gardoni.
struct Metrics {
  double largest_error = 0.0;             // ME = max |y - p|
  double mean_absolute_error = 0.0;       // MAE
  double mean_absolute_percentage = 0.0;  // MAPE = mean |(y - p) / y|, in percent
  double rms_error = 0.0;                 // RMSE
  double r2 = 0.0;                        // 1 - sum (y - p)^2 / sum (y - mean y)^2
};

/// A metric's name in files and tables, and its place in Metrics.
struct MetricInfo {
  const char* name;
  double Metrics::*value;
};
inline constexpr std::array<MetricInfo, 5> kMetrics = {
    {{"ME", &Metrics::largest_error},
     {"MAE", &Metrics::mean_absolute_error},
     {"MAPE", &Metrics::mean_absolute_percentage},
     {"RMSE", &Metrics::rms_error},
     {"R2", &Metrics::r2}}};
/// Indices into kMetrics.
inline constexpr std::size_t kMae = 1, kMape = 2, kRmse = 3, kR2 = 4;

/// Compares `predicted` with `reference`. R2 is NaN if all references are equal, MAPE is not finite
/// if one is zero. Throws std::invalid_argument if there are none or their numbers differ.
Metrics calc_metrics(std::span<const double> reference, std::span<const double> predicted);

}  // namespace strut
