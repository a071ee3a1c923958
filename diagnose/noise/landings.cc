#include "diagnose/noise/landings.h"

#include <algorithm>

#include "estimate/hit_time.h"
#include "estimate/simulate_run.h"
#include "model/channel/car_channels.h"

namespace strut {
namespace {

using C = CarChannel;

constexpr double kReach = 6e-3;  // s

/// For each of the times, whether a wheel of this load lands within kReach of it.
std::vector<bool> find_landing_times(const std::vector<double>& times,
                                     const std::vector<double>& load) {
  std::vector<bool> lands(times.size(), false);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(load[i - 1] <= 0.0 && load[i] > 0.0)) continue;
    const auto first = std::lower_bound(times.begin(), times.end(), times[i - 1] - kReach);
    const auto end = std::upper_bound(times.begin(), times.end(), times[i] + kReach);
    std::fill(lands.begin() + (first - times.begin()), lands.begin() + (end - times.begin()), true);
  }
  return lands;
}

}  // namespace

std::vector<LandingReading> list_landings(const MeasuredRun& run,
                                          const std::vector<Unknown>& unknowns,
                                          const std::vector<double>& values, std::size_t number) {
  MeasuredRun there = set_unknowns(run, unknowns, values, static_cast<int>(number));
  const double hit_time = get_hit_time(unknowns, values, number);
  for (double& t : there.times) t += hit_time;
  const RunCurves curves = simulate_run(there, {}, {});
  std::vector<LandingReading> landings;
  if (!curves.failure.empty()) return landings;
  for (int corner = 0; corner < kCorners; ++corner) {
    const int sensed = C::of_corner(corner, C::kWheelAccelerationZ);
    const auto channel =
        std::find_if(run.channels.begin(), run.channels.end(),
                     [=](const MeasuredChannel& c) { return c.channel == sensed; });
    if (channel == run.channels.end()) continue;
    const auto load = static_cast<std::size_t>(C::of_corner(corner, C::kTireForceZ));
    const std::vector<bool> lands = find_landing_times(run.times, curves.channel[load]);
    for (std::size_t t = 0; t < lands.size(); ++t) {
      if (!lands[t]) continue;
      landings.push_back({static_cast<std::size_t>(channel - run.channels.begin()), t});
    }
  }
  return landings;
}

}  // namespace strut
