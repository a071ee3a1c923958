// Measured damper curves against their points, and against the straight line.
#include "model/force/damper_curve.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "base/math/xsimd_backend.h"
#include "model/error/model_error.h"
#include "model/rig/rig_system.h"
#include "tests/support/test_car.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::make_plan;
using test::make_steps;

const DamperCurveSpec kMeasured = {{-0.6, -0.3, -0.1, 0.0, 0.1, 0.3, 0.6},
                                   {-1500.0, -1100.0, -600.0, 0.0, 150.0, 380.0, 600.0}};

double calc_force(const DamperCurve& curve, double speed) {
  return curve.rate * calc_rate_factor(curve, speed) * speed;
}

TEST_CASE("A damper curve passes its points, rises between them and goes on straight", "[unit]") {
  const auto curve = make_damper_curve(kMeasured);
  for (std::size_t i = 0; i < kMeasured.speed.size(); ++i) {
    CHECK(calc_force(*curve, kMeasured.speed[i]) == Approx(kMeasured.force[i]).margin(1e-10));
  }
  double before = calc_force(*curve, -0.9);
  for (double v = -0.899; v < 0.9; v += 1e-3) {
    const double force = calc_force(*curve, v);
    CHECK(force > before);
    before = force;
  }
  CHECK(calc_force(*curve, 0.9) == Approx(600.0 + 0.3 * 220.0 / 0.3));
  CHECK(calc_force(*curve, -0.9) == Approx(-1500.0 - 0.3 * 400.0 / 0.3));
  // The rate at rest is the limit of the secants.
  CHECK(calc_rate_factor(*curve, 0.0) == Approx(calc_rate_factor(*curve, 1e-7)).epsilon(1e-5));
}

TEST_CASE("Lanes follow a damper curve as double does", "[unit]") {
  using Wide = Lanes<XsimdBackend<xsimd::default_arch>>;
  const auto curve = make_damper_curve(kMeasured);
  const auto get_speed = [](int lane) { return -0.75 + 0.37 * lane; };  // also beyond the ends
  Wide v;
  for (int i = 0; i < kLaneCount<Wide>; ++i) set_lane(v, i, get_speed(i));
  const Wide factor = calc_rate_factor(*curve, v);
  for (int i = 0; i < kLaneCount<Wide>; ++i) {
    CHECK(get_lane(factor, i) == Approx(calc_rate_factor(*curve, get_speed(i))).epsilon(1e-14));
  }
}

TEST_CASE("A strut on a stand gives the force of its curve, scaled by its rate", "[reference]") {
  RigSpec spec;
  spec.kind = RigKind::kStrutRig;
  spec.damper_curve = kMeasured;
  const double worn = GENERATE(1.0, 0.7);
  spec.damping = worn * calc_curve_rate(kMeasured);
  for (std::size_t i = 0; i < kMeasured.speed.size(); ++i) {
    const double v = kMeasured.speed[i];
    const LaneResults run = simulate_rig(
        spec, {make_signal("displacement", {0.0, 1.0}, {0.0, v}, Interpolation::kLinear)},
        make_steps(1e-2), make_plan(1.0, 0.25));
    CHECK(run.get_sample(2, StrutRigChannel::kForce) ==
          Approx(worn * kMeasured.force[i]).margin(1e-9));
  }
}

TEST_CASE("A curve that is a straight line is the damper of its rate", "[reference]") {
  RigSpec spec;
  spec.sprung_mass = 250.0;
  spec.unsprung_mass = 40.0;
  spec.stiffness = 2e4;
  spec.damping = 1500.0;
  spec.tire_stiffness = 2e5;
  RigSpec line = spec;
  line.damper_curve = {{-2.0, 0.0, 0.5, 3.0}, {-3000.0, 0.0, 750.0, 4500.0}};
  CHECK(calc_curve_rate(line.damper_curve) == Approx(1500.0));
  const std::vector<InputSignal> road = {make_bump("road_position", 0.05, 0.1, 0.1)};
  const LaneResults a = simulate_rig(spec, road, make_steps(1e-3), make_plan(1.0, 0.01));
  const LaneResults b = simulate_rig(line, road, make_steps(1e-3), make_plan(1.0, 0.01));
  for (int i = 0; i <= 100; ++i) {
    for (const int channel :
         {QuarterCarChannel::kSprungPosition, QuarterCarChannel::kDamperForce}) {
      CHECK(b.get_sample(i, channel) == Approx(a.get_sample(i, channel)).margin(1e-9));
    }
  }
}

TEST_CASE("A car's axle has the damper curve of its file at both wheels", "[reference]") {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  SuspensionSpec& rear = spec.suspension[kRear];
  rear.damper_curve = kMeasured;
  for (StrutSpec& strut : rear.strut) strut.damping = calc_curve_rate(kMeasured);
  const PreparedCase prepared = test::prepare(Case{spec, {}});
  const VehicleLayout& layout = prepared.vehicle.layout;
  CHECK(layout.strut_effects[kRearLeft] == kShapedDamper);
  CHECK(layout.strut_effects[kFrontLeft] == 0);
  Vehicle<double> vehicle;
  vehicle.layout = layout;
  vehicle.numbers = prepared.vehicle.numbers;
  fill_strut_elements(vehicle);
  REQUIRE(vehicle.effects.shaped.count == 2);
  for (int i = 0; i < 2; ++i) {
    const ShapedDamper<double>& damper =
        vehicle.effects.shaped.element[static_cast<std::size_t>(i)];
    CHECK(damper.calc_rate(0.3, 0.0) * 0.3 == Approx(380.0));
    CHECK(damper.calc_rate(-0.1, 0.0) * -0.1 == Approx(-600.0));
  }
}

TEST_CASE("Cars with different damper curves share no lanes", "[unit]") {
  Case c{reference::make_paper_sedan_spec(), {}};
  c.vehicle.suspension[kRear].damper_curve = kMeasured;
  const PreparedCase a = test::prepare(c);
  c.vehicle.suspension[kRear].damper_curve.force.back() += 50.0;
  CHECK_FALSE(may_share_lanes(a, test::prepare(c), Closure::kTable));
  c.vehicle.suspension[kRear].damper_curve = kMeasured;
  CHECK(may_share_lanes(a, test::prepare(c), Closure::kTable));
}

TEST_CASE("Damper curves that cannot be are refused", "[unit]") {
  const auto refuse = [](std::vector<double> speed, std::vector<double> force) {
    try {
      validate(DamperCurveSpec{std::move(speed), std::move(force)});
    } catch (const ModelError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK_THAT(refuse({-1, 0, 0}, {-1, 0, 1}), Contains("must increase"));
  CHECK_THAT(refuse({-1, 0, 1, 2}, {-1, 0, 5, 4}), Contains("must not decrease"));
  CHECK_THAT(refuse({-1, 1}, {-1, 1}), Contains("[0, 0]"));
  CHECK_THAT(refuse({-1, 0, 1}, {-50, 20, 90}), Contains("dry friction"));
  CHECK_THAT(refuse({0, 1}, {0, 1}), Contains("rebound"));
  CHECK(refuse({-1, 0, 1}, {-1, 0, 1}).empty());
}

}  // namespace
}  // namespace strut
