#include "diagnose/campaign/move_to_clock.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strut {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Between the two samples around `time`; NaN outside, and where one of them is missing.
double interpolate(const std::vector<double>& times, const std::vector<double>& values,
                   double time) {
  if (times.empty() || time < times.front() || time > times.back()) return kMissing;
  const auto after =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  if (times[after] == time) return values[after];
  const double fraction = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return (1.0 - fraction) * values[after - 1] + fraction * values[after];
}

std::size_t find_nearest(const std::vector<double>& times, double time) {
  const auto after =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  if (after == 0) return 0;
  if (after == times.size()) return after - 1;
  return time - times[after - 1] <= times[after] - time ? after - 1 : after;
}

/// The lengths of the intervals on both sides of a sample; at the ends that of the one there is.
double calc_reach(const std::vector<double>& times, std::size_t i) {
  const double before = i > 0 ? times[i] - times[i - 1] : times[i + 1] - times[i];
  const double behind = i + 1 < times.size() ? times[i + 1] - times[i] : before;
  return 0.5 * std::max(before, behind);
}

}  // namespace

std::vector<double> move_to_clock(const std::vector<double>& own_times,
                                  const std::vector<double>& values,
                                  const std::vector<double>& times, bool is_input) {
  std::vector<double> moved(times.size(), kMissing);
  if (times.size() < 2) return moved;
  const double own_span = own_times.empty() ? 0.0 : own_times.back() - own_times.front();
  const double rate = static_cast<double>(times.size() - 1) / (times.back() - times.front());
  const bool is_faster = static_cast<double>(own_times.size()) > 1.0 + own_span * rate;
  if (is_input || is_faster) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      moved[i] = interpolate(own_times, values, times[i]);
    }
    return moved;
  }
  for (std::size_t i = 0; i < own_times.size(); ++i) {
    const std::size_t at = find_nearest(times, own_times[i]);
    if (std::abs(own_times[i] - times[at]) > (1.0 + 1e-9) * calc_reach(times, at)) continue;
    const double value = interpolate(own_times, values, times[at]);
    // At the ends there may be no two samples around the time.
    moved[at] = std::isnan(value) && own_times[i] == times[at] ? values[i] : value;
  }
  return moved;
}

}  // namespace strut
