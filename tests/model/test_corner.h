// One corner of a car for tests of its kinematics and composite.
#pragma once

#include <cmath>
#include <vector>

#include "model/car/closures.h"
#include "tests/support/test_car.h"

namespace strut::test {

using Motion = CornerMotion<double>;

inline AssembledVehicle make_car(const VehicleSpec& spec) { return assemble_vehicle(spec, {}); }

inline AssembledVehicle make_paper_car() { return make_car(reference::make_paper_sedan_spec()); }

inline Motion calc_motion(const AssembledVehicle& car, int corner, double q) {
  Motion motion{};
  NewtonClosure<double>{&car.layout, &car.numbers}(corner, q, motion);
  return motion;
}

/// Equally spaced over the travel, its ends included [m].
inline std::vector<double> make_travels(int count) {
  std::vector<double> q;
  q.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) q.push_back(kHalfTravel * (2.0 * i / (count - 1) - 1.0));
  return q;
}

/// A corner's pose at q as the closure finds it.
template <CornerTree kTree>
CornerPose<double> calc_pose(const AssembledVehicle& car, int corner, double q) {
  std::array<double, kMaxJoints> z = predict_joints<kTree>(car.layout.predictor[corner], q);
  CornerPose<double> pose;
  LoopFactor<double> factor;
  close_loops<kTree>(car.layout.corner[corner], car.numbers.geometry[corner], kNewtonIterations, z,
                     pose, factor);
  return pose;
}

/// The same for the paper's car: MacPherson in front, multilink behind.
inline CornerPose<double> calc_pose(const AssembledVehicle& car, int corner, double q) {
  return axle_of(corner) == kFront ? calc_pose<kMacPhersonTree>(car, corner, q)
                                   : calc_pose<kMultilinkTree>(car, corner, q);
}

inline Vec3<double> mirror(const Vec3<double>& r) { return {r.x, -r.y, r.z}; }

/// A point of the specification in chassis axes.
inline Vec3<double> place(const AssembledVehicle& car, int corner, const Vec3<double>& r) {
  const Vec3<double>& center = car.numbers.geometry[corner].wheel_center;
  return Vec3<double>{center.x, 0.0, center.z} + (is_right(corner) ? mirror(r) : r);
}

inline void append(std::vector<double>& list, const Vec3<double>& v) {
  list.insert(list.end(), {v.x, v.y, v.z});
}
inline void append(std::vector<double>& list, const Sym3<double>& s) {
  list.insert(list.end(), {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz});
}

/// Derivative of a list of functions by central differences of steps h, 2 h, 3 h: error of sixth
/// order.
template <class Function>
std::vector<double> differentiate(const Function& function, double q, double h) {
  constexpr double kWeight[] = {0.75, -0.15, 1.0 / 60.0};
  std::vector<double> slope;
  for (int i = 1; i <= 3; ++i) {
    const std::vector<double> above = function(q + i * h), below = function(q - i * h);
    slope.resize(above.size(), 0.0);
    for (std::size_t k = 0; k < slope.size(); ++k) {
      slope[k] += kWeight[i - 1] * (above[k] - below[k]) / h;
    }
  }
  return slope;
}

}  // namespace strut::test
