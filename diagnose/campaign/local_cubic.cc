#include "diagnose/campaign/local_cubic.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/math/spread.h"

namespace strut {
namespace {

constexpr std::size_t kMinReadings = 6;  // of a cubic's four numbers

/// Extends the readings [first, last) of a window around time i to the next ones on either side
/// until kMinReadings of them are there or no others are left: a clock with jitter leaves narrow
/// windows a reading short.
void widen(std::span<const double> times, std::span<const double> values, std::size_t i,
           std::size_t& first, std::size_t& last) {
  std::size_t count = count_readings(values.subspan(first, last - first));
  while (count < kMinReadings && (first > 0 || last < times.size())) {
    const bool back =
        last == times.size() || (first > 0 && times[i] - times[first - 1] < times[last] - times[i]);
    const std::size_t next = back ? --first : last++;
    count += std::isfinite(values[next]) ? 1 : 0;
  }
}

/// Least-squares cubic in (t - times[i]) / half_width through the readings [first, last); false
/// where they are too few.
bool fit_cubic(std::span<const double> times, std::span<const double> values, std::size_t i,
               double half_width, std::size_t first, std::size_t last, Eigen::Vector4d& cubic) {
  if (count_readings(values.subspan(first, last - first)) < kMinReadings) return false;
  Eigen::Matrix4d gram = Eigen::Matrix4d::Zero();
  Eigen::Vector4d moment = Eigen::Vector4d::Zero();
  for (std::size_t k = first; k < last; ++k) {
    if (!std::isfinite(values[k])) continue;
    const double s = (times[k] - times[i]) / half_width;
    const Eigen::Vector4d powers(1.0, s, s * s, s * s * s);
    gram += powers * powers.transpose();
    moment += values[k] * powers;
  }
  cubic = gram.ldlt().solve(moment);
  return true;
}

}  // namespace

SmoothCurve calc_local_cubic(std::span<const double> times, std::span<const double> values,
                             double half_width, CurveEnds ends) {
  const std::vector<double> none(times.size(), std::numeric_limits<double>::quiet_NaN());
  SmoothCurve curve{none, none, none};
  const double reach = half_width * (1.0 + 1e-9);
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    // At an end the window stays a whole one and its cubic is read off its middle.
    const double middle =
        std::max(times.front() + half_width, std::min(times[i], times.back() - half_width));
    if (ends == CurveEnds::kNone && std::abs(middle - times[i]) > 1e-3 * half_width) continue;
    while (first < i && times[first] < middle - reach) ++first;
    while (last < times.size() && times[last] <= middle + reach) ++last;
    std::size_t begin = first, end = last;
    if (ends == CurveEnds::kOneSided) widen(times, values, i, begin, end);
    Eigen::Vector4d cubic;
    if (!fit_cubic(times, values, i, half_width, begin, end, cubic)) continue;
    curve.value[i] = cubic(0);
    curve.rate[i] = cubic(1) / half_width;
    curve.second_rate[i] = 2.0 * cubic(2) / (half_width * half_width);
  }
  return curve;
}

double choose_half_width(std::span<const double> times, std::span<const double> values,
                         double sigma) {
  constexpr std::array kWidths = {3, 4, 6, 8, 12, 16, 24, 32};  // in intervals
  constexpr double kClear = 1.7;                                // of the noise's rms
  constexpr double kMaxRemoved = 0.1;                           // of sigma
  // Leverage of the middle of 2 m + 1 even readings in a cubic: what noise leaves there.
  const auto calc_left = [](double m) {
    const double n = 2.0 * m + 1.0;
    return std::sqrt(1.0 - 3.0 * (3.0 * n * n - 7.0) / (4.0 * n * (n * n - 4.0)));
  };
  const double interval = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  double max_width = std::numeric_limits<double>::infinity(), best = 0.0;
  for (const int m : kWidths) {
    const double half_width = m * interval;
    if (half_width * 4.0 > times.back() - times.front()) break;
    const SmoothCurve curve = calc_local_cubic(times, values, half_width);
    std::vector<double> left(values.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = values[i] - curve.value[i];
    const double noise = sigma * calc_left(m), rms = calc_rms(left);
    best = half_width;
    if (rms <= kClear * noise) continue;
    const double removed = std::sqrt(rms * rms - noise * noise);
    max_width = half_width * std::pow(kMaxRemoved * sigma / removed, 0.25);
    break;
  }
  if (best <= max_width) return best;
  const auto narrower = [&](int m) { return m * interval <= max_width; };
  const auto found = std::find_if(kWidths.rbegin(), kWidths.rend(), narrower);
  return found == kWidths.rend() ? 0.0 : *found * interval;
}

double calc_second_rate_gain(double half_width, double interval) {
  const auto m = static_cast<int>(std::floor(half_width / interval + 1e-9));
  double n = 0.0, second = 0.0, fourth = 0.0;
  for (int k = -m; k <= m; ++k) {
    const double s = k * interval;
    n += 1.0;
    second += s * s;
    fourth += s * s * s * s;
  }
  // Variance of the quadratic's coefficient, whose basis shares only the constant with it.
  return 2.0 / std::sqrt(fourth - second * second / n);
}

}  // namespace strut
