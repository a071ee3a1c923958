// A smooth curve through equidistant samples.
#pragma once

#include <cstddef>

namespace strut {

struct CurvePoint {
  double value = 0.0, slope = 0.0;
};

/// Number of samples needed on either side of the interval.
inline constexpr std::size_t kCurveMargin = 2;

/// Cubic Hermite interpolation at (index + theta) * step, theta in [0, 1], of the samples get(i),
/// with slopes by five-point differences: continuous with its slope, error step^4 / 384 y'''' to
/// leading order. Needs samples index - kCurveMargin ... index + 1 + kCurveMargin.
template <class Get>
CurvePoint interpolate_curve(const Get& get, std::size_t index, double theta, double step) {
  double y[6];
  for (std::size_t i = 0; i < 6; ++i) y[i] = get(index + i - kCurveMargin);
  const double d0 = (y[0] - 8.0 * y[1] + 8.0 * y[3] - y[4]) / 12.0;
  const double d1 = (y[1] - 8.0 * y[2] + 8.0 * y[4] - y[5]) / 12.0;
  const double rise = y[3] - y[2];
  const double b = 3.0 * rise - 2.0 * d0 - d1, a = d0 + d1 - 2.0 * rise;
  return {y[2] + theta * (d0 + theta * (b + theta * a)),
          (d0 + theta * (2.0 * b + theta * 3.0 * a)) / step};
}

}  // namespace strut
