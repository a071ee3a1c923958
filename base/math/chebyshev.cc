#include "base/math/chebyshev.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace strut {
namespace {

constexpr auto kN = static_cast<std::size_t>(kChebyshevNodes);

/// cos(pi k (i + 1/2) / n) for all k, i; computed once.
const std::vector<long double>& get_cosines() {
  static const std::vector<long double> table = [] {
    const long double pi = std::acos(-1.0L);
    std::vector<long double> cosines(kN * kN);
    for (std::size_t k = 0; k < kN; ++k) {
      for (std::size_t i = 0; i < kN; ++i) {
        cosines[k * kN + i] = std::cos(pi * static_cast<long double>(k) *
                                       (static_cast<long double>(i) + 0.5L) / kChebyshevNodes);
      }
    }
    return cosines;
  }();
  return table;
}

}  // namespace

double calc_chebyshev_node(int i) {
  return static_cast<double>(get_cosines()[kN + static_cast<std::size_t>(i)]);
}

std::vector<long double> calc_chebyshev_series(const std::vector<double>& values) {
  const std::vector<long double>& cosines = get_cosines();
  std::vector<long double> series(kN, 0.0L);
  for (std::size_t k = 0; k < kN; ++k) {
    for (std::size_t i = 0; i < kN; ++i) series[k] += values[i] * cosines[k * kN + i];
    series[k] *= (k == 0 ? 1.0L : 2.0L) / kChebyshevNodes;
  }
  return series;
}

std::vector<long double> convert_to_powers(const std::vector<long double>& series, int degree) {
  const auto n = static_cast<std::size_t>(degree) + 1;
  std::vector<long double> power(n, 0.0L), previous(n, 0.0L), current(n, 0.0L), next(n);
  previous[0] = 1.0L;
  power[0] = series[0];
  if (degree > 0) power[1] = current[1] = 1.0L;
  if (degree > 0) power[1] *= series[1];
  for (std::size_t k = 2; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      next[i] = (i > 0 ? 2.0L * current[i - 1] : 0.0L) - previous[i];
      power[i] += series[k] * next[i];
    }
    std::swap(previous, current);
    std::swap(current, next);
  }
  return power;
}

int find_degree(const std::vector<long double>& series, long double tolerance, long double floor) {
  long double scale = floor;
  for (long double c : series) scale = std::max(scale, std::abs(c));
  int degree = static_cast<int>(series.size()) - 1;
  while (degree > 0 && std::abs(series[static_cast<std::size_t>(degree)]) < tolerance * scale) {
    --degree;
  }
  return degree;
}

}  // namespace strut
