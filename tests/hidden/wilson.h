// Interval of a proportion.
#pragma once

#include <cmath>

namespace strut::hidden {

struct Interval {
  double low = 0.0, high = 1.0;
};

/// E. B. Wilson, J. American Statistical Association 22 (1927) 209: the proportions p with
/// |hits / total - p| <= z sqrt(p (1 - p) / total); [0, 1] for no trial. z = 1.96: 95 %.
inline Interval calc_wilson(int hits, int total, double z = 1.959963984540054) {
  if (total == 0) return {};
  const double n = total, p = hits / n, z2 = z * z;
  const double middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
  const double half = z * std::sqrt(p * (1.0 - p) / n + z2 / (4.0 * n * n)) / (1.0 + z2 / n);
  // At the ends the bound is exact, without rounding.
  return {hits == 0 ? 0.0 : middle - half, hits == total ? 1.0 : middle + half};
}

}  // namespace strut::hidden
