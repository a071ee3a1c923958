#include "base/math/spread.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace strut {
namespace {

/// Mean of f(value) over the finite values; 0 without any.
template <class F>
double average(std::span<const double> values, const F& f) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += f(v);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

double calc_mean(std::span<const double> values) {
  return average(values, [](double v) { return v; });
}

double calc_rms(std::span<const double> values) {
  return std::sqrt(average(values, [](double v) { return v * v; }));
}

double calc_spread(std::span<const double> values) {
  const double mean = calc_mean(values);
  return std::sqrt(average(values, [mean](double v) { return (v - mean) * (v - mean); }));
}

double calc_quantile(std::span<const double> values, double fraction) {
  std::vector<double> finite;
  finite.reserve(values.size());
  for (const double v : values) {
    if (std::isfinite(v)) finite.push_back(v);
  }
  if (finite.empty()) return 0.0;
  const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(finite.size() - 1));
  std::nth_element(finite.begin(), finite.begin() + at, finite.end());
  return finite[static_cast<std::size_t>(at)];
}

std::size_t count_readings(std::span<const double> values) {
  std::size_t count = 0;
  for (const double v : values) count += std::isfinite(v) ? 1 : 0;
  return count;
}

}  // namespace strut
