// The corners that are computed: all of them, or those of the left side, where the right side of
// the car moves as its mirror image.
//
// A mirror at the car's plane y = 0 keeps the components x and z of a polar vector (position,
// force) and reverses y; of an axial vector (rotation, moment, spin axis) it keeps y and reverses
// the others. The sum over both sides of what one has and the other mirrors is therefore twice the
// components kept.
#pragma once

#include "base/math/pair.h"
#include "base/math/spatial.h"
#include "base/names/corners.h"

namespace strut {

enum class Sides { kBoth, kLeft };

/// From one computed corner to the next.
template <Sides S>
inline constexpr int kCornerStride = S == Sides::kBoth ? 1 : 2;

/// A scalar of a computed corner, summed over both sides where the right one mirrors it.
template <Sides S, class T>
T add_sides(const T& value) {
  return S == Sides::kBoth ? value : value + value;
}
/// The same sum of a polar vector.
template <Sides S, class T>
Vec3<T> add_polar_sides(const Vec3<T>& v) {
  if constexpr (S == Sides::kBoth) return v;
  return {v.x + v.x, T(0.0), v.z + v.z};
}
/// The same sum of an axial vector.
template <Sides S, class T>
Vec3<T> add_axial_sides(const Vec3<T>& v) {
  if constexpr (S == Sides::kBoth) return v;
  return {T(0.0), v.y + v.y, T(0.0)};
}
/// The same sum of an inertia.
template <Sides S, class T>
Sym3<T> add_sides(const Sym3<T>& j) {
  if constexpr (S == Sides::kBoth) return j;
  return {j.xx + j.xx, j.yy + j.yy, j.zz + j.zz, T(0.0), j.xz + j.xz, T(0.0)};
}

/// Two wheels whose tires are computed together: those of an axle, or both of the left side.
struct WheelPair {
  int first, second;
};

template <Sides S>
inline constexpr int kWheelPairs = kCorners / kCornerStride<S> / 2;

template <Sides S>
constexpr WheelPair get_wheel_pair(int i) {
  return S == Sides::kBoth ? WheelPair{2 * i, 2 * i + 1} : WheelPair{kFrontLeft, kRearLeft};
}

}  // namespace strut
