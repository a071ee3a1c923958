// The left side of a car that moves symmetrically against the whole car.

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "model/effects/catalogue.h"
#include "model/model.h"
#include "model/scenario/iso_road.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using test::tolerance;
using C = CarChannel;
using I = StateIndex;

Case make_case() {
  Case c = test::make_paper_case();
  c.maneuver.duration = 0.9;
  c.maneuver.bump_distance = 3.0;
  return c;
}

IntegrateOptions make_options(Closure closure, Stepper stepper = Stepper::kRk4) {
  IntegrateOptions options;
  options.closure = closure;
  options.step.stepper = stepper;
  return options;
}

LaneResults run(const PreparedCase& c, IntegrateOptions options, bool symmetry) {
  options.symmetry = symmetry;
  return list_kernels().back().run_scalar(c, options, test::make_plan(0.01));
}

/// Largest difference of a channel relative to its largest value over the whole run, over all
/// channels.
double compare(const LaneResults& a, const LaneResults& b) {
  constexpr double kFloor = 1e-2;  // m, rad, N, ...: below it a channel is all rounding
  double worst = 0.0;
  for (int channel = 0; channel < C::kCount; ++channel) {
    double size = kFloor, difference = 0.0;
    for (int i = 0; i < a.sample_count; ++i) {
      REQUIRE(std::isfinite(a.get_sample(i, channel)));
      REQUIRE(std::isfinite(b.get_sample(i, channel)));
      size = std::fmax(size, std::fabs(a.get_sample(i, channel)));
      difference =
          std::fmax(difference, std::fabs(a.get_sample(i, channel) - b.get_sample(i, channel)));
    }
    REQUIRE(std::isfinite(a.get_snapshot(channel) + b.get_snapshot(channel)));
    size = std::fmax(size, std::fabs(a.get_snapshot(channel)));
    difference =
        std::fmax(difference, std::fabs(a.get_snapshot(channel) - b.get_snapshot(channel)));
    worst = std::fmax(worst, difference / size);
  }
  return worst;
}

void check_equal_runs(const PreparedCase& c, const IntegrateOptions& options) {
  REQUIRE(is_symmetric(c));
  const LaneResults whole = run(c, options, false), half = run(c, options, true);
  REQUIRE(whole.is_done());
  REQUIRE(half.is_done());
  CHECK(half.sample_count == whole.sample_count);
  CHECK(half.derivative_count == whole.derivative_count);  // events at the same steps
  CHECK(half.event_count == whole.event_count);
  CHECK(half.get_event_time() == Approx(whole.get_event_time()).epsilon(tolerance(1e-12)));
  CHECK(compare(whole, half) < tolerance(1e-9));
  REQUIRE(half.final_state.size() == whole.final_state.size());
  for (std::size_t i = 0; i < whole.final_state.size(); ++i) {
    CAPTURE(i);
    CHECK(half.final_state[i] == Approx(whole.final_state[i]).margin(tolerance(1e-8)));
  }
}

/// A setting of ordinary size for an effect, at a place.
EffectSetting make_setting(const EffectInfo& effect, const std::string& place) {
  EffectSetting setting{effect.name, place, {}};
  for (const EffectParameter* p : list_effect_parameters(effect, get_car_info())) {
    setting.values.push_back(p->typical);
  }
  if (effect.name == "bump_stop") setting.values[1] = 0.005;
  return setting;
}

bool is_of_one_side(const std::string& place) { return find_corner(place) >= 0; }

TEST_CASE("A symmetric motion of one side has the derivative of the whole car",
          "[unit][reference]") {
  test::Random random(7);
  for (const bool relaxation : {false, true}) {
    Case c = make_case();
    c.vehicle.tire.relaxation = relaxation;
    const PreparedCase p = test::prepare(c);
    Vehicle<double> left = p.vehicle;
    fill_strut_elements<Sides::kLeft>(left);
    const TableClosure<double, double> closure{&p.mechanism->tables};
    for (int trial = 0; trial < 40; ++trial) {
      State<double> x = test::make_random_state(random, 0.5373, 20.0, 0.4673);
      for (const int i : {I::kPosition + 1, I::kQuaternion + 1, I::kQuaternion + 3,
                          I::kVelocity + 1, I::kAngularVelocity, I::kAngularVelocity + 2}) {
        x[static_cast<std::size_t>(i)] = 0.0;
      }
      for (int c2 = 0; c2 < kCorners; c2 += 2) {
        x[static_cast<std::size_t>(c2) + I::kKappa] = random.uniform(-0.02, 0.02);
        x[static_cast<std::size_t>(c2) + I::kTanAlpha] = random.uniform(-0.02, 0.02);
      }
      mirror_left_side(x.data());
      Workspace<double> whole{}, half{};
      State<double> dx{}, expected{};
      calc_derivative(p.vehicle, closure, TireMode::kRolling, x.data(), expected.data(), whole);
      calc_derivative<Sides::kLeft>(left, closure, TireMode::kRolling, x.data(), dx.data(), half);
      mirror_left_side(dx.data());
      const int size = relaxation ? I::kCountWithoutStruts : I::kCountWithoutRelaxation;
      for (int i = 0; i < size; ++i) {
        CAPTURE(trial, i);
        const auto at = static_cast<std::size_t>(i);
        // Accelerations are of order 10 to 1e3, the work's rate of 1e5.
        CHECK(dx[at] == Approx(expected[at]).epsilon(1e-11).margin(tolerance(1e-9)));
      }
    }
  }
}

TEST_CASE("One side's run is the whole car's to rounding", "[unit][reference]") {
  for (const Closure closure : {Closure::kNewton, Closure::kTable}) {
    for (const Stepper stepper : {Stepper::kRk4, Stepper::kAbm4}) {
      CAPTURE(static_cast<int>(closure), static_cast<int>(stepper));
      check_equal_runs(test::prepare(make_case()), make_options(closure, stepper));
    }
  }
}

TEST_CASE("One side's run is the whole car's with relaxing tires, coarse steps and edges",
          "[unit][reference]") {
  IntegrateOptions options = make_options(Closure::kTable, Stepper::kAbm4);
  Case c = make_case();
  SECTION("relaxing tires") { c.vehicle.tire.relaxation = true; }
  SECTION("coarse steps") { options.step.coarse_step = 5e-3; }
  SECTION("events not located") { options.step.locate_events = false; }
  SECTION("a spin as any other state") { options.spin = SpinTreatment::kExplicit; }
  SECTION("a point contact, whose road has kinks") {
    c.vehicle.tire.contact = ContactKind::kPoint;
    c.maneuver.road.shape = BumpShape::kTrapezoid;
    c.maneuver.road.ramp = 0.15;
    c.maneuver.road.height = 0.03;
  }
  SECTION("the same rough road under both sides") {
    c.maneuver.rough.fill({-1.0, 0.2, {1e-3, -2e-3, 3e-3, 1e-3, -1e-3}});
  }
  SECTION("the same surveyed road under both sides") {
    RoadProfile road = make_iso_road({64e-6});
    road.height[1] = road.height[0];
    c.maneuver.profile.data = std::make_shared<const RoadProfile>(road);
  }
  SECTION("a row of bumps") {
    c.maneuver.road.count = 2;
    c.maneuver.road.spacing = 3.0;
  }
  check_equal_runs(test::prepare(c), options);
}

TEST_CASE("An effect of both sides keeps a car symmetric, one of a corner does not",
          "[unit][reference][effects]") {
  const IntegrateOptions options = make_options(Closure::kTable);
  int whole = 0, halves = 0;
  for (const EffectInfo& effect : list_effects()) {
    if (is_of_sensors(effect) || list_effect_parameters(effect, get_car_info()).empty()) continue;
    for (const std::string& place : list_effect_places(effect, get_car_info())) {
      INFO(effect.name << " at " << place);
      Case c = make_case();
      c.maneuver.duration = 0.3;
      c.vehicle.effects = {make_setting(effect, place)};
      const PreparedCase p = test::prepare(c);
      CHECK(is_symmetric(p) == !is_of_one_side(place));
      if (!is_symmetric(p)) {
        ++whole;
        const LaneResults a = run(p, options, false), b = run(p, options, true);
        CHECK(a.history == b.history);
        continue;
      }
      ++halves;
      check_equal_runs(p, options);
    }
  }
  CHECK(halves > 20);
  CHECK(whole > 10);
}

TEST_CASE("What differs left and right is seen", "[unit]") {
  Case c = make_case();
  REQUIRE(is_symmetric(test::prepare(c)));
  SECTION("a spring") { c.vehicle.suspension[kFront].strut[1].stiffness *= 1.0 + 1e-9; }
  SECTION("a damper") { c.vehicle.suspension[kRear].strut[0].damping *= 1.01; }
  SECTION("the steering") { c.vehicle.rack_position = 1e-6; }
  SECTION("the bump") { c.maneuver.road.side = BumpSide::kLeft; }
  SECTION("the tracks of a surveyed road") {
    c.maneuver.profile.data = std::make_shared<const RoadProfile>(make_iso_road({64e-6}));
  }
  SECTION("the road") { c.maneuver.rough[1] = {-1.0, 0.2, {1e-3, -1e-3, 1e-3, 1e-3}}; }
  SECTION("a product of inertia") { c.vehicle.whole.inertia.xy = 1.0; }
  SECTION("the other product of inertia") { c.vehicle.whole.inertia.yz = 1.0; }
  SECTION("a force map") {
    ForceMap map;
    map.place = "front_left";
    map.velocity_low = -1.0;
    map.velocity_high = 1.0;
    map.velocity_count = 4;
    map.deflection_low = -0.1;
    map.deflection_high = 0.1;
    map.deflection_count = 1;
    map.coefficients = {-10.0, -1.0, 1.0, 10.0};
    c.vehicle.force_maps = {map};
  }
  const PreparedCase p = test::prepare(c);
  CHECK_FALSE(is_symmetric(p));
  const IntegrateOptions options = make_options(Closure::kTable);
  CHECK(run(p, options, true).history == run(p, options, false).history);
}

TEST_CASE("A start out of symmetry is seen", "[unit]") {
  const PreparedCase symmetric = test::prepare(make_case());
  REQUIRE(is_symmetric(symmetric));
  for (const int component : {I::kPosition + 1, I::kQuaternion + 3, I::kCorner + 1,
                              I::kVelocity + 1, I::kAngularVelocity, I::kSpin + 3}) {
    CAPTURE(component);
    PreparedCase c = symmetric;
    c.start[static_cast<std::size_t>(component)] += 1e-6;
    CHECK_FALSE(is_symmetric(c));
  }
}

TEST_CASE("One side's lanes serve their own case, and share with no whole car", "[unit]") {
  IntegrateOptions options = make_options(Closure::kTable);
  options.symmetry = true;
  for (const Kernel& kernel : list_kernels()) {
    INFO(kernel.isa);
    std::vector<PreparedCase> cases;
    for (int i = 0; i < kernel.lanes; ++i) {
      Case c = make_case();
      c.maneuver.duration = 0.3;
      c.vehicle.whole.mass += 20.0 * i;  // tables of its own
      cases.push_back(test::prepare(c));
    }
    std::vector<const PreparedCase*> pointers;
    for (const PreparedCase& c : cases) {
      REQUIRE(is_symmetric(c));
      pointers.push_back(&c);
    }
    const SamplePlan plan = test::make_plan(0.01);
    const LaneResults lanes = kernel.run_lanes(pointers.data(), kernel.lanes, options, plan);
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      const LaneResults alone =
          kernel.run_scalar(cases[static_cast<std::size_t>(lane)], options, plan);
      for (const int channel : {int{C::kBodyAccelerationZ}, int{C::kPitchRate}}) {
        CHECK(lanes.get_sample(29, channel, lane) ==
              Approx(alone.get_sample(29, channel)).margin(tolerance(1e-9)));
      }
    }
  }
  // Bit for bit what a lane has beside copies of itself.
  const Kernel& kernel = list_kernels().front();
  Case other_case = make_case();
  other_case.vehicle.suspension[kRear].strut[0].damping *= 0.8;
  other_case.vehicle.suspension[kRear].strut[1].damping *= 0.8;
  other_case.maneuver.duration = 0.8;
  const PreparedCase one = test::prepare(make_case()), other = test::prepare(other_case);
  REQUIRE((is_symmetric(one) && is_symmetric(other)));
  std::vector<const PreparedCase*> mixed, same;
  for (int lane = 0; lane < kernel.lanes; ++lane) {
    mixed.push_back(lane % 2 == 0 ? &one : &other);
    same.push_back(&one);
  }
  const LaneResults beside = kernel.run_lanes(mixed.data(), kernel.lanes, options, {});
  const LaneResults alone = kernel.run_lanes(same.data(), kernel.lanes, options, {});
  for (int channel = 0; channel < C::kCount; ++channel) {
    CHECK(beside.get_snapshot(channel, 0) == alone.get_snapshot(channel, 0));
  }
  for (int i = 0; i < I::kCountWithoutRelaxation; ++i) {
    CHECK(beside.get_final_state(i, 0) == alone.get_final_state(i, 0));
  }

  Case one_sided = make_case();
  one_sided.vehicle.suspension[kFront].strut[0].stiffness *= 0.9;
  const PreparedCase a = test::prepare(make_case()), b = test::prepare(one_sided);
  CHECK_FALSE(may_share_lanes(a, b, options));
  options.symmetry = false;
  CHECK(may_share_lanes(a, b, options));
}

}  // namespace
}  // namespace strut
