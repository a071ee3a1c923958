// Measured curves of dampers and tires against their points, the straight line and a quadratic law.
#include "model/force/force_curve.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "base/math/xsimd_backend.h"
#include "model/error/model_error.h"
#include "model/rig/rig_system.h"
#include "tests/support/test_car.h"
#include "tests/support/test_rig.h"
#include "tests/support/test_run.h"

namespace strut {
namespace {

using Catch::Matchers::Contains;
using test::make_plan;
using test::make_steps;

const ForceCurveSpec kMeasured = {{-0.6, -0.3, -0.1, 0.0, 0.1, 0.3, 0.6},
                                  {-1500.0, -1100.0, -600.0, 0.0, 150.0, 380.0, 600.0}};

double calc_force(const ForceCurve& curve, double speed) {
  return curve.rate * calc_rate_factor(curve, speed) * speed;
}

IntegrateOptions make_table_options() {
  IntegrateOptions options;
  options.closure = Closure::kTable;
  return options;
}

TEST_CASE("A damper curve passes its points, rises between them and goes on straight", "[unit]") {
  const auto curve = make_force_curve(kMeasured);
  for (std::size_t i = 0; i < kMeasured.x.size(); ++i) {
    CHECK(calc_force(*curve, kMeasured.x[i]) == Approx(kMeasured.force[i]).margin(1e-10));
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
  const auto curve = make_force_curve(kMeasured);
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
  for (std::size_t i = 0; i < kMeasured.x.size(); ++i) {
    const double v = kMeasured.x[i];
    const LaneResults run = simulate_rig(
        spec, {make_signal("displacement", {0.0, 1.0}, {0.0, v}, Interpolation::kLinear)},
        make_steps(1e-2), make_plan(1.0, 0.25));
    CHECK(run.get_sample(2, StrutRigChannel::kForce) ==
          Approx(worn * kMeasured.force[i]).margin(1e-9));
  }
}

TEST_CASE("A curve that is a straight line is the damper of its rate", "[reference]") {
  const RigSpec spec = test::make_corner_rig(RigKind::kQuarterCar);
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
  CHECK_FALSE(may_share_lanes(a, test::prepare(c), make_table_options()));
  c.vehicle.suspension[kRear].damper_curve = kMeasured;
  CHECK(may_share_lanes(a, test::prepare(c), make_table_options()));
}

/// Points of k (d + q d^2) up to `end` [m], `count` intervals.
ForceCurveSpec tabulate(double stiffness, double progression, double end, int count) {
  ForceCurveSpec curve;
  for (int i = 0; i <= count; ++i) {
    const double d = end * i / count;
    curve.x.push_back(d);
    curve.force.push_back(stiffness * (d + progression * d * d));
  }
  return curve;
}

TEST_CASE("A tire's curve is the law that it tabulates", "[reference]") {
  RigSpec law = test::make_corner_rig(RigKind::kQuarterCar);
  law.unilateral_tire = true;
  RigSpec table = law;
  const double progression = GENERATE(0.0, 12.0);
  law.effects = {{"tire_progressive", "", {progression}}};
  table.tire_curve = tabulate(law.tire_stiffness, progression, 0.08, 80);
  table.tire_stiffness = calc_curve_rate(table.tire_curve);
  const std::vector<InputSignal> road = {make_bump("road_position", 0.08, 0.1, 0.1)};
  const auto run = [&](const RigSpec& spec) {
    return simulate_rig(spec, road, make_steps(5e-4), make_plan(1.0, 0.01));
  };
  const LaneResults a = run(law), b = run(table);
  double lowest = 1e9;
  for (int i = 0; i <= 100; ++i) {
    lowest = std::min(lowest, a.get_sample(i, QuarterCarChannel::kTireForce));
    CHECK(b.get_sample(i, QuarterCarChannel::kTireForce) ==
          Approx(a.get_sample(i, QuarterCarChannel::kTireForce)).margin(2.0));
    CHECK(b.get_sample(i, QuarterCarChannel::kSprungPosition) ==
          Approx(a.get_sample(i, QuarterCarChannel::kSprungPosition)).margin(2e-6));
  }
  CHECK(lowest == 0.0);
  // The rate scales all of it: 10 % more of either is the same tire.
  law.tire_stiffness *= 1.1;
  table.tire_stiffness *= 1.1;
  CHECK(run(table).get_sample(20, QuarterCarChannel::kTireForce) ==
        Approx(run(law).get_sample(20, QuarterCarChannel::kTireForce)).margin(2.0));
}

TEST_CASE("A tire rests where its curve carries the load", "[unit]") {
  const ForceCurveSpec points = {{0.0, 0.01, 0.03, 0.05}, {0.0, 1000.0, 5000.0, 13000.0}};
  const auto curve = make_force_curve(points);
  const TireVertical<double> tire = {0.3, calc_curve_rate(points), 0.0, 0.0};
  CHECK(calc_static_deflection(tire, curve.get(), 0.0) == 0.0);
  CHECK(calc_static_deflection(tire, curve.get(), 5000.0) == Approx(0.03).epsilon(1e-12));
  CHECK(calc_static_deflection(tire, curve.get(), 21000.0) == Approx(0.07).epsilon(1e-12));
  const TireVertical<double> soft = {0.3, 0.5 * tire.stiffness, 0.0, 0.0};
  CHECK(calc_static_deflection(soft, curve.get(), 2500.0) == Approx(0.03).epsilon(1e-12));
  // 2 k (d + 5 d^2) at d = 0.04 m.
  CHECK(calc_static_deflection({0.3, 2e5, 0.0, 5.0}, nullptr, 9600.0) == Approx(0.04));
}

TEST_CASE("A car stands on its tires' curve as deep as the points say", "[reference]") {
  Case c{reference::make_paper_sedan_spec(), {}};
  c.vehicle.tire.curve = {{0.0, 0.01, 0.02, 0.04}, {0.0, 1500.0, 3500.0, 9500.0}};
  c.vehicle.tire.stiffness = calc_curve_rate(c.vehicle.tire.curve);
  const PreparedCase p = test::prepare(c);
  const TrimResult trim = test::rest(p);
  Workspace<double> ws{};
  State<double> dx{};
  const NewtonClosure<double> closure{&p.vehicle.layout, &p.vehicle.numbers};
  calc_derivative(p.vehicle, closure, TireMode::kFrictionless, trim.state.data(), dx.data(), ws);
  const auto curve = make_force_curve(c.vehicle.tire.curve);
  double weight = 0.0;
  for (int corner = 0; corner < kCorners; ++corner) {
    const TireContact<double>& contact = ws.contact[corner];
    CHECK(contact.deflection > 5e-3);
    CHECK(contact.load == Approx(calc_force(*curve, contact.deflection)).epsilon(1e-9));
    weight += contact.load;
  }
  CHECK(weight == Approx(c.vehicle.whole.mass * c.maneuver.gravity).epsilon(1e-6));
  // Designed to stand level: the tires' deflection is part of the nominal trim.
  const double height = trim.state[StateIndex::kPosition + 2];
  CHECK(height == Approx(test::rest(test::prepare(Case{reference::make_paper_sedan_spec(), {}}))
                             .state[StateIndex::kPosition + 2])
                      .margin(2e-4));
}

TEST_CASE("Cars with different tire curves share no lanes", "[unit]") {
  Case c{reference::make_paper_sedan_spec(), {}};
  c.vehicle.tire.curve = {{0.0, 0.04}, {0.0, 8000.0}};
  const PreparedCase a = test::prepare(c);
  CHECK(may_share_lanes(a, test::prepare(c), make_table_options()));
  c.vehicle.tire.curve.force.back() += 50.0;
  CHECK_FALSE(may_share_lanes(a, test::prepare(c), make_table_options()));
}

std::string get_refusal(void (*validate)(const ForceCurveSpec&), std::vector<double> x,
                        std::vector<double> force) {
  try {
    validate(ForceCurveSpec{std::move(x), std::move(force)});
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

TEST_CASE("Tire curves that cannot be are refused", "[unit]") {
  const auto refuse = [](std::vector<double> deflection, std::vector<double> load) {
    return get_refusal(validate_tire_curve, std::move(deflection), std::move(load));
  };
  CHECK_THAT(refuse({0, 0.02, 0.01}, {0, 1, 2}), Contains("deflection 0.01 m after 0.02 m"));
  CHECK_THAT(refuse({0, 0.01, 0.02}, {0, 50, 50}), Contains("must increase"));
  CHECK_THAT(refuse({0.01, 0.02}, {0, 50}), Contains("[0, 0]"));
  CHECK_THAT(refuse({0, 0.02}, {10, 50}), Contains("[0, 0]"));
  CHECK_THAT(refuse({0}, {0}), Contains("two points"));
  CHECK(refuse({0, 0.01}, {0, 1000}).empty());
  CHECK(refuse({}, {}).empty());
}

TEST_CASE("Damper curves that cannot be are refused", "[unit]") {
  const auto refuse = [](std::vector<double> speed, std::vector<double> force) {
    return get_refusal(validate_damper_curve, std::move(speed), std::move(force));
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
