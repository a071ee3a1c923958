// Which cases may run in one batch of lanes, and that a batch serves all of them.

#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

LaneResults run_pair(const PreparedCase& a, const PreparedCase& b,
                     const IntegrateOptions& options) {
  const PreparedCase* cases[] = {&a, &b};
  return list_kernels().back().run_lanes(cases, 2, options, {});
}

IntegrateOptions make_options(Closure closure) {
  IntegrateOptions options;
  options.closure = closure;
  return options;
}

Case make_short_case() {
  Case c = test::make_paper_case();
  c.maneuver.duration = 0.8;
  return c;
}

TEST_CASE("A tire with aligning torque keeps it beside one without", "[unit][property]") {
  Case plain = make_short_case();
  plain.vehicle.rack_position = 5e-4;  // a little steer, so that aligning torque matters
  Pac2002<double>& p = plain.vehicle.pacejka;
  for (double* peak :
       {&p.QDZ1, &p.QDZ2, &p.QDZ6, &p.QDZ7, &p.QDZ8, &p.QDZ9, &p.SSZ1, &p.SSZ2, &p.SSZ3, &p.SSZ4}) {
    *peak = 0.0;
  }
  Case aligning = plain;
  aligning.vehicle.pacejka.QBZ1 = 8.0;
  aligning.vehicle.pacejka.QCZ1 = 1.2;
  aligning.vehicle.pacejka.QDZ1 = 0.12;
  const PreparedCase a = test::prepare(plain), b = test::prepare(aligning);
  REQUIRE(!a.vehicle.layout.tire_parts.aligning);
  REQUIRE(b.vehicle.layout.tire_parts.aligning);
  const IntegrateOptions options = make_options(Closure::kTable);
  const LaneResults both = run_pair(a, b, options);
  const LaneResults alone = list_kernels().back().run_scalar(b, options, {});
  const LaneResults other = list_kernels().back().run_scalar(a, options, {});
  for (int i = 0; i < 3; ++i) {
    CAPTURE(i);
    const auto at = static_cast<std::size_t>(i) + StateIndex::kAngularVelocity;
    CHECK(std::abs(both.final_state[2 * at + 1] - alone.final_state[at]) < tolerance(1e-9));
  }
  const auto yaw = std::size_t{StateIndex::kAngularVelocity} + 2;
  CHECK(std::abs(alone.final_state[yaw] - other.final_state[yaw]) > 1e-6);
}

TEST_CASE("A car under weaker gravity keeps its own linkage beside another", "[unit]") {
  Case weak = make_short_case();
  weak.maneuver.gravity = 5.0;
  CasePreparer preparer;
  const PreparedCase a = preparer.prepare(make_short_case()), b = preparer.prepare(weak);
  const IntegrateOptions options = make_options(Closure::kTable);
  const LaneResults both = run_pair(a, b, options);
  const LaneResults alone = list_kernels().back().run_scalar(test::prepare(weak), options, {});
  for (int i = 0; i < StateIndex::kCountWithoutRelaxation; ++i) {
    CAPTURE(i);
    CHECK(both.get_final_state(i, 1) == Approx(alone.get_final_state(i)).margin(tolerance(1e-9)));
  }
}

TEST_CASE("Cases that may not share lanes are refused", "[unit]") {
  const PreparedCase base = test::prepare(make_short_case());
  Case longer = make_short_case();
  longer.maneuver.duration = 0.9;
  CHECK_THROWS_AS(run_pair(base, test::prepare(longer), make_options(Closure::kTable)), ModelError);
  Case point = make_short_case();
  point.vehicle.tire.contact = ContactKind::kPoint;
  CHECK_THROWS_AS(run_pair(base, test::prepare(point), make_options(Closure::kTable)), ModelError);
  PreparedCase other = test::prepare(make_short_case());
  std::swap(other.vehicle.layout.corner[kRearLeft].pivot_row[0],
            other.vehicle.layout.corner[kRearLeft].pivot_row[1]);
  CHECK_THROWS_AS(run_pair(base, other, make_options(Closure::kNewton)), ModelError);
  CHECK_NOTHROW(run_pair(base, other, make_options(Closure::kTable)));
}

TEST_CASE("Cars of other masses and hardpoints close their own loops in one batch",
          "[unit][property]") {
  Case heavier = make_short_case();
  heavier.vehicle.suspension[kRear].wheel_mass += 1.0;
  heavier.vehicle.whole.mass *= 1.1;
  Case moved = make_short_case();
  moved.vehicle.suspension[kFront].strut_top.z += 0.01;
  const PreparedCase a = test::prepare(heavier), b = test::prepare(moved);
  const IntegrateOptions options = make_options(Closure::kNewton);
  for (const Kernel& kernel : list_kernels()) {
    CAPTURE(kernel.isa);
    std::vector<const PreparedCase*> mixed, of_a, of_b;
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      mixed.push_back(lane % 2 == 0 ? &a : &b);
      of_a.push_back(&a);
      of_b.push_back(&b);
    }
    const auto run = [&](const std::vector<const PreparedCase*>& cases) {
      return kernel.run_lanes(cases.data(), kernel.lanes, options, {});
    };
    const LaneResults both = run(mixed), alone[] = {run(of_a), run(of_b)};
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      for (int i = 0; i < StateIndex::kCountWithoutRelaxation; ++i) {
        CHECK(both.get_final_state(i, lane) == alone[lane % 2].get_final_state(i, lane));
      }
    }
    constexpr int kHeight = StateIndex::kPosition + 2;
    CHECK(both.get_final_state(kHeight, 0) != both.get_final_state(kHeight, 1));
  }
}

TEST_CASE("A spring too soft for its load is refused with key, value and range", "[unit]") {
  Case c = test::make_paper_case();
  for (StrutSpec& strut : c.vehicle.suspension[kRear].strut) {
    strut.nominal_stiffness = strut.stiffness;
    strut.stiffness = 500.0;
  }
  CHECK_THROWS_WITH(test::prepare(c),
                    Catch::Contains("rear_suspension.spring.stiffness = 500 N/m") &&
                        Catch::Contains("allowed: at least"));
}

}  // namespace
}  // namespace strut
