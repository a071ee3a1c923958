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

/// Number of samples of an interpolation, on either side of its interval or at an end.
inline constexpr std::size_t kCurveSamples = 2 * kCurveMargin + 2;

/// Value at `position` (in samples, 0 to count - 1) of `count` >= kCurveSamples samples get(i): by
/// interpolate_curve, or within kCurveMargin of an end by the polynomial through the kCurveSamples
/// samples there (Lagrange's; error below step^6 y^(6) / 42).
template <class Get>
double interpolate_samples(const Get& get, std::size_t count, double position) {
  const auto index = static_cast<std::size_t>(position);
  if (index >= kCurveMargin && index + 1 + kCurveMargin < count) {
    return interpolate_curve(get, index, position - static_cast<double>(index), 1.0).value;
  }
  const std::size_t first = index < kCurveMargin ? 0 : count - kCurveSamples;
  double value = 0.0;
  for (std::size_t i = 0; i < kCurveSamples; ++i) {
    double weight = 1.0;
    for (std::size_t k = 0; k < kCurveSamples; ++k) {
      if (k == i) continue;
      weight *= (position - static_cast<double>(first + k)) /
                (static_cast<double>(i) - static_cast<double>(k));
    }
    value += weight * get(first + i);
  }
  return value;
}

}  // namespace strut
