// Straight lines between samples.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace strut {

/// The value at `at` of the line through the samples around it. `x` ascends, has two elements or
/// more, as many as `y`, and spans `at`. `next`: where the search begins, 1 or the result of a call
/// for a smaller `at`; becomes the index of the sample behind it.
inline double interpolate_line(const std::vector<double>& x, const std::vector<double>& y,
                               double at, std::size_t& next) {
  while (next + 1 < x.size() && x[next] < at) ++next;
  return std::lerp(y[next - 1], y[next], (at - x[next - 1]) / (x[next] - x[next - 1]));
}

}  // namespace strut
