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

/// The components that a symmetric motion (sides.h) is integrated in, those of the right side and
/// of lateral motion left out; in the order of StateIndex.
struct SymmetricStateIndex {
  using I = StateIndex;
  static constexpr int kCount = 28;
  static constexpr int kCountWithoutStruts = 20;
  static constexpr int kCountWithoutRelaxation = 16;
  static constexpr std::array<int, kCount> kComponent = {I::kPosition,
                                                         I::kPosition + 2,
                                                         I::kQuaternion,
                                                         I::kQuaternion + 2,
                                                         I::kCorner,
                                                         I::kCorner + 2,
                                                         I::kWheelAngle,
                                                         I::kWheelAngle + 2,
                                                         I::kVelocity,
                                                         I::kVelocity + 2,
                                                         I::kAngularVelocity + 1,
                                                         I::kCornerRate,
                                                         I::kCornerRate + 2,
                                                         I::kSpin,
                                                         I::kSpin + 2,
                                                         I::kWork,
                                                         I::kKappa,
                                                         I::kKappa + 2,
                                                         I::kTanAlpha,
                                                         I::kTanAlpha + 2,
                                                         I::kStrut,
                                                         I::kStrut + 2,
                                                         I::kStrut + 4,
                                                         I::kStrut + 6,
                                                         I::kStrut + 8,
                                                         I::kStrut + 10,
                                                         I::kStrut + 12,
                                                         I::kStrut + 14};
  static constexpr int get(int index) { return kComponent[static_cast<std::size_t>(index)]; }
  /// Index of a component of StateIndex that is among them.
  static constexpr int find(int component) {
    int i = 0;
    while (get(i) != component) ++i;
    return i;
  }
};

/// Completes a symmetric state whose components of the left side are set: the right side mirrors
/// them. Only the slip angles change sign.
template <class T>
void mirror_left_side(T* x) {
  using I = StateIndex;
  for (const int group : {I::kCorner, I::kWheelAngle, I::kCornerRate, I::kSpin, I::kKappa}) {
    for (int left = 0; left < 4; left += 2) x[group + left + 1] = x[group + left];
  }
  for (int left = 0; left < 4; left += 2) x[I::kTanAlpha + left + 1] = -x[I::kTanAlpha + left];
  for (int left = 0; left < I::kStrutCount; left += 2)
    x[I::kStrut + left + 1] = x[I::kStrut + left];
}

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
