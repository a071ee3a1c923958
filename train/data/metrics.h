// How good an identification is: the paper's five figures.
#pragma once

#include <span>

namespace strut {

/// Of one parameter, in its own unit where it has one. Equations 14 to 18 of Pan, Sun, Min, Li,
/// Gardoni.
struct Metrics {
  double largest_error = 0.0;             // ME = max |y - p|
  double mean_absolute_error = 0.0;       // MAE
  double mean_absolute_percentage = 0.0;  // MAPE = mean |(y - p) / y|, in per cent
  double rms_error = 0.0;                 // RMSE
  double r2 = 0.0;                        // 1 - sum (y - p)^2 / sum (y - mean y)^2
};

/// Of `predicted` against `reference`, equally many. R2 is NaN where all references are equal, MAPE
/// not finite where one is zero. Throws std::invalid_argument where there are none or they differ
/// in number.
Metrics calc_metrics(std::span<const double> reference, std::span<const double> predicted);

}  // namespace strut
