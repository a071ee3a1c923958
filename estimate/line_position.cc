#include "estimate/line_position.h"

#include <cmath>

#include "model/channel/car_channels.h"

namespace strut {
namespace {

using C = CarChannel;

/// Place of the spring's length and of the wheel center in CornerCoefficients::once.
constexpr std::size_t kCenterFunction = kInertiaFunctions + 1;
constexpr std::size_t kSpringFunction = kCenterFunction + 6 + kSpringLine;

/// One rear wheel: its center as a function of its spring's shortening.
class WheelPlace {
 public:
  WheelPlace(const PreparedCase& c, int corner)
      : table_(c.mechanism->tables.corner[corner]),
        degree_(c.mechanism->tables.degree[corner].place),
        nominal_length_(c.vehicle.numbers.nominal_length[corner * kLines + kSpringLine]) {}

  /// Chassis axes. Newton's method from the last call's solution.
  Vec3<double> calc_center(double deflection) {
    constexpr int kIterations = 6;
    constexpr double kTolerance = 1e-12;  // m, far below what moves an instant
    double length = 0.0, slope = 0.0;
    double* const none = nullptr;
    for (int i = 0; i < kIterations; ++i) {
      evaluate_group<1, 1>(table_.once, kSpringFunction, degree_, q_, &length, &slope, none);
      const double error = length - (nominal_length_ - deflection);
      q_ -= error / slope;
      if (std::abs(error) < kTolerance) break;
    }
    double center[3], unused[3];
    evaluate_group<1, 3>(table_.once, kCenterFunction, degree_, q_, center, unused, none);
    return {center[0], center[1], center[2]};
  }

 private:
  const CornerCoefficients<double>& table_;
  int degree_;
  double nominal_length_;
  double q_ = 0.0;
};

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

/// The rear wheels that see the bump; both where both or none do.
std::vector<int> list_trigger_corners(const PreparedCase& c) {
  const auto& on_bump = c.vehicle.layout.on_bump;
  if (on_bump[kRearLeft] == on_bump[kRearRight]) return {kRearLeft, kRearRight};
  return {on_bump[kRearLeft] ? kRearLeft : kRearRight};
}

}  // namespace

std::vector<double> calc_line_positions(const PreparedCase& c, const LaneResults& results,
                                        int lane) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const std::vector<int> corners = list_trigger_corners(c);
  std::vector<WheelPlace> wheels;
  wheels.reserve(corners.size());
  for (const int corner : corners) wheels.emplace_back(c, corner);

  std::vector<double> positions(at(results.sample_count));
  double yaw = 0.0, last_rate = 0.0, last_time = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double* row = results.history.data() + i * C::kCount * at(results.lanes);
    const auto get = [&](int channel) { return row[at(channel) * at(results.lanes) + at(lane)]; };
    const double pitch = get(C::kPitchAngle), roll = get(C::kRollAngle), time = get(C::kTime);
    const double rate = calc_yaw_rate(pitch, roll, get(C::kImuRateY), get(C::kImuRateZ));
    yaw += 0.5 * (rate + last_rate) * (time - last_time);
    last_rate = rate;
    last_time = time;
    double sum = 0.0;
    for (std::size_t w = 0; w < wheels.size(); ++w) {
      const int channel =
          C::kCornerBegin + corners[w] * C::kCornerChannels + C::kSuspensionDeflection;
      sum += calc_world_x(yaw, pitch, roll, wheels[w].calc_center(get(channel)));
    }
    positions[i] =
        get(C::kForwardPosition) + sum / static_cast<double>(wheels.size()) - c.bump_center;
  }
  return positions;
}

}  // namespace strut
