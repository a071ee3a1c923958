#include "diagnose/baseline/time_windows.h"

#include <algorithm>

namespace strut {
namespace {

constexpr int kRigWindows = 5;
constexpr double kFootprint = 0.1;  // m, half the contact patch before and after the bump

std::vector<TimeWindow> make_rig_windows(const RigRun& run) {
  std::vector<TimeWindow> windows;
  windows.reserve(kRigWindows);
  for (int i = 0; i < kRigWindows; ++i) {
    const double from = run.times.back() * i / kRigWindows;
    const double to =
        i + 1 == kRigWindows ? run.times.back() + 1.0 : run.times.back() * (i + 1) / kRigWindows;
    windows.push_back({"segment " + std::to_string(i + 1), from, to});
  }
  return windows;
}

std::vector<TimeWindow> make_car_windows(const MeasuredRun& run) {
  const ManeuverSpec& m = run.setup.maneuver;
  const double last = run.times.back() + 1.0, first = std::min(0.0, run.times.front());
  const double half = 0.5 * m.road.length + kFootprint;
  const double front = m.bump_distance;
  const double rear = front + run.setup.vehicle.whole.wheelbase();
  const auto time = [&](double way) { return std::clamp(way / m.speed, first, last); };
  const double leave = std::min(time(front + half), time(rear - half));
  return {{"approach", first, time(front - half)},
          {"front axle", time(front - half), leave},
          {"between", leave, time(rear - half)},
          {"rear axle", time(rear - half), time(rear + half)},
          {"ring-down", time(rear + half), last}};
}

}  // namespace

std::vector<TimeWindow> make_time_windows(const CampaignData& data, std::size_t run) {
  return data.is_rig() ? make_rig_windows(data.rigs[run]) : make_car_windows(data.cars[run]);
}

}  // namespace strut
