#include "model/car/kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace strut {
namespace {

constexpr int kLoopIterations = 12;         // five suffice from a neighbor 2.5 mm away
constexpr int kTravelIterations = 12;       // likewise
constexpr double kTravelTolerance = 1e-13;  // m
constexpr double kLoopTolerance = 1e-12;    // m

/// A corner closed at one coordinate q.
struct ClosedCorner {
  std::array<double, kMaxJoints> joints{};  // input: the initial guess
  CornerPose<double> pose;
  CornerMotion<double> motion;
  double loop_error = 0.0;  // m
};

template <CornerTree kTree>
void close_at(const CornerTopology& topology, const CornerGeometry<double>& geometry, double q,
              ClosedCorner& corner) {
  LoopFactor<double> factor;
  corner.joints[kTree.independent] = q;
  corner.loop_error =
      close_loops<kTree>(topology, geometry, kLoopIterations, corner.joints, corner.pose, factor);
  PartMotion<double> parts;
  update_part_motion<kTree>(topology, geometry, corner.pose, factor, parts);
  update_wheel_and_lines<kTree>(topology, geometry, corner.pose, parts, corner.motion);
}

/// Moves `corner` from its current coordinate to a wheel travel [m].
template <CornerTree kTree>
void move_to_travel(const CornerTopology& topology, const CornerGeometry<double>& geometry,
                    double travel, ClosedCorner& corner) {
  double q = corner.joints[kTree.independent];
  double error = 0.0;
  for (int i = 0; i < kTravelIterations; ++i) {
    close_at<kTree>(topology, geometry, q, corner);
    error = corner.motion.center.z - geometry.wheel_center.z - travel;
    if (std::abs(error) < kTravelTolerance) break;
    q -= error / corner.motion.center_q.z;
  }
  if (std::abs(error) < kTravelTolerance && corner.loop_error < kLoopTolerance) return;
  throw ModelError(
      fmt::format("hardpoints cannot close the loop at {:g} mm of wheel travel (residual {:g} m)",
                  1e3 * travel, std::max(std::abs(error), corner.loop_error)));
}

template <CornerTree kTree>
KinematicsPoint describe(const CornerGeometry<double>& geometry, bool right, double travel,
                         const ClosedCorner& corner) {
  const double outward = right ? -1.0 : 1.0;
  const Vec3<double>& axis = corner.motion.axis;
  const Mat3<double>& turn = corner.pose.part[kTree.upright].rotation;
  KinematicsPoint point;
  point.travel = travel;
  point.camber = 0.0 - outward * std::asin(axis.z);  // 0 - x avoids negative zeros in files
  point.toe = outward * std::atan2(axis.x, axis.y);
  point.displacement = corner.motion.center - geometry.wheel_center;
  point.caster_change = 0.0 - std::atan2(turn.z.x, turn.z.z);
  point.spring_length = corner.motion.length[kSpringLine];
  point.damper_length = corner.motion.length[kDamperLine];
  point.track = 2.0 * outward * corner.motion.center.y;
  return point;
}

template <CornerTree kTree>
std::vector<KinematicsPoint> sweep_corner(const CornerTopology& topology,
                                          const CornerGeometry<double>& geometry, bool right,
                                          const std::vector<double>& travels) {
  std::vector<KinematicsPoint> points(travels.size());
  const auto move_through = [&](std::size_t i, ClosedCorner& corner) {
    move_to_travel<kTree>(topology, geometry, travels[i], corner);
    points[i] = describe<kTree>(geometry, right, travels[i], corner);
  };
  const auto middle = static_cast<std::size_t>(
      std::lower_bound(travels.begin(), travels.end(), 0.0) - travels.begin());
  ClosedCorner upwards, downwards;
  for (std::size_t i = middle; i < travels.size(); ++i) move_through(i, upwards);
  for (std::size_t i = middle; i-- > 0;) move_through(i, downwards);
  return points;
}

}  // namespace

std::vector<KinematicsPoint> calc_kinematics(const AssembledVehicle& car, int corner,
                                             const std::vector<double>& travels) {
  const CornerTopology& topology = car.layout.corner[corner];
  const auto sweep = topology.kind == SuspensionKind::kMacPherson ? &sweep_corner<kMacPhersonTree>
                                                                  : &sweep_corner<kMultilinkTree>;
  try {
    return sweep(topology, car.numbers.geometry[corner], is_right(corner), travels);
  } catch (const ModelError& e) {
    throw ModelError(fmt::format("{}: {}", get_axle_key(axle_of(corner)), e.what()));
  }
}

}  // namespace strut
