// Rough tracks: splines against lines, which they hold exactly, and against a bump of the same
// heights under a car.
#include "model/scenario/rough_track.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "base/math/xsimd_backend.h"
#include "model/scenario/road.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::tolerance;

RoadPoint<double> calc_point(const RoughTrack& track, double x) {
  const RoughTrack* const tracks[] = {&track};
  RoadPoint<double> point{0.0, 0.0};
  add_roughness(make_rough_tracks<double>(tracks), x, point.height, point.slope);
  return point;
}

/// Coefficient i weighs what is around begin + (i + 2) spacing: B-splines hold z = x with these.
RoughTrack make_line(double slope) {
  RoughTrack track{-1.0, 0.1, {}};
  for (int i = 0; i < 20; ++i) track.coefficients.push_back(slope * (-1.0 + 0.1 * (i + 2)));
  return track;
}

TEST_CASE("A rough track holds a line, with its slope, and is level with its ends outside",
          "[unit]") {
  const RoughTrack track = make_line(0.3);
  for (const double x : {-0.65, -0.31, 0.0, 0.123, 0.7, 0.95}) {
    CHECK(calc_point(track, x).height == Approx(0.3 * x).margin(tolerance(1e-14)));
    CHECK(calc_point(track, x).slope == Approx(0.3).epsilon(tolerance(1e-13)));
  }
  // Its support ends 23 spacings behind its begin.
  for (const double x : {-50.0, -1.0, 1.3, 50.0}) {
    CHECK(calc_point(track, x).height == Approx(0.0).margin(1e-18));
    CHECK(calc_point(track, x).slope == Approx(0.0).margin(1e-16));
  }
  CHECK(calc_point({}, 0.0).height == 0.0);
}

TEST_CASE("Lanes with different tracks have the heights of each by itself", "[property]") {
  using T = NativeLanes;
  const RoughTrack line = make_line(0.3), wave{0.2, 0.25, {1e-3, -2e-3, 4e-3}}, smooth;
  const RoughTrack* const choice[] = {&line, &smooth, &wave};
  std::vector<const RoughTrack*> tracks(static_cast<std::size_t>(kLaneCount<T>));
  for (std::size_t lane = 0; lane < tracks.size(); ++lane) tracks[lane] = choice[lane % 3];
  const RoughTracks<T> together = make_rough_tracks<T>(tracks.data());
  CHECK(together.is_rough);
  for (const double x : {-1.2, 0.0, 0.41, 0.9, 2.0}) {
    T height(0.0), slope(0.0);
    add_roughness(together, T(x), height, slope);
    for (int lane = 0; lane < kLaneCount<T>; ++lane) {
      const RoadPoint<double> alone = calc_point(*tracks[static_cast<std::size_t>(lane)], x);
      CHECK(get_lane(height, lane) == Approx(alone.height).margin(tolerance(1e-16)));
      CHECK(get_lane(slope, lane) == Approx(alone.slope).margin(tolerance(1e-15)));
    }
  }
}

/// A cosine bump as a rough track: coefficients z - h^2 z'' / 6 hold cubics.
RoughTrack make_cosine(double height, double length) {
  constexpr double kSpacing = 0.02, kTwoPi = 6.283185307179586;
  const double k = kTwoPi / length;
  RoughTrack track{-0.5 * length - 4.0 * kSpacing, kSpacing, {}};
  while (true) {
    const auto number = static_cast<double>(track.coefficients.size());
    const double x = track.begin + kSpacing * (number + 2.0);
    if (x > 0.5 * length + 2.0 * kSpacing) break;
    const bool is_on = std::abs(x) < 0.5 * length;
    const double wave = 0.5 * height * std::cos(k * x);
    track.coefficients.push_back(
        is_on ? 0.5 * height + wave + kSpacing * kSpacing / 6.0 * k * k * wave : 0.0);
  }
  return track;
}

LaneResults simulate(const Case& c) {
  IntegrateOptions options;
  options.step.step = 1e-3;
  options.closure = Closure::kTable;
  SamplePlan plan = test::make_plan(5e-3);
  plan.snapshot = false;
  return list_kernels().front().run_scalar(test::prepare(c), options, plan);
}

/// A bump that a point follows, of one side alone, and the same heights as a rough track.
TEST_CASE("A car on a rough track moves as over a bump of the same heights", "[property]") {
  constexpr double kHeight = 0.02, kLength = 3.0;
  Case bump = test::make_paper_case();
  bump.maneuver = test::make_gentle_maneuver();
  bump.vehicle.tire.contact = ContactKind::kPoint;
  bump.maneuver.road.height = kHeight;
  bump.maneuver.road.length = kLength;
  bump.maneuver.road.side = BumpSide::kLeft;
  Case rough = bump;
  rough.maneuver.road = RoadSpec{};
  rough.maneuver.road.shape = BumpShape::kNone;
  rough.maneuver.rough[0] = make_cosine(kHeight, kLength);
  const LaneResults a = simulate(bump), b = simulate(rough);
  REQUIRE(a.is_done());
  REQUIRE(b.is_done());
  const std::array<int, 3> channels = {CarChannel::kImuAccelerationZ, CarChannel::kImuRateX,
                                       CarChannel::kImuRateY};
  for (const int channel : channels) {
    CAPTURE(channel);
    double most = 0.0, off = 0.0;
    for (int i = 0; i < a.sample_count; ++i) {
      const double start = a.get_sample(0, channel);
      most = std::max(most, std::abs(a.get_sample(i, channel) - start));
      off = std::max(off, std::abs(a.get_sample(i, channel) - b.get_sample(i, channel)));
    }
    CHECK(off < tolerance(2e-3) * most);
    CHECK(most > 0.0);
  }
}

TEST_CASE("A lead time lets the car start earlier, on the same road", "[property]") {
  Case c = test::make_paper_case();
  c.maneuver = test::make_gentle_maneuver();
  c.maneuver.drive_torque = 0.0;  // the speed at the road is that of the start
  c.maneuver.road.shape = BumpShape::kNone;
  c.maneuver.rough[1] = make_cosine(0.02, 3.0);
  Case early = c;
  early.maneuver.lead_time = 0.1;
  early.maneuver.duration += 0.1;
  const LaneResults a = simulate(c), b = simulate(early);
  // Before the road begins, the car rolls as it started.
  constexpr int kLater = 20;  // samples in 0.1 s
  const auto read = [](const LaneResults& of, int i) {
    return of.get_sample(i, CarChannel::kImuAccelerationZ) -
           of.get_sample(0, CarChannel::kImuAccelerationZ);
  };
  double most = 0.0;
  for (int i = 0; i < a.sample_count; ++i) {
    most = std::max(most, std::abs(read(a, i)));
    CHECK(read(a, i) == Approx(read(b, i + kLater)).margin(tolerance(0.03)));
  }
  CHECK(most > 1.0);
}

}  // namespace
}  // namespace strut
