// The reduced model's run over the bump against the full-coordinate car's.

#include "tests/reference/reference_trajectory.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/model/reduced_state.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;
using I = StateIndex;

/// Both axles cross the default bump within the run: fronts at 0.1 s, rears at 0.24 s.
Case make_bump_case() {
  Case c = test::make_paper_case();
  c.maneuver.bump_distance = 2.0;
  c.maneuver.duration = 0.6;
  return c;
}

constexpr double kInterval = 0.01;  // s

std::vector<reference::ReducedState> integrate_reference(const Case& c, const PreparedCase& start) {
  reference::FullCoordinateCar car(
      c.vehicle, c.maneuver, reference::make_bump_laws(c.vehicle, c.maneuver, start.bump_center));
  // Both find free lengths from nominal trim, one with the chassis held: micrometers apart.
  for (int corner = 0; corner < kCorners; ++corner) {
    car.set_free_length(corner, start.vehicle.numbers.spring[corner].free_length);
  }
  std::vector<double> times;
  for (int i = 0; i * kInterval <= c.maneuver.duration + 1e-12; ++i) times.push_back(i * kInterval);
  return reference::integrate(car, test::to_reduced(start.start), times);
}

double calc_pitch(const Eigen::Vector4d& q) {
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  return -std::asin(rotation.normalized().toRotationMatrix()(2, 0));
}

/// Largest differences over the run.
struct Difference {
  double forward = 0.0, height = 0.0;  // m
  double pitch = 0.0;                  // rad
};

Difference compare(const PreparedCase& c, const IntegrateOptions& options,
                   const std::vector<reference::ReducedState>& truth) {
  SamplePlan plan;
  plan.interval = kInterval;
  const LaneResults run = list_kernels().back().run_scalar(c, options, plan);
  REQUIRE(run.status[0] == 0);
  REQUIRE(run.sample_count == static_cast<int>(truth.size()));
  Difference worst;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double* row = run.history.data() + i * CarChannel::kCount;
    worst.forward = std::max(worst.forward,
                             std::abs(row[CarChannel::kForwardPosition] - truth[i].position.x()));
    worst.height =
        std::max(worst.height, std::abs(row[CarChannel::kBodyPositionZ] - truth[i].position.z()));
    worst.pitch = std::max(
        worst.pitch, std::abs(row[CarChannel::kPitchAngle] - calc_pitch(truth[i].quaternion)));
  }
  return worst;
}

TEST_CASE("A run over the bump equals the full-coordinate car's", "[reference][slow]") {
  const Case bump = make_bump_case();
  const PreparedCase c = test::prepare(bump);
  const auto truth = integrate_reference(bump, c);
  double highest = 0.0;
  for (const auto& x : truth) highest = std::max(highest, std::abs(x.position.z() - 0.5373));
  CHECK(highest > 0.01);  // the bump is felt

  for (const Closure closure : {Closure::kNewton, Closure::kTable}) {
    IntegrateOptions options;
    options.closure = closure;
    options.step.step = 1e-3;
    const Difference coarse = compare(c, options, truth);
    options.step.step = 0.25e-3;
    const Difference fine = compare(c, options, truth);
    options.step.step = 0.02e-3;
    const Difference finest = compare(c, options, truth);
    const auto print = [](const Difference& d) {
      return std::to_string(1e9 * d.forward) + " nm, " + std::to_string(1e9 * d.height) + " nm, " +
             std::to_string(1e9 * d.pitch) + " nrad";
    };
    INFO((closure == Closure::kNewton ? "Newton" : "table")
         << ", forward, height, pitch: at 1 ms " << print(coarse) << "; at 0.25 ms " << print(fine)
         << "; at 0.02 ms " << print(finest));
    // 0.1 micrometers at 0.25 ms come from touches of the lifting tires shorter than a step; where
    // the steps resolve them, the two models agree to the integrators' tolerance.
    CHECK(fine.forward < tolerance(1e-6));
    CHECK(fine.height < tolerance(1e-6));
    CHECK(fine.pitch < tolerance(1e-6));
    CHECK(finest.forward < tolerance(1e-8));
    CHECK(finest.height < tolerance(1e-9));
    CHECK(finest.pitch < tolerance(1e-9));
    // At 1 ms 0.48 micrometers and 0.27 microradians: five times that leaves room for touches that
    // fall elsewhere between the steps, not for a lost order.
    CHECK(coarse.height < tolerance(2.5e-6));
    CHECK(coarse.pitch < tolerance(1.5e-6));
  }
}

}  // namespace
}  // namespace strut
