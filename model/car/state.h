// The integrated state, one flat array of T, and the names of its parts.
#pragma once

#include <array>

#include "base/math/spatial.h"

namespace strut {

/// Layout of the state. Velocities are chassis-axes components of the chassis origin's velocity and
/// of the angular velocity; `spin` is each wheel's angular velocity along its axis in inertial
/// space, which uncouples it from the other accelerations (dynamics.h).
struct StateIndex {
  static constexpr int kPosition = 0;          // 3, m, world
  static constexpr int kQuaternion = 3;        // 4, chassis to world
  static constexpr int kCorner = 7;            // 4, m
  static constexpr int kWheelAngle = 11;       // 4, rad, relative to the upright
  static constexpr int kVelocity = 15;         // 3, m/s
  static constexpr int kAngularVelocity = 18;  // 3, rad/s
  static constexpr int kCornerRate = 21;       // 4, m/s
  static constexpr int kSpin = 25;             // 4, rad/s
  static constexpr int kWork = 29;             // J, work of all non-conservative forces
  static constexpr int kKappa = 30;            // 4, relaxed longitudinal slip
  static constexpr int kTanAlpha = 34;         // 4, relaxed lateral slip
  static constexpr int kStrut = 38;            // states of effects: 4 lagged forces [N], 4 of
  static constexpr int kStrutCount = 16;       // mounts [N], 4 joints [m], 4 flanks [m]
  static constexpr int kCount = 54;
  static constexpr int kCountWithoutStruts = 38;
  static constexpr int kCountWithoutRelaxation = 30;
};

template <class T>
using State = std::array<T, StateIndex::kCount>;

template <class T>
Vec3<T> get_vec3(const T* x, int at) {
  return {x[at], x[at + 1], x[at + 2]};
}

template <class T>
void set_vec3(T* x, int at, const Vec3<T>& v) {
  x[at] = v.x;
  x[at + 1] = v.y;
  x[at + 2] = v.z;
}

template <class T>
Quaternion<T> get_quaternion(const T* x) {
  const int at = StateIndex::kQuaternion;
  return {x[at], x[at + 1], x[at + 2], x[at + 3]};
}

}  // namespace strut
