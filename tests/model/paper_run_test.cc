// The paper's run, frozen: whatever moves these numbers belongs in the changelog.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "model_files/read_maneuver.h"
#include "model_files/read_vehicle.h"
#include "tests/support/test_car.h"

namespace strut {
namespace {

using test::tolerance;

struct FrozenChannel {
  const char* name;
  double value;
};

/// Snapshot of examples/vehicles/paper_sedan.toml over examples/maneuvers/bump_20mps.toml by RK4 at
/// 1 ms with Newton's closure. The right side mirrors the left; what symmetry makes zero is left
/// out. Not a truth but a record: after a change that is meant, copy the new numbers from the
/// test's output and write the change down in CHANGELOG.md under "Results change".
constexpr FrozenChannel kSnapshot[] = {
    {"time", 0.631873077792},
    {"body_position_z", 0.546416896092},
    {"body_velocity_z", 0.0455409623557},
    {"body_acceleration_z", 7.31586780362},
    {"pitch_angle", -0.0056728961966},
    {"pitch_rate", 0.0922517828753},
    {"forward_position", 12.8008415506},
    {"forward_speed", 20.4759115419},
    {"imu_acceleration_x", 1.42053777101},
    {"imu_acceleration_z", 17.1180847278},
    {"imu_rate_y", 0.0922517828753},
    {"front_left_wheel_position_z", 0.448642611252},
    {"front_left_wheel_acceleration_z", 2.10379818442},
    {"front_left_suspension_deflection", -0.010231767039},
    {"front_left_suspension_velocity", -0.0607589266213},
    {"front_left_spring_force", 3596.98781857},
    {"front_left_damper_force", -120.30267471},
    {"front_left_tire_force_x", 524.816946703},
    {"front_left_tire_force_y", -17.4165053025},
    {"front_left_tire_force_z", 3773.79207262},
    {"front_left_tire_deflection", 0.0186549827838},
    {"front_left_wheel_speed", 44.9429735607},
    {"rear_left_wheel_position_z", 0.472904688141},
    {"rear_left_wheel_acceleration_z", 73.5752842534},
    {"rear_left_suspension_deflection", 0.0145138205787},
    {"rear_left_suspension_velocity", 1.46031337525},
    {"rear_left_spring_force", 1622.21615167},
    {"rear_left_damper_force", 2957.11186534},
    {"rear_left_tire_force_x", 191.144890696},
    {"rear_left_tire_force_y", -798.025258551},
    {"rear_left_tire_force_z", 7938.41936737},
    {"rear_left_tire_deflection", 0.0442109036494},
    {"rear_left_wheel_speed", 44.2781979902},
};

int find_channel(const std::string& name) {
  const auto& channels = list_car_channels();
  const auto at = std::find_if(channels.begin(), channels.end(),
                               [&](const ChannelInfo& channel) { return channel.name == name; });
  REQUIRE(at != channels.end());
  return static_cast<int>(at - channels.begin());
}

TEST_CASE("The paper's run keeps its snapshot", "[regression]") {
  const std::string examples = STRUT_SOURCE_DIR "/examples/";
  const PreparedCase c = test::prepare({read_vehicle(examples + "vehicles/paper_sedan.toml"),
                                        read_maneuver(examples + "maneuvers/bump_20mps.toml")});
  IntegrateOptions options;
  options.step = {Stepper::kRk4, 1e-3, true};
  options.closure = Closure::kNewton;
  const LaneResults run = list_kernels().back().run_scalar(c, options, {});
  REQUIRE(run.status[0] == static_cast<int>(RunStatus::kDone));
  for (const FrozenChannel& frozen : kSnapshot) {
    const double value = run.snapshot[static_cast<std::size_t>(find_channel(frozen.name))];
    INFO(frozen.name << " is " << std::scientific << std::setprecision(11) << value << ", was "
                     << frozen.value);
    // Other compilers' and instruction sets' rounding leaves some 1e-12.
    CHECK(std::abs(value - frozen.value) <= tolerance(1e-9) * std::abs(frozen.value));
  }
}

}  // namespace
}  // namespace strut
