// Which cases may run in one batch of lanes, and that a batch serves all of them.

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
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

/// Results of two cases in alternating lanes of one batch, and of a batch of each alone.
struct AlternatingRuns {
  LaneResults both;
  std::array<LaneResults, 2> alone;
};

AlternatingRuns run_alternating(const Kernel& kernel, const PreparedCase& a, const PreparedCase& b,
                                const IntegrateOptions& options, const SamplePlan& plan) {
  const auto run = [&](const PreparedCase& even, const PreparedCase& odd) {
    std::vector<const PreparedCase*> cases(static_cast<std::size_t>(kernel.lanes), &even);
    for (std::size_t lane = 1; lane < cases.size(); lane += 2) cases[lane] = &odd;
    return kernel.run_lanes(cases.data(), kernel.lanes, options, plan);
  };
  return {run(a, b), {run(a, a), run(b, b)}};
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
  Case point = make_short_case();
  point.vehicle.tire.contact = ContactKind::kPoint;
  CHECK_THROWS_AS(run_pair(base, test::prepare(point), make_options(Closure::kTable)), ModelError);
  PreparedCase other = test::prepare(make_short_case());
  std::swap(other.vehicle.layout.corner[kRearLeft].pivot_row[0],
            other.vehicle.layout.corner[kRearLeft].pivot_row[1]);
  CHECK_THROWS_AS(run_pair(base, other, make_options(Closure::kNewton)), ModelError);
  CHECK_NOTHROW(run_pair(base, other, make_options(Closure::kTable)));
}

TEST_CASE("Cases of different durations end each at its own time", "[unit][property]") {
  Case shorter = make_short_case();
  shorter.maneuver.duration = 0.0405;
  Case longer = make_short_case();
  longer.maneuver.duration = 0.06;
  const PreparedCase a = test::prepare(shorter), b = test::prepare(longer);
  const SamplePlan plan{.interval = 0.01};
  for (const Kernel& kernel : list_kernels()) {
    CAPTURE(kernel.isa);
    const auto [both, alone] = run_alternating(kernel, a, b, make_options(Closure::kTable), plan);
    REQUIRE(both.sample_count == 7);
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      const LaneResults& own = alone[static_cast<std::size_t>(lane % 2)];
      CHECK(both.get_failure_time(lane) == own.get_failure_time(lane));
      for (int i = 0; i < StateIndex::kCountWithoutRelaxation; ++i) {
        CHECK(both.get_final_state(i, lane) == own.get_final_state(i, lane));
      }
      for (int i = 0; i < both.sample_count; ++i) {
        const double value = both.get_sample(i, CarChannel::kBodyPositionZ, lane);
        if (i < own.sample_count) {
          CHECK(value == own.get_sample(i, CarChannel::kBodyPositionZ, lane));
        } else {
          CHECK(std::isnan(value));
        }
      }
    }
  }
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
    const auto [both, alone] = run_alternating(kernel, a, b, options, {});
    for (int lane = 0; lane < kernel.lanes; ++lane) {
      for (int i = 0; i < StateIndex::kCountWithoutRelaxation; ++i) {
        CHECK(both.get_final_state(i, lane) ==
              alone[static_cast<std::size_t>(lane % 2)].get_final_state(i, lane));
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
