#include "estimate/line_position.h"

#include <cmath>

#include "model/channel/car_channels.h"

namespace strut {
namespace {

using C = CarChannel;

/// Indices of the spring's length and of the wheel center in CornerCoefficients::once.
constexpr std::size_t kCenterFunction = kInertiaFunctions + 1;
constexpr std::size_t kSpringFunction = kCenterFunction + 6 + kSpringLine;

/// Tabulated kinematics of one rear wheel.
struct RearWheel {
  int corner;
  const CornerCoefficients<double>* table;
  int degree;
  double nominal_length;  // of the spring [m]
};

RearWheel make_rear_wheel(const PreparedCase& c, int corner) {
  return {corner, &c.mechanism->tables.corner[corner], c.mechanism->tables.degree[corner].place,
          c.vehicle.numbers.nominal_length[corner * kLines + kSpringLine]};
}

/// Solves for the corner coordinate at which the spring is shorter by `deflection` [m], by Newton's
/// method from `q`.
double solve_coordinate(const RearWheel& wheel, double deflection, double q) {
  constexpr int kIterations = 6;
  constexpr double kTolerance = 1e-12;  // m, far below any effect on an instant
  for (int i = 0; i < kIterations; ++i) {
    const auto [length, slope] =
        evaluate_functions<1, 1>(wheel.table->once, kSpringFunction, wheel.degree, q);
    const double error = length[0] - (wheel.nominal_length - deflection);
    q -= error / slope[0];
    if (std::abs(error) < kTolerance) break;
  }
  return q;
}

/// Center of the wheel in chassis axes.
Vec3<double> calc_center(const RearWheel& wheel, double q) {
  const auto [center] =
      evaluate_functions<0, 3>(wheel.table->once, kCenterFunction, wheel.degree, q);
  return {center[0], center[1], center[2]};
}

/// d(yaw)/dt from chassis-fixed rates (x forward, y left, z up).
double calc_yaw_rate(double pitch, double roll, double rate_y, double rate_z) {
  return (rate_y * std::sin(roll) + rate_z * std::cos(roll)) / std::cos(pitch);
}

/// World x of chassis vector r: first row of Rz(yaw) Ry(pitch) Rx(roll).
double calc_world_x(double yaw, double pitch, double roll, const Vec3<double>& r) {
  const double side = std::cos(roll) * r.y - std::sin(roll) * r.z;
  const double up = std::sin(roll) * r.y + std::cos(roll) * r.z;
  return std::cos(yaw) * (std::cos(pitch) * r.x + std::sin(pitch) * up) - std::sin(yaw) * side;
}

/// The rear wheels that cross the bump; both where both or neither do.
std::vector<int> list_trigger_corners(const PreparedCase& c) {
  const auto& on_bump = c.vehicle.layout.on_bump;
  if (on_bump[kRearLeft] == on_bump[kRearRight]) return {kRearLeft, kRearRight};
  return {on_bump[kRearLeft] ? kRearLeft : kRearRight};
}

}  // namespace

std::vector<double> calc_line_positions(const PreparedCase& c, const LaneResults& results,
                                        int lane) {
  std::vector<RearWheel> wheels;
  for (const int corner : list_trigger_corners(c)) wheels.push_back(make_rear_wheel(c, corner));

  std::vector<double> coordinates(wheels.size(), 0.0);  // initial guesses: the last sample's
  std::vector<double> positions;
  double yaw = 0.0, last_rate = 0.0, last_time = 0.0;
  for (int i = 0; i < results.sample_count; ++i) {
    const auto get = [&](int channel) { return results.get_sample(i, channel, lane); };
    const double pitch = get(C::kPitchAngle), roll = get(C::kRollAngle), time = get(C::kTime);
    const double rate = calc_yaw_rate(pitch, roll, get(C::kImuRateY), get(C::kImuRateZ));
    yaw += 0.5 * (rate + last_rate) * (time - last_time);
    last_rate = rate;
    last_time = time;
    double sum = 0.0;
    for (std::size_t w = 0; w < wheels.size(); ++w) {
      const int channel = C::get_corner_channel(wheels[w].corner, C::kSuspensionDeflection);
      coordinates[w] = solve_coordinate(wheels[w], get(channel), coordinates[w]);
      sum += calc_world_x(yaw, pitch, roll, calc_center(wheels[w], coordinates[w]));
    }
    positions.push_back(get(C::kForwardPosition) + sum / static_cast<double>(wheels.size()) -
                        c.bump_center);
  }
  return positions;
}

}  // namespace strut
