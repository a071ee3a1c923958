// The reduced equations of motion against the full-coordinate car, and laws they must obey.

#include "model/car/dynamics.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "model/car/closures.h"
#include "tests/model/reduced_state.h"
#include "tests/reference/full_coordinate_car.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using I = StateIndex;
using test::tolerance;

/// Largest difference of accelerations relative to the largest acceleration of its kind.
double compare_accelerations(const reference::ReducedAcceleration& truth, const double* dx) {
  double worst = 0.0;
  const auto group = [&](const double* a, const double* b, int n) {
    double scale = 1.0, difference = 0.0;
    for (int i = 0; i < n; ++i) {
      scale = std::max(scale, std::abs(a[i]));
      difference = std::max(difference, std::abs(a[i] - b[i]));
    }
    worst = std::max(worst, difference / scale);
  };
  group(truth.linear.data(), dx + I::kVelocity, 3);
  group(truth.angular.data(), dx + I::kAngularVelocity, 3);
  group(truth.q_ddot.data(), dx + I::kCornerRate, kCorners);
  group(truth.spin_dot.data(), dx + I::kSpin, kCorners);
  return worst;
}

double find_worst_difference(const VehicleSpec& spec, const ManeuverSpec& maneuver, int states) {
  const PreparedCase c = test::prepare({spec, maneuver});
  const reference::FullCoordinateCar truth(spec, maneuver);
  const NewtonClosure<double> closure{&c.vehicle.layout, &c.vehicle.numbers};
  Workspace<double> ws{};
  test::Random random(7);
  double worst = 0.0;
  for (int i = 0; i < states; ++i) {
    const State<double> x = test::make_random_state(random, c.mechanism->car.center_height, 20.0,
                                                    spec.tire.unloaded_radius);
    State<double> dx{};
    calc_derivative(c.vehicle, closure, TireMode::kRolling, x.data(), dx.data(), ws);
    const auto accelerations = truth.calc_accelerations(truth.assemble(test::to_reduced(x)));
    worst = std::max(worst, compare_accelerations(accelerations, dx.data()));
  }
  return worst;
}

TEST_CASE("Accelerations equal those of the full-coordinate car in 100 random states",
          "[unit][reference]") {
  // Both solve well conditioned linear systems; the reference's Newton assembly is good to 1e-13 m.
  const double worst = find_worst_difference(reference::make_paper_sedan_spec(), {}, 100);
  INFO("worst relative difference " << std::scientific << worst);
  CHECK(worst < tolerance(1e-9));
}

TEST_CASE("Accelerations equal the reference's with mounts on arm and rod, and general rods",
          "[unit][reference]") {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  SuspensionSpec& front = spec.suspension[kFront];
  SuspensionSpec& rear = spec.suspension[kRear];
  front.spring_lower = {MountBody::kLowerArm, 0, {0.0, 0.55, -0.1}};
  front.spring_upper.position.z -= 0.1;
  front.strut_rod = {};  // massless
  rear.damper_lower = {MountBody::kRod, 3, 0.5 * (rear.rods[3].chassis + rear.rods[3].upright)};
  rear.damper_upper = {MountBody::kChassis, 0, {0.3, 0.6, 0.4}};
  rear.rods[1].center_fraction = 0.3;
  rear.rods[1].transverse_inertia = 0.05;
  spec.rack_position = 0.0005;
  const double worst = find_worst_difference(spec, {}, 30);
  INFO("worst relative difference " << std::scientific << worst);
  CHECK(worst < tolerance(1e-9));
}

TEST_CASE("Accelerations equal the reference's in point contact", "[unit][reference]") {
  VehicleSpec spec = reference::make_paper_sedan_spec();
  spec.tire.contact = ContactKind::kPoint;
  ManeuverSpec maneuver;
  maneuver.road.shape = BumpShape::kNone;
  const double worst = find_worst_difference(spec, maneuver, 30);
  INFO("worst relative difference " << std::scientific << worst);
  CHECK(worst < tolerance(1e-9));
}

}  // namespace
}  // namespace strut
