// Landings of a car behind a high bump against tire loads by Newton closure and short steps.
#include "diagnose/noise/landings.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <utility>

#include "estimate/simulate_run.h"
#include "tests/support/fit_case.h"

namespace strut {
namespace {

constexpr double kHit = 0.0123;                       // s, simulated less measured time
constexpr double kReach = 6e-3, kTolerance = 1.1e-3;  // s

Case make_jumping_case() {
  Case c = test::make_paper_case();
  c.maneuver.speed = 14.0;
  c.maneuver.duration = 1.5;
  return c;
}

/// Instants [s] at which a wheel lands.
std::vector<double> list_true_landings(const Case& c, int corner) {
  constexpr double kFine = 1e4;
  const LaneResults truth = test::simulate_truth(c, kFine, false);
  const int load = CarChannel::get_corner_channel(corner, CarChannel::kTireForceZ);
  std::vector<double> landings;
  for (int i = 1; i < truth.sample_count; ++i) {
    const bool lands = truth.get_sample(i - 1, load) <= 0.0 && truth.get_sample(i, load) > 0.0;
    if (lands) landings.push_back(i / kFine);
  }
  return landings;
}

/// The accelerometers of a rear wheel, the body and a front wheel.
MeasuredRun make_planned(const Case& c, double rate) {
  MeasuredRun run{"planned", c, {}, {}};
  for (double t = 0.02; t < 1.4; t += 1.0 / rate) run.times.push_back(t - kHit);
  const int channels[] = {
      CarChannel::get_corner_channel(kRearLeft, CarChannel::kWheelAccelerationZ),
      CarChannel::kImuAccelerationZ,
      CarChannel::get_corner_channel(kFrontRight, CarChannel::kWheelAccelerationZ)};
  for (const int channel : channels) {
    run.channels.push_back({channel, 0.1, std::vector<double>(run.times.size(), 0.0)});
  }
  return run;
}

TEST_CASE("Readings are those of a landing within 6 ms of it at the wheel that lands", "[unit]") {
  const double rate = GENERATE(100.0, 500.0, 2000.0);
  const Case c = make_jumping_case();
  const MeasuredRun run = make_planned(c, rate);
  // The hit time of another run is not this one's.
  const std::vector<Unknown> unknowns{make_hit_time(0, {0.0, 0.05}), make_hit_time(1, {0.0, 0.05})};
  std::set<std::pair<std::size_t, std::size_t>> found;
  for (const auto& [channel, time] : list_landings(run, unknowns, {0.04, kHit}, 1)) {
    found.insert({channel, time});
  }
  const std::pair<std::size_t, int> wheels[] = {{0, kRearLeft}, {2, kFrontRight}};
  std::size_t landings = 0, certain = 0;
  for (const auto& [channel, corner] : wheels) {
    const std::vector<double> instants = list_true_landings(c, corner);
    landings += instants.size();
    for (std::size_t t = 0; t < run.times.size(); ++t) {
      double nearest = 1.0;
      for (const double at : instants) {
        nearest = std::min(nearest, std::abs(run.times[t] + kHit - at));
      }
      const bool is_found = found.erase({channel, t}) > 0;
      if (nearest < kReach - kTolerance) CHECK(is_found);
      if (nearest > kReach + kTolerance) CHECK_FALSE(is_found);
      certain += nearest < kReach ? 1 : 0;
    }
  }
  CHECK(landings >= 2);
  CHECK(static_cast<double>(certain) >=
        0.9 * 2.0 * kReach * rate * static_cast<double>(landings) - 1.0);
  CHECK(found.empty());  // none at the body
}

TEST_CASE("A car that cannot be simulated or whose wheels have no sensor has no landings",
          "[unit]") {
  Case c = make_jumping_case();
  MeasuredRun run = make_planned(c, 500.0);
  CHECK_FALSE(list_landings(run, {}, {}, 0).empty());
  run.channels.erase(run.channels.begin() + 2);
  run.channels.erase(run.channels.begin());
  CHECK(list_landings(run, {}, {}, 0).empty());
  c.maneuver.speed = 40.0;
  c.maneuver.road.length = 0.9;
  c.maneuver.road.height = 0.45;
  CHECK_FALSE(simulate_motion(make_planned(c, 500.0), {}, {}).failure.empty());
  CHECK(list_landings(make_planned(c, 500.0), {}, {}, 0).empty());
}

}  // namespace
}  // namespace strut
