// A car and its states for tests of the reduced equations.
#pragma once

#include <random>
#include <string>

#include "model/kernel/simulation.h"
#include "tests/reference/sample_specs.h"
#include "tests/support/tolerance.h"

namespace strut::test {

/// Uniform numbers, the same on every platform.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967295.0);
  }

 private:
  std::mt19937 engine_;
};

inline Case make_paper_case() { return {reference::make_paper_sedan_spec(), ManeuverSpec{}}; }

/// A smooth bump low enough that no wheel lifts off.
inline ManeuverSpec make_gentle_maneuver() {
  ManeuverSpec maneuver;
  maneuver.duration = 1.0;
  maneuver.bump_distance = 5.0;
  maneuver.road.shape = BumpShape::kCosine;
  maneuver.road.height = 0.01;
  maneuver.road.length = 3.0;
  return maneuver;
}

/// Prepares one case; the mechanism is made anew each time.
inline PreparedCase prepare(const Case& c) {
  CasePreparer preparer;
  return preparer.prepare(c);
}

/// At rest on the road under it, nothing driving.
inline TrimResult rest(PreparedCase c) {
  c.vehicle.numbers.drive_torque.fill(0.0);
  return solve_rest(c.vehicle, c.mechanism->tables, c.mechanism->car.center_height);
}

/// A car in wild but possible motion, wheels pressed onto the road or off it.
inline State<double> make_random_state(Random& random, double center_height, double speed,
                                       double wheel_radius) {
  using I = StateIndex;
  State<double> x{};
  x[I::kPosition] = random.uniform(-5.0, 12.0);
  x[I::kPosition + 1] = random.uniform(-1.0, 1.0);
  x[I::kPosition + 2] = center_height + random.uniform(-0.03, 0.02);
  double norm2 = 1.0;
  x[I::kQuaternion] = 1.0;
  for (int i = 1; i < 4; ++i) {
    x[I::kQuaternion + i] = random.uniform(-0.02, 0.02);
    norm2 += square(x[I::kQuaternion + i]);
  }
  for (int i = 0; i < 4; ++i) x[I::kQuaternion + i] /= std::sqrt(norm2);
  x[I::kVelocity] = speed + random.uniform(-2.0, 2.0);
  x[I::kVelocity + 1] = random.uniform(-1.0, 1.0);
  x[I::kVelocity + 2] = random.uniform(-1.0, 1.0);
  for (int i = 0; i < 3; ++i) x[I::kAngularVelocity + i] = random.uniform(-1.0, 1.0);
  for (int c = 0; c < kCorners; ++c) {
    x[I::kCorner + c] = random.uniform(-0.06, 0.06);
    x[I::kCornerRate + c] = random.uniform(-2.0, 2.0);
    x[I::kSpin + c] = speed / wheel_radius * random.uniform(0.9, 1.1);
    x[I::kWheelAngle + c] = random.uniform(-3.0, 3.0);
  }
  return x;
}

}  // namespace strut::test
