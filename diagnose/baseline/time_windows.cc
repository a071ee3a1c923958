#include "diagnose/baseline/time_windows.h"

#include <fmt/format.h>

#include <algorithm>

namespace strut {
namespace {

constexpr int kSegments = 5;
constexpr double kFootprint = 0.1;  // m, half the contact patch before and after the bump

std::vector<TimeWindow> make_segments(const MeasuredRun& run) {
  std::vector<TimeWindow> windows;
  windows.reserve(kSegments);
  for (int i = 0; i < kSegments; ++i) {
    const double from = run.times.back() * i / kSegments;
    const double to = run.times.back() * (i + 1) / kSegments;
    windows.push_back({fmt::format("segment {} of {}", i + 1, kSegments), from, to});
  }
  return windows;
}

std::vector<TimeWindow> make_axle_windows(const MeasuredRun& run) {
  const ManeuverSpec& m = run.setup.car().maneuver;
  const double last = run.times.back(), first = std::min(0.0, run.times.front());
  const double half = 0.5 * m.road.length + kFootprint;
  const double front = m.bump_distance;
  const double rear = front + run.setup.car().vehicle.whole.wheelbase();
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
  return data.has_inputs() ? make_segments(data.runs[run]) : make_axle_windows(data.runs[run]);
}

}  // namespace strut
