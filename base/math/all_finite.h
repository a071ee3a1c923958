#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace strut {

/// True if no value is NaN or infinite.
inline bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace strut
