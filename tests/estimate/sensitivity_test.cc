// The Jacobian of the channels: against CVODE, by position and time, and derivatives that vanish.

#include "estimate/sensitivity.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error/input_error.h"
#include "model/channel/car_channels.h"
#include "model_files/parameters.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using C = CarChannel;
using test::make_paper_case;
using test::tolerance;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// An axis of one level: the parameter stays at the base value.
Axis make_axis(const std::string& name) { return {name, 0.0, 0.0, 1}; }

const std::vector<Axis>& paper_axes() {
  static const std::vector<Axis> axes{make_axis("front_stiffness"), make_axis("front_damping"),
                                      make_axis("rear_stiffness"), make_axis("rear_damping")};
  return axes;
}

/// A curve in channel units per 100 % of the parameter.
double get_scaled(const Sensitivity& s, const Instant& instant, int channel, std::size_t p) {
  return s.get(instant, channel, p) * s.parameters[p].scale;
}

/// rms over the instants, of the parameter with the largest effect on the channel.
double calc_size(const Sensitivity& s, int channel) {
  double size = 0.0;
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    double sum = 0.0;
    for (const Instant& i : s.instants) sum += std::pow(get_scaled(s, i, channel, p), 2);
    size = std::max(size, std::sqrt(sum / static_cast<double>(s.instants.size())));
  }
  return size;
}

/// d(snapshot)/d(parameter) per 100 % by central differences of CVODE runs.
std::vector<double> differentiate_cvode(const Case& base, const std::string& name, double offset) {
  constexpr double kShare = 1e-3;
  const double value = get_parameter(base, name);
  std::vector<double> snapshot[2];
  for (const int side : {0, 1}) {
    Case c = base;
    set_parameter(c, name, value * (1.0 + (side == 0 ? kShare : -kShare)));
    CasePreparer preparer;
    snapshot[side] = run_cvode(preparer.prepare(c, offset), {}, {}).snapshot;
  }
  for (std::size_t i = 0; i < snapshot[0].size(); ++i) {
    snapshot[0][i] = (snapshot[0][i] - snapshot[1][i]) / (2.0 * kShare);
  }
  return snapshot[0];
}

TEST_CASE("The Jacobian at the snapshot is that of CVODE snapshots", "[reference]") {
  const Case base = make_paper_case();
  SensitivityOptions options;
  options.integrate.options.step.step = 0.25e-3;
  const double offset = GENERATE(0.0, 1.3);
  const Sensitivity s = calc_sensitivity(base, paper_axes(), offset, options);
  for (std::size_t p = 0; p < s.parameters.size(); ++p) {
    const std::vector<double> truth = differentiate_cvode(base, s.parameters[p].name, offset);
    for (int channel = 1; channel < C::kCount; ++channel) {
      const double size = calc_size(s, channel);
      if (size == 0.0) continue;  // no response: roll, yaw
      INFO(list_car_channels()[at(channel)].name << " by " << s.parameters[p].name);
      // RK4 rounds the edges of the bump; measured 7e-5, at 1 ms 2e-2.
      const double error = (get_scaled(s, s.snapshot, channel, p) - truth[at(channel)]) / size;
      CHECK(std::abs(error) < tolerance(2e-4));
    }
  }
}

/// Instants that were interpolated, against the integrator's own event halfway between two of them,
/// where a cubic through four has the weights -1/16, 9/16, 9/16, -1/16.
void check_place(const Case& base, const std::vector<Axis>& axes) {
  const Sensitivity scan = calc_sensitivity(base, axes, 0.0, {});
  const std::size_t first = 3 * scan.instants.size() / 10;
  const Instant* nodes = scan.instants.data() + first;
  const double offset = 0.5 * (nodes[1].offset + nodes[2].offset);
  const Sensitivity event = calc_sensitivity(base, axes, offset, {});
  for (int channel = 0; channel < C::kCornerBegin; ++channel) {
    const double size = calc_size(scan, channel);
    if (size == 0.0) continue;
    for (std::size_t p = 0; p < axes.size(); ++p) {
      INFO(list_car_channels()[at(channel)].name << " by " << axes[p].name << " at " << offset);
      const auto get = [&](int node) { return get_scaled(scan, nodes[node], channel, p); };
      const double interpolated = (9.0 * (get(1) + get(2)) - get(0) - get(3)) / 16.0;
      const double truth = get_scaled(event, event.snapshot, channel, p);
      // A cubic's error is 3/128 (w dt)^4; the one of yaw by trapezoids is the largest: 6e-5.
      CHECK(std::abs(interpolated - truth) / size < tolerance(1e-4));
    }
  }
}

TEST_CASE("Interpolated positions agree with the integrator's own", "[reference]") {
  SECTION("springs and dampers") { check_place(make_paper_case(), paper_axes()); }
  SECTION("speed, where time and place differ most") {
    check_place(make_paper_case(), {make_axis("speed"), make_axis("front_stiffness")});
  }
  SECTION("a bump under one side, which turns the car") {
    Case c = make_paper_case();
    c.maneuver.road.side = BumpSide::kLeft;
    check_place(c, paper_axes());
  }
}

TEST_CASE("Speed shifts the time of passage by -x / v^2", "[property]") {
  Case c = make_paper_case();
  c.maneuver.drive_torque = 0.0;
  c.maneuver.road.height = 0.0;
  const Sensitivity s = calc_sensitivity(c, {make_axis("speed")}, 0.0, {});
  const double v = c.maneuver.speed;
  const double way = v * s.snapshot.time;
  // Rolling resistance slows the car a little, not by the same fraction at every speed.
  CHECK(s.get(s.snapshot, C::kTime, 0) == Approx(-way / (v * v)).epsilon(tolerance(2e-2)));
}

TEST_CASE("The error of the differences falls with the square of the step", "[property]") {
  const auto calc_error = [](double share) {
    SensitivityOptions options;
    options.relative_step = share;
    const Sensitivity s = calc_sensitivity(make_paper_case(), paper_axes(), 0.0, options);
    return s.error[at(C::kPitchAngle) * s.parameters.size()];
  };
  const double coarse = calc_error(1e-2), fine = calc_error(1e-3);
  CHECK(coarse / fine == Approx(100.0).epsilon(tolerance(0.1)));
  CHECK(calc_error(SensitivityOptions{}.relative_step) < tolerance(1e-6));
}

TEST_CASE("A parameter without effect has a Jacobian of zeros", "[property]") {
  // The sensor's position changes the mechanism's key, so that these runs share no lanes.
  const Sensitivity s = calc_sensitivity(
      make_paper_case(), {{"imu_position_x", -0.5, 1.0, 2}, make_axis("rear_damping")}, 0.0, {});
  for (const Instant& instant : s.instants) {
    for (int channel = 0; channel < C::kCount; ++channel) {
      if (channel >= C::kImuAccelerationX && channel <= C::kImuAccelerationZ) continue;
      REQUIRE(s.get(instant, channel, 0) == 0.0);
    }
  }
  CHECK(calc_size(s, C::kImuAccelerationZ) > 0.0);
  CHECK(calc_size(s, C::kBodyPositionZ) > 0.0);
}

TEST_CASE("Curves of rounding error are set to zero", "[property]") {
  // Yaw inertia turns up in every equation, but on a symmetric road nothing yaws.
  const Sensitivity s = calc_sensitivity(make_paper_case(), {make_axis("yaw_inertia")}, 0.0, {});
  for (const int channel : {C::kBodyPositionZ, C::kPitchRate}) CHECK(calc_size(s, channel) == 0.0);
}

TEST_CASE("Left and right suspension act on the body alike, on roll oppositely", "[property]") {
  Case c = make_paper_case();
  const Sensitivity s = calc_sensitivity(
      c, {make_axis("front_left_stiffness"), make_axis("front_right_stiffness")}, 0.0, {});
  const double height = calc_size(s, C::kBodyAccelerationZ), roll = calc_size(s, C::kRollRate);
  REQUIRE(roll > 0.0);
  for (const Instant& i : s.instants) {
    // Differences of 1e-4 magnify rounding and Newton's residue to about 1e-8.
    REQUIRE(std::abs(get_scaled(s, i, C::kBodyAccelerationZ, 0) -
                     get_scaled(s, i, C::kBodyAccelerationZ, 1)) < tolerance(1e-5) * height);
    REQUIRE(std::abs(get_scaled(s, i, C::kRollRate, 0) + get_scaled(s, i, C::kRollRate, 1)) <
            tolerance(1e-5) * roll);
  }
}

TEST_CASE("Instants come at the requested rate", "[unit]") {
  SensitivityOptions options;
  options.rate = 150.0;
  const Sensitivity s = calc_sensitivity(make_paper_case(), paper_axes(), 0.0, options);
  REQUIRE(s.instants.size() > 400);
  for (std::size_t i = 1; i < s.instants.size(); ++i) {
    REQUIRE(s.instants[i].time - s.instants[i - 1].time == Approx(1.0 / 150.0));
    REQUIRE(s.instants[i].offset > s.instants[i - 1].offset);
  }
}

TEST_CASE("At a bound the differences stay inside the allowed range", "[unit]") {
  Case c = make_paper_case();
  set_parameter(c, "front_damping", 0.0);
  const Sensitivity s = calc_sensitivity(c, {{"front_damping", 0.0, 1000.0, 2}}, 0.0, {});
  CHECK(s.parameters[0].scale == 500.0);  // half the axis's extent
  CHECK(calc_size(s, C::kPitchRate) > 0.0);
}

TEST_CASE("Runs that fail or never arrive are reported with their parameter", "[unit]") {
  using Catch::Matchers::Contains;
  Case c = make_paper_case();
  CHECK_THROWS_WITH(calc_sensitivity(c, paper_axes(), 1000.0, {}),
                    Contains("never meets the snapshot's line"));
  set_parameter(c, "front_stiffness", 1000.0);  // cannot carry the car
  CHECK_THROWS_AS(calc_sensitivity(c, paper_axes(), 0.0, {}), InputError);
}

}  // namespace
}  // namespace strut
