#include "diagnose/noise/landings.h"

#include <algorithm>
#include <cmath>

#include "base/error/input_error.h"
#include "estimate/hit_time.h"
#include "estimate/simulate_run.h"
#include "model/channel/car_channels.h"

namespace strut {
namespace {

using C = CarChannel;

constexpr double kReach = 6e-3;     // s
constexpr double kInterval = 1e-3;  // s, between simulated loads

/// The instants [s] at which a wheel of this load lands.
std::vector<double> list_instants(const std::vector<double>& times,
                                  const std::vector<double>& load) {
  std::vector<double> instants;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (load[i - 1] <= 0.0 && load[i] > 0.0) instants.push_back(0.5 * (times[i - 1] + times[i]));
  }
  return instants;
}

/// Every kInterval on the clock of the simulation, from kReach before the first reading to kReach
/// after the last.
std::vector<double> list_load_times(const MeasuredRun& run, double hit_time) {
  const double begin = std::max(0.0, run.times.front() + hit_time - kReach);
  const double end = run.times.back() + hit_time + kReach;
  std::vector<double> times;
  for (double i = std::floor(begin / kInterval); i * kInterval <= end; ++i) {
    times.push_back(i * kInterval);
  }
  return times;
}

}  // namespace

std::vector<LandingReading> list_landings(const MeasuredRun& run,
                                          const std::vector<Unknown>& unknowns,
                                          const std::vector<double>& values, std::size_t number) {
  const double hit_time = get_hit_time(unknowns, values, number);
  const std::vector<double> times = list_load_times(run, hit_time);
  RunCurves curves;
  try {
    MeasuredRun there = set_unknowns(run, unknowns, values, static_cast<int>(number));
    there.times = times;
    curves = simulate_motion(there, {}, {});
  } catch (const InputError& e) {
    curves.failure = e.what();
  }
  std::vector<LandingReading> landings;
  if (!curves.failure.empty()) return landings;
  for (int corner = 0; corner < kCorners; ++corner) {
    const int sensed = C::get_corner_channel(corner, C::kWheelAccelerationZ);
    const auto channel =
        std::find_if(run.channels.begin(), run.channels.end(),
                     [=](const MeasuredChannel& c) { return c.channel == sensed; });
    if (channel == run.channels.end()) continue;
    const auto load = static_cast<std::size_t>(C::get_corner_channel(corner, C::kTireForceZ));
    const std::vector<double> instants = list_instants(times, curves.channel[load]);
    for (std::size_t t = 0; t < run.times.size(); ++t) {
      const auto is_near = [&](double instant) {
        return std::abs(run.times[t] + hit_time - instant) <= kReach + 0.5 * kInterval;
      };
      if (std::none_of(instants.begin(), instants.end(), is_near)) continue;
      landings.push_back({static_cast<std::size_t>(channel - run.channels.begin()), t});
    }
  }
  return landings;
}

}  // namespace strut
