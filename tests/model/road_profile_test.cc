// Roads by their heights, random roads and rows of bumps, against the roads of single bumps, whose
// disc is rolled exactly, and against the density and coherence of ISO 8608.
#include "model/scenario/road_profile.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include "model/error/model_error.h"
#include "model/scenario/iso_road.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::tolerance;

constexpr double kPi = std::numbers::pi;
const ContactGeometry kTire{ContactKind::kEnvelope, 0.3, 0.1};

/// The heights of a bump at `distance` [m] on either track.
RoadProfile survey(const RoadSpec& bump, double distance, double spacing) {
  RoadProfile profile{0.0, spacing, {}};
  for (double x = 0.0; x < distance + bump.length; x += spacing) {
    profile.height[0].push_back(calc_profile_height(bump, x - distance));
  }
  profile.height[1] = profile.height[0];
  return profile;
}

double calc_height(const RoughTrack& track, double x) {
  const RoughTrack* const tracks[] = {&track};
  double height = 0.0, slope = 0.0;
  add_roughness(make_rough_tracks<double>(tracks), x, height, slope);
  return height;
}

double calc_height(const Surface& surface, double x) {
  const Surface* const surfaces[] = {&surface};
  const double center = 0.0;
  const Road<double> road = make_road<double>(surfaces, &center);
  return calc_road_point(road, x, find_segment(road, x)).height;
}

LaneResults simulate(const Case& c, double step = 1e-3) {
  IntegrateOptions options;
  options.step.step = step;
  options.closure = Closure::kTable;
  SamplePlan plan = test::make_plan(5e-3);
  plan.snapshot = false;
  return list_kernels().front().run_scalar(test::prepare(c), options, plan);
}

/// Worst difference of two runs as a fraction of the first one's motion.
double compare(const LaneResults& a, const LaneResults& b) {
  double worst = 0.0;
  for (const int channel :
       {CarChannel::kImuAccelerationZ, CarChannel::kImuRateX, CarChannel::kImuRateY}) {
    double motion = 0.0, off = 0.0;
    for (int i = 0; i < a.sample_count; ++i) {
      motion = std::max(motion, std::abs(a.get_sample(i, channel) - a.get_sample(0, channel)));
      off = std::max(off, std::abs(a.get_sample(i, channel) - b.get_sample(i, channel)));
    }
    if (motion > 1e-6) worst = std::max(worst, off / motion);
  }
  return worst;
}

TEST_CASE("A tire follows a surveyed bump as it follows the bump's formula", "[property]") {
  const auto shape = GENERATE(BumpShape::kCosine, BumpShape::kHalfSine, BumpShape::kTrapezoid);
  RoadSpec bump;
  bump.shape = shape;
  bump.height = 0.04;
  bump.length = 0.6;
  const Surface exact = make_surface(bump, kTire);
  const RoughTrack track = follow_profile(survey(bump, 2.0, 0.004), kTire, 2.0)[0];
  double worst = 0.0, highest = 0.0;
  for (double x = -1.0; x < 1.0; x += 0.0037) {
    worst = std::max(worst, std::abs(calc_height(track, x) - calc_height(exact, x)));
    highest = std::max(highest, calc_height(exact, x));
  }
  CAPTURE(static_cast<int>(shape), worst);
  // Where the disc changes from one flank to the next, its center moves along a kink, which the
  // average over 0.1 m at every 12.5 mm cuts off.
  CHECK(worst < tolerance(1e-4));
  CHECK(highest > 0.035);
}

TEST_CASE("A narrow hole is bridged by the tire, and followed by a point", "[property]") {
  RoadProfile profile{0.0, 0.01, {}};
  profile.height[0].assign(300, 0.0);
  for (std::size_t i = 148; i < 153; ++i) profile.height[0][i] = -0.05;
  profile.height[1] = profile.height[0];
  const double tire = calc_height(follow_profile(profile, kTire, 1.5)[0], 0.0);
  const double point =
      calc_height(follow_profile(profile, {ContactKind::kPoint, 0.3, 0.1}, 1.5)[0], 0.0);
  CHECK(point == Approx(-0.05).margin(1e-3));
  // A disc over a gap of width w sinks by R - sqrt(R^2 - w^2 / 4); 1 mm for the widest, 50 mm.
  CHECK(tire < 0.0);
  CHECK(tire > -0.0011);
}

TEST_CASE("A car on a surveyed bump moves as over the bump itself", "[property]") {
  Case bump = test::make_paper_case();
  bump.maneuver = test::make_gentle_maneuver();
  bump.maneuver.road.length = 1.0;
  Case surveyed = bump;
  surveyed.maneuver.road.shape = BumpShape::kNone;
  RoadProfile profile = survey(bump.maneuver.road, bump.maneuver.bump_distance, 0.01);
  SECTION("under both tracks") {}
  SECTION("under the left track") {
    bump.maneuver.road.side = BumpSide::kLeft;
    profile.height[1].assign(profile.height[0].size(), 0.0);
  }
  surveyed.maneuver.profile.data = std::make_shared<const RoadProfile>(profile);
  SECTION("counted from another bump's center") { surveyed.maneuver.bump_distance = 2.0; }
  const LaneResults a = simulate(bump), b = simulate(surveyed);
  REQUIRE(a.is_done());
  REQUIRE(b.is_done());
  CHECK(compare(a, b) < tolerance(3e-3));
}

TEST_CASE("A preparer makes the tracks anew for another tire, place or road", "[unit]") {
  Case base = test::make_paper_case();
  base.maneuver.profile.data = std::make_shared<const RoadProfile>(make_iso_road({}));
  std::vector<Case> cases(6, base);
  cases[1].maneuver.bump_distance += 1.0;
  cases[2].vehicle.tire.unloaded_radius *= 0.9;
  cases[2].vehicle.pacejka.UNLOADED_RADIUS *= 0.9;
  cases[3].vehicle.tire.footprint = 0.2;
  IsoRoad other;
  other.seed = 2;
  cases[4].maneuver.profile.data = std::make_shared<const RoadProfile>(make_iso_road(other));
  cases[5].maneuver.speed = 10.0;
  CasePreparer preparer;
  std::vector<PreparedCase> prepared;
  for (const Case& c : cases) {
    prepared.push_back(preparer.prepare(c));
    CHECK(prepared.back().rough == test::prepare(c).rough);
  }
  for (std::size_t i = 1; i < 5; ++i) {
    CAPTURE(i);
    CHECK_FALSE(prepared[i].rough == prepared[0].rough);
  }
  CHECK(prepared[5].rough == prepared[0].rough);
  // The place in the world stays, whatever the bump's.
  CHECK(prepared[1].rough[0].begin + prepared[1].bump_center ==
        Approx(prepared[0].rough[0].begin + prepared[0].bump_center));
}

TEST_CASE("Lanes over one surveyed road are the runs of each alone", "[property]") {
  Case c = test::make_paper_case();
  c.maneuver = test::make_gentle_maneuver();
  c.maneuver.road.shape = BumpShape::kNone;
  c.maneuver.profile.data = std::make_shared<const RoadProfile>(make_iso_road({}));
  const Kernel& kernel = list_kernels().front();
  IntegrateOptions options;
  options.closure = Closure::kTable;
  SamplePlan plan = test::make_plan(5e-3);
  plan.snapshot = false;
  CasePreparer preparer;
  std::vector<PreparedCase> cases;
  for (int lane = 0; lane < kernel.lanes; ++lane) {
    c.maneuver.speed = 15.0 + lane;
    cases.push_back(preparer.prepare(c));
  }
  std::vector<const PreparedCase*> list;
  for (const PreparedCase& one : cases) list.push_back(&one);
  const LaneResults together = kernel.run_lanes(list.data(), kernel.lanes, options, plan);
  for (int lane = 0; lane < kernel.lanes; ++lane) {
    const LaneResults alone =
        kernel.run_scalar(cases[static_cast<std::size_t>(lane)], options, plan);
    const std::vector<double> a = together.get_history(CarChannel::kImuAccelerationZ, lane);
    const std::vector<double> b = alone.get_history(CarChannel::kImuAccelerationZ);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      REQUIRE(a[i] == Approx(b[i]).epsilon(tolerance(1e-7)).margin(tolerance(1e-7)));
    }
  }
}

TEST_CASE("A run on a random road converges with its step", "[property]") {
  Case c = test::make_paper_case();
  c.maneuver.duration = 1.5;
  c.maneuver.road.shape = BumpShape::kNone;
  IsoRoad iso;
  iso.roughness = 64e-6;  // no wheel lifts off
  c.maneuver.profile.data = std::make_shared<const RoadProfile>(make_iso_road(iso));
  const LaneResults coarse = simulate(c, 1e-3), fine = simulate(c, 0.5e-3);
  const LaneResults finest = simulate(c, 0.125e-3);
  REQUIRE(finest.is_done());
  const double error = compare(finest, coarse), smaller = compare(finest, fine);
  CAPTURE(error, smaller);
  CHECK(error < 1e-5);
  // At the splines' knots, every 12 mm or half a step, the third derivative jumps.
  CHECK(smaller < error / 3.0);
}

/// Mean square of each track's waves from `low` to `high` [1/m], and of what they have in common,
/// by Fourier sums.
struct Band {
  double left = 0.0, right = 0.0, common = 0.0;
};

Band measure_band(const RoadProfile& road, double low, double high) {
  const std::size_t count = road.height[0].size();
  const double length = road.spacing * static_cast<double>(count);
  Band band;
  for (auto k = static_cast<std::size_t>(std::ceil(low * length));
       static_cast<double>(k) < high * length; ++k) {
    std::array<std::complex<double>, 2> wave;
    for (std::size_t side = 0; side < 2; ++side) {
      const double angle = -2.0 * kPi * static_cast<double>(k) / static_cast<double>(count);
      for (std::size_t i = 0; i < count; ++i) {
        wave[side] += road.height[side][i] * std::polar(1.0, angle * static_cast<double>(i));
      }
      wave[side] /= static_cast<double>(count);
    }
    band.left += 2.0 * std::norm(wave[0]);
    band.right += 2.0 * std::norm(wave[1]);
    band.common += 2.0 * (wave[0] * std::conj(wave[1])).real();
  }
  return band;
}

TEST_CASE("A random road has the density of its class", "[statistical]") {
  IsoRoad iso;
  iso.length = 400.0;
  iso.seed = GENERATE(1, 2, 3);
  const RoadProfile road = make_iso_road(iso);
  CHECK(make_iso_road(iso) == road);
  // Integral of G (n0 / n)^2 over a band: G n0^2 (1 / low - 1 / high).
  for (const auto& [low, high] : {std::array{0.05, 0.1}, {0.1, 0.2}, {0.5, 0.6}, {2.0, 2.05}}) {
    CAPTURE(low, high);
    const Band band = measure_band(road, low, high);
    const double expected = 256e-6 * 0.01 * (1.0 / low - 1.0 / high);
    CHECK(band.left == Approx(expected).epsilon(0.12));
    // A sum of two waves of random phases a harmonic.
    CHECK(band.right == Approx(expected).epsilon(0.4));
  }
}

/// Correlation of both tracks in a band, over three long roads.
double measure_correlation(double low, double high) {
  Band sum;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    IsoRoad iso;
    iso.length = 1500.0;
    iso.seed = seed;
    const Band band = measure_band(make_iso_road(iso), low, high);
    sum.left += band.left;
    sum.right += band.right;
    sum.common += band.common;
  }
  return sum.common / std::sqrt(sum.left * sum.right);
}

TEST_CASE("The tracks of a random road are alike as those of an isotropic road", "[statistical]") {
  // Nine tenths of x K_1(x), x = 2 pi n 1.5 m, tabulated: 0.7817 at x = 0.6, 0.2797 at x = 2.0. A
  // band has 90 waves or more, a standard error of 0.07.
  CHECK(measure_correlation(0.0537, 0.0737) == Approx(0.9 * 0.7817).margin(0.15));
  CHECK(measure_correlation(0.19, 0.235) == Approx(0.9 * 0.2797).margin(0.2));
  CHECK(std::abs(measure_correlation(1.0, 1.02)) < 0.2);
}

TEST_CASE("Roads of other seeds differ, those of other classes by a factor", "[unit]") {
  IsoRoad a, b;
  b.seed = 2;
  CHECK_FALSE(make_iso_road(a) == make_iso_road(b));
  b = a;
  b.roughness = 4.0 * a.roughness;
  const RoadProfile one = make_iso_road(a), two = make_iso_road(b);
  for (std::size_t i = 0; i < one.height[0].size(); ++i) {
    REQUIRE(two.height[1][i] == Approx(2.0 * one.height[1][i]).margin(1e-15));
  }
  // Level ends: the car starts on a level road.
  CHECK(one.height[0].front() == 0.0);
  CHECK(std::abs(one.height[0][3]) < 1e-5);
}

TEST_CASE("Profiles out of range are refused by name", "[unit]") {
  RoadProfile road = make_iso_road({});
  const auto refuse = [](const RoadProfile& profile, const char* field) {
    CHECK_THROWS_WITH(validate(profile), Catch::Matchers::Contains(field));
  };
  RoadProfile other = road;
  other.begin = -1.0;
  refuse(other, "road.begin");
  other = road;
  other.height[1].pop_back();
  refuse(other, "on the right");
  other = road;
  other.height[0][7] = std::nan("");
  refuse(other, "road, height");
  other = road;
  other.spacing = 0.0;
  refuse(other, "road.spacing");
  CHECK_THROWS_AS(make_iso_road({-1.0}), ModelError);
}

TEST_CASE("A row of bumps is the bump at each of its places", "[unit]") {
  RoadSpec bump;
  bump.height = 0.03;
  const auto contact = GENERATE(ContactKind::kEnvelope, ContactKind::kPoint);
  const ContactGeometry tire{contact, 0.3, 0.1};
  const Surface one = make_surface(bump, tire);
  RoadSpec row = bump;
  row.count = 3;
  row.spacing = 1.7;
  const Surface three = make_surface(row, tire);
  CHECK(three.cells.size() == one.cells.size());
  for (double x = -1.0; x < 5.0; x += 0.0071) {
    double expected = 0.0;
    for (int i = 0; i < 3; ++i) expected += calc_height(one, x - 1.7 * i);
    REQUIRE(calc_height(three, x) == Approx(expected).margin(tolerance(1e-13)));
    if (std::abs(x - 3.4) < 0.1) REQUIRE(expected > 0.02);
  }
  RoadSpec uneven = row;  // a table that is not centered
  uneven.shape = BumpShape::kTable;
  uneven.table_x = {-0.2, 0.0, 1.2};
  uneven.table_z = {0.0, 0.03, 0.0};
  RoadSpec single = uneven;
  single.count = 1;
  for (const double x : {-0.1, 0.5, 1.1}) {
    CHECK(calc_profile_height(uneven, x + 3.4) == Approx(calc_profile_height(single, x)));
  }
  CHECK(calc_profile_height(row, 3.4) == Approx(0.03));
  CHECK(calc_profile_height(row, 5.1) == 0.0);
  row.spacing = 0.42;
  if (contact == ContactKind::kEnvelope) {
    CHECK_THROWS_WITH(make_surface(row, tire), Catch::Matchers::Contains("road.spacing"));
  }
}

/// Two bumps of a table against a row of two.
TEST_CASE("A car over a row of bumps moves as over a table of them", "[property]") {
  Case row = test::make_paper_case();
  row.maneuver = test::make_gentle_maneuver();
  row.maneuver.road.length = 1.0;
  row.maneuver.road.count = 2;
  row.maneuver.road.spacing = 4.0;
  Case table = row;
  RoadSpec& road = table.maneuver.road;
  road.count = 1;
  road.shape = BumpShape::kTable;
  for (int i = 0; i <= 500; ++i) {
    road.table_x.push_back(-0.5 + 0.01 * i);
    road.table_z.push_back(calc_profile_height(row.maneuver.road, road.table_x.back()));
  }
  road.table_z.back() = 0.0;
  const LaneResults a = simulate(row), b = simulate(table);
  REQUIRE(a.is_done());
  REQUIRE(b.is_done());
  CHECK(compare(a, b) < tolerance(1e-3));
  Case one = row;
  one.maneuver.road.count = 1;
  CHECK(compare(a, simulate(one)) > 0.1);
}

}  // namespace
}  // namespace strut
